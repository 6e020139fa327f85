"""Letter C: no library phones home, and none leaves files in the folders of a user."""

import os
import re
import signal
import subprocess
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from worker.engine.seccomp import has_seccomp

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("quadpatch", "jobkit", "service", "worker", "dispatcher", "training", "onebox", "benchmarks")
IMPORTS_IT = re.compile(r"^\s*(?:import|from) (?:onnxruntime|quadpatch\.onnx_runtime)\b", re.MULTILINE)
TRAP = "from worker.engine.seccomp import kill_on_socket; kill_on_socket()\n"
REPAIR = """
from pathlib import Path
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_and_keep
from tests.quadpatch.shapes import bumpy_plate, punched, write_ply
write_ply(Path.home() / 'source.ply', punched(bumpy_plate(30, 2.0), (0, 0, 0), radius=0.2))
repair_and_keep(Path.home() / 'source.ply', Path.home() / 'repaired.ply', 'general-residual@1', RepairOptions(),
                lambda stage, fraction: None)
"""
# Groups of dependencies that a running service has.
GROUPS = ("service", "telemetry")


def modules_with_onnxruntime() -> list[str]:
    """Every module of ours that loads onnxruntime by itself."""
    return sorted(
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for package in PACKAGES
        for path in (ROOT / package).rglob("*.py")
        if IMPORTS_IT.search(path.read_text(encoding="utf-8"))
    )


def left_by(code: str, home: Path) -> list[str]:
    """Run code in a new interpreter that any socket ends, for a user without files; return the files left."""
    if not has_seccomp():
        pytest.skip("this kernel has no seccomp filters")
    home.mkdir()
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("XDG_", "ORT_"))}
    environment |= {"HOME": str(home), "TMPDIR": str(home)}
    subprocess.run([sys.executable, "-B", "-c", TRAP + code], cwd=ROOT, env=environment, check=True)
    return sorted(str(path.relative_to(home)) for path in home.rglob("*") if path.is_file())


@pytest.mark.parametrize("module", modules_with_onnxruntime())
def test_onnxruntime_leaves_nothing_with_the_user(module: str, tmp_path: Path) -> None:
    assert left_by(f"import {module}", tmp_path / "home") == []


def test_a_repair_with_a_network_opens_no_socket_and_leaves_its_result_alone(tmp_path: Path) -> None:
    assert left_by(REPAIR, tmp_path / "home") == ["repaired.ply", "source.ply"]


def test_a_socket_would_be_seen(tmp_path: Path) -> None:
    with pytest.raises(subprocess.CalledProcessError) as caught:
        left_by("import socket; socket.socket(socket.AF_INET)", tmp_path / "home")
    assert caught.value.returncode == -signal.SIGSYS


def test_no_library_that_the_service_needs_leaves_anything_with_the_user(tmp_path: Path) -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines = [
        *declared["dependencies"],
        *(line for group in GROUPS for line in declared["optional-dependencies"][group]),
    ]
    wanted = {normal(re.split(r"[\[<>=~ ]", line)[0]) for line in lines} - {"onnxruntime"}
    names = {
        name
        for name, distributions in packages_distributions().items()
        if wanted & {normal(distribution) for distribution in distributions} and name.isidentifier()
    }
    assert len(names) >= len(wanted) / 2
    code = "import importlib\n" + "".join(f"importlib.import_module({name!r})\n" for name in sorted(names))
    assert left_by(code, tmp_path / "home") == []


def normal(name: str) -> str:
    return name.lower().replace("_", "-").replace(".", "-")
