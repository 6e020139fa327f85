"""The cases beside this repository: files rebuilt from public bug reports, each with what its repair must come to.

The folder brings its own judge, ``check.py``. The command line runs in this process, by the smooth model. The same
faults on meshes built in code stand in `test_faulty_shapes`.
"""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from typer.testing import CliRunner

from quadpatch.cli.app import app

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "cases"
MANIFEST = FOLDER / "manifest.json"
CASES: list[dict[str, Any]] = json.loads(MANIFEST.read_text()) if MANIFEST.is_file() else []
ABSENT = "there is no ../shared/cases/manifest.json beside this repository"


def _name(case: dict[str, Any]) -> str:
    return " ".join([case["file"], *case.get("arguments", [])])


@pytest.fixture(scope="module")
def judge() -> ModuleType:
    spec = importlib.util.spec_from_file_location("check", FOLDER / "check.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _judged(source: Path, output: Path) -> dict[str, Any]:
    """Ask the judge in a process of its own: what MeshLab calls a crossing depends on the meshes that it had before."""
    judged = subprocess.run(
        [sys.executable, str(FOLDER / "check.py"), str(source), str(output)],
        capture_output=True,
        text=True,
        check=False,
    )
    # trimesh reads neither of the two STL files with unusual headers, so of these the counts alone are looked at.
    facts: dict[str, Any] = {} if "ValueError" in judged.stderr else json.loads(judged.stdout)
    return facts


@pytest.mark.skipif(not CASES, reason=ABSENT)
def test_the_cases_are_there() -> None:
    assert all((FOLDER / case["file"]).is_file() for case in CASES)


@pytest.mark.parametrize(
    "case",
    [pytest.param(case) for case in CASES] or [pytest.param({"file": "none"}, marks=pytest.mark.skip(reason=ABSENT))],
    ids=_name,
)
def test_a_case_comes_out_as_expected(case: dict[str, Any], judge: ModuleType, tmp_path: Path) -> None:
    source = FOLDER / case["file"]
    output = tmp_path / ("out" + case.get("output", source.suffix.lower()))
    report = tmp_path / "report.json"
    files = [str(source), "-o", str(output), "--report", str(report)]
    run = CliRunner().invoke(app, ["fill", *files, "--model", "smooth", *case.get("arguments", [])])
    facts: dict[str, Any] = {"exit": run.exit_code}
    if run.exit_code == 0:
        facts |= _judged(source, output)
        facts |= {f"n_{verdict}": n for verdict, n in json.loads(report.read_text())["counts"].items()}
    wanted = case["expect"]
    wrong = {key: facts.get(key) for key, value in wanted.items() if not judge.right(facts.get(key), value)}
    assert not wrong, f"expected {wanted}; {run.stderr}"
