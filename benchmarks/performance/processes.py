"""What a command costs as a whole process: start, imports, reading, work, writing, end."""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

_LAUNCHER = Path(__file__).with_name("launcher.py")
_ROOT = Path(__file__).resolve().parents[2]
_MOST_REASON = 300


@dataclass(frozen=True)
class Cost:
    """What one run cost.

    Attributes
    ----------
    cpu_s : float
        User and system time of all its threads.
    wall_s : float
    peak_mb : float
        Largest resident memory, in MiB.
    """

    cpu_s: float
    wall_s: float
    peak_mb: float


class RunFailedError(Exception):
    """The command failed, or ran into its limit."""


def measure(command: Sequence[str], limit_s: float, n_cores: int = 0) -> Cost:
    """Run a command and wait for it.

    Parameters
    ----------
    command : sequence of str
        The program by its path, and its arguments.
    limit_s : float
        It is killed after so long.
    n_cores : int
        Cores that it may use; 0 for all.

    Raises
    ------
    RunFailedError
    """
    launch = [sys.executable, "-S", str(_LAUNCHER), str(limit_s), str(n_cores), *command]
    # Byte code of modules is kept between runs, as it is where a program is installed.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    done = subprocess.run(launch, cwd=_ROOT, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RunFailedError(done.stderr.strip()[-_MOST_REASON:])
    figures = json.loads(done.stdout)
    status = figures.pop("status")
    if status != 0:
        is_late = figures["wall_s"] >= limit_s
        raise RunFailedError(f"over {limit_s:g} s" if is_late else done.stderr.strip()[-_MOST_REASON:] or str(status))
    return Cost(**figures)
