"""The tools of others that read `openapi.yaml`: run with the Node.js and the packages that `make test` installs."""

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.waiting import GUARD_S

ROOT = Path(__file__).parents[2]
DOCUMENT = ROOT / "openapi.yaml"
NODE = Path(__file__).with_name("node")
_PACKAGES = NODE / "node_modules"
# What a tool writes to the home folder, or asks of a network, is nothing to a test.
_QUIET: Mapping[str, str] = {"REDOCLY_TELEMETRY": "off", "REDOCLY_SUPPRESS_UPDATE_NOTICE": "true", "NO_COLOR": "1"}


def run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder, with the programs of this environment first on the path."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, **_QUIET, "PATH": path},
        capture_output=True,
        text=True,
        timeout=GUARD_S,
        check=False,
    )


def run_node(command: list[str], folder: Path = NODE) -> subprocess.CompletedProcess[str]:
    """Run a program of the Node.js packages, or `node` itself; skip where `make test` has not installed them."""
    if not _PACKAGES.is_dir():
        pytest.skip("the Node.js packages of tests/contract/node are not installed; `make test` does")
    name, *arguments = command
    program = name if name == "node" else str(_PACKAGES / ".bin" / name)
    return run([program, *arguments], folder)
