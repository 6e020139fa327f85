"""Locks of the image: every distribution with the sha256 of the one file that is installed.

`python -m deploy.lock` resolves the dependencies of each extra under `constraints.txt` and writes `deploy/locks/`. The
image is built from these files with `pip install --require-hashes`, so that a file that was replaced on an index is
refused. A lock holds for one platform and one Python: those of the image.
"""

import json
import platform
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
LOCKS = ROOT / "deploy" / "locks"
# Built from this tree, so no index has it: its requirements are locked instead.
CLIENT = "quadpatch-client"
PROJECTS = ("pyproject.toml", "client/pyproject.toml")
# What `EXTRAS` of the Dockerfile may name, and what builds the project itself.
EXTRAS = ("service", "telemetry", "networks")
BUILD = "build"
PYTHON = (3, 11)
MACHINE = "x86_64"
_HEADER = f"# Written by `make lock` for Linux {MACHINE} and Python {PYTHON[0]}.{PYTHON[1]}; not to be edited.\n"


class LockError(Exception):
    """The lock can't be made here, or would not hold elsewhere."""


def requirements(extra: str) -> list[str]:
    """Return what the project asks for with an extra, or what builds it."""
    document, client = (tomllib.loads((ROOT / path).read_text("utf-8")) for path in PROJECTS)
    if extra == BUILD:
        return list(document["build-system"]["requires"])
    project = document["project"]
    own = [text for text in project["dependencies"] if not text.startswith(f"{CLIENT}==")]
    return [*own, *client["project"]["dependencies"], *project["optional-dependencies"][extra]]


def lock_text(report: dict[str, Any]) -> str:
    """Write an installation report of pip as a file of requirements with hashes.

    Raises
    ------
    LockError
        If a file has no hash, or is a local build that no public index holds.
    """
    lines = []
    for item in report["install"]:
        name, version = item["metadata"]["name"].lower().replace("_", "-"), item["metadata"]["version"]
        sha256 = item["download_info"].get("archive_info", {}).get("hashes", {}).get("sha256")
        if "+" in version or sha256 is None:
            raise LockError(f"{name} {version} is no file of a public index: set PIP_FIND_LINKS= and try again")
        lines.append(f"{name}=={version} --hash=sha256:{sha256}\n")
    return _HEADER + "".join(sorted(lines))


def read_lock(extra: str) -> dict[str, tuple[str, str]]:
    """Return version and sha256 of each distribution of a lock."""
    pins = {}
    for line in (LOCKS / f"{extra}.txt").read_text("utf-8").splitlines():
        if line and not line.startswith("#"):
            pin, sha256 = line.split(" --hash=sha256:")
            name, version = pin.split("==")
            pins[name] = (version, sha256)
    return pins


def main() -> int:
    """Write all locks; return the exit code."""
    try:
        _check_machine()
        texts = {extra: lock_text(_resolve(extra)) for extra in (BUILD, *EXTRAS)}
    except (LockError, subprocess.CalledProcessError) as error:
        sys.stderr.write(f"{error}\n")
        return 1
    LOCKS.mkdir(exist_ok=True)
    for extra, text in texts.items():
        (LOCKS / f"{extra}.txt").write_text(text, "utf-8")
    return 0


def _check_machine() -> None:
    machine = (platform.system(), platform.machine(), sys.version_info[:2])
    if machine != ("Linux", MACHINE, PYTHON):
        raise LockError(f"locks hold for Linux {MACHINE} and Python {PYTHON}; this is {machine}")


def _resolve(extra: str) -> dict[str, Any]:
    """Return pip's report of what it would install into an empty environment."""
    with tempfile.TemporaryDirectory() as folder:
        requirements_file, report = Path(folder) / "wanted.txt", Path(folder) / "report.json"
        requirements_file.write_text("\n".join(requirements(extra)), "utf-8")
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--dry-run", "--ignore-installed"]
        options = ["--only-binary", ":all:", "--constraint", str(ROOT / "constraints.txt")]
        subprocess.run([*pip, *options, "--report", str(report), "--requirement", str(requirements_file)], check=True)
        resolved: dict[str, Any] = json.loads(report.read_text("utf-8"))
        return resolved


if __name__ == "__main__":
    sys.exit(main())
