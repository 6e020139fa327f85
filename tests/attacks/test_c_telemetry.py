"""Letter C: no library phones home, and none leaves files in the folders of a user."""

import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("quadpatch", "jobkit", "service", "worker", "dispatcher", "training", "client", "onebox", "benchmarks")
IMPORTS_IT = re.compile(r"^\s*(?:import|from) (?:onnxruntime|quadpatch\.onnx_runtime)\b", re.MULTILINE)
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
    """Run code in a fresh interpreter of a user without files; return the files that the user has then."""
    home.mkdir()
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("XDG_", "ORT_"))}
    environment |= {"HOME": str(home), "TMPDIR": str(home)}
    subprocess.run([sys.executable, "-B", "-c", code], cwd=ROOT, env=environment, check=True)
    return sorted(str(path.relative_to(home)) for path in home.rglob("*") if path.is_file())


@pytest.mark.parametrize("module", modules_with_onnxruntime())
def test_onnxruntime_leaves_nothing_with_the_user(module: str, tmp_path: Path) -> None:
    assert left_by(f"import {module}", tmp_path / "home") == []


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
