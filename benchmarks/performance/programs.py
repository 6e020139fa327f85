"""The programs that are compared, as commands on a scan.

Tested in `tests/benchmarks/performance/test_main.py`.
"""

import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

MODELS = ("smooth", "self", "general-residual@1")
FLOOR, MESHLIB, MESHLAB = "floor", "MeshLib", "MeshLab"
PEER_PACKAGES = {MESHLIB: "meshlib", MESHLAB: "pymeshlab"}

_PEERS = str(Path(__file__).with_name("peers.py"))
# What no program can do without: the bytes of the scan are read and written again.
_COPY = "import sys\nwith open(sys.argv[1], 'rb') as source, open(sys.argv[2], 'wb') as output:\n"
_COPY += "    output.write(source.read())\n"


@dataclass(frozen=True)
class Program:
    """A program by its name, and its command line for a scan and an output."""

    name: str
    command: Callable[[Path, Path], list[str]]


def floor() -> Program:
    """Return the program that reads all bytes of the scan and writes them again."""
    return Program(FLOOR, lambda source, output: [sys.executable, "-S", "-c", _COPY, str(source), str(output)])


def ours(model: str) -> Program:
    """Return a repair with one model; its name is the model's, without the version."""
    start = [sys.executable, "-m", "quadpatch", "fill"]
    end = ["--model", model, "--quiet"]
    return Program(model.partition("@")[0], lambda source, output: [*start, str(source), "-o", str(output), *end])


def peers(python: str | None) -> list[Program]:
    """Return the peers that an environment has, by the path of its Python; none without one."""
    if python is None:
        return []
    return [_peer(python, name) for name in PEER_PACKAGES if peer_version(python, name)]


def peer_version(python: str, name: str) -> str:
    """Return the version of a peer; empty where the environment has none."""
    command = [python, _PEERS, "version", PEER_PACKAGES[name]]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def _peer(python: str, name: str) -> Program:
    start = [python, _PEERS, name.lower()]
    return Program(name, lambda source, output: [*start, str(source), str(output)])


def all_programs(models: Sequence[str], peer_python: str | None) -> list[Program]:
    """Return the floor, ours and the peers, in the order of the columns."""
    return [floor(), *map(ours, models), *peers(peer_python)]
