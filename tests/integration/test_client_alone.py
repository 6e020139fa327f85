"""The client's wheel with nothing but what it asks for: what a scanning station installs.

Dependencies are taken from the environment of the tests, by the metadata of the wheel: no index is needed. Also tests
`client/quadpatch_client/__init__.py`.
"""

import json
import os
import subprocess
import sys
import venv
from collections.abc import Callable, Iterator
from importlib.metadata import distribution, requires
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import quadpatch_client
from tests.contract.tools import run_node
from tests.waiting import GUARD_S

ROOT = Path(__file__).resolve().parents[2]
MOST_BYTES = 60_000_000
PROGRAM = """\
from pathlib import Path

from quadpatch_client import Client, Job, JobFailedError, JobSpec


def repaired(url: str, scan: Path) -> Job | None:
    with Client(url) as client:
        mesh = client.upload(scan)
        job = client.create_job(JobSpec.model_validate({"mesh_id": mesh.id, "method": {"method": "smooth"}}))
        try:
            job = client.wait(job.id)
        except JobFailedError as error:
            print(error.job.id)
            return None
        client.download(job, "result", scan.with_name("by_program.ply"))
        return job
"""
WRONG = PROGRAM.replace("client.wait(job.id)", "client.wait(job)")


@pytest.fixture(scope="module")
def station(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An environment with the wheel of the client alone; returns its Python."""
    folder = tmp_path_factory.mktemp("station")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    source = folder / "source"
    copied = ("pyproject.toml", "README.md", "LICENSE", "quadpatch_client", "quadpatch_rules")
    source.mkdir()
    # A build leaves files beside its source.
    subprocess.run(["cp", "-rL", *(str(ROOT / "client" / name) for name in copied), str(source)], check=True)
    build = ["wheel", "--no-deps", "--no-build-isolation", "--no-index", "--wheel-dir", str(folder), str(source)]
    subprocess.run([*pip, *build], check=True, cwd=folder)
    venv.create(folder / "venv", with_pip=False)
    python = folder / "venv" / "bin" / "python"
    (wheel,) = folder.glob("*.whl")
    install = ["--python", str(python), "install", "--no-deps", "--no-index", str(wheel)]
    subprocess.run([*pip, *install], check=True, cwd=folder)
    (site,) = (folder / "venv").glob("lib/python*/site-packages")
    for name in needed("quadpatch-client"):
        copy_installed(name, site)
    return python


def needed(name: str) -> set[str]:
    """Names of the distributions that one asks for, and that they ask for in turn."""
    found: set[str] = set()
    left = [name]
    while left:
        asked = [Requirement(text) for text in requires(left.pop()) or []]
        names = {canonicalize_name(r.name) for r in asked if r.marker is None or r.marker.evaluate({"extra": ""})}
        left += names - found
        found |= names
    return found


def copy_installed(name: str, site: Path) -> None:
    for file in distribution(name).files or []:
        if ".." not in file.parts and "__pycache__" not in file.parts:
            target = site / file
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(Path(str(file.locate())).read_bytes())


def run_apart(python: Path, folder: Path, *arguments: str | Path, **more: str) -> subprocess.CompletedProcess[str]:
    """Run an interpreter in a folder that has nothing of the project."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "QUADPATCH", "COV"))}
    return subprocess.run(
        [str(python), *map(str, arguments)],
        cwd=folder,
        env={**kept, **more},
        capture_output=True,
        text=True,
        timeout=GUARD_S,
        check=False,
    )


def test_a_scan_is_repaired_from_another_folder(
    station: Path, local_stack: Any, relief_file: Callable[[str], Path]
) -> None:
    scan = relief_file("float.ply")
    command = station.with_name("quadpatch-client")
    done = run_apart(
        command,
        scan.parent,
        "repair",
        scan.name,
        "-o",
        "out.ply",
        "--method",
        "smooth",
        QUADPATCH_CLIENT_URL=local_stack.url,
    )
    assert done.returncode == 0, done.stderr
    assert "4 filled smoothly" in done.stderr
    (scan.parent / "program.py").write_text(PROGRAM)
    code = f"from program import *; print(repaired({local_stack.url!r}, Path('float.ply')).state.value)"
    done = run_apart(station, scan.parent, "-c", code)
    assert done.stdout.startswith("succeeded"), done.stderr
    assert (scan.parent / "by_program.ply").read_bytes() == (scan.parent / "out.ply").read_bytes()


def test_nothing_else_is_there_and_it_is_small(station: Path, tmp_path: Path) -> None:
    (site,) = station.parents[1].glob("lib/python*/site-packages")
    names = {path.name for path in site.iterdir()}
    assert {"quadpatch_client", "quadpatch_rules", "httpx", "pydantic", "typer", "rich"} <= names
    assert names.isdisjoint({"numpy", "tenacity", "client", "quadpatch", "jobkit", "service", "schema"})
    assert sum(path.stat().st_size for path in files(site)) <= MOST_BYTES


def files(folder: Path) -> Iterator[Path]:
    yield from (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())


def test_its_types_pass_mypy_from_outside(station: Path, tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(PROGRAM)
    (tmp_path / "wrong.py").write_text(WRONG)
    options: list[str | Path] = ["--strict", "--python-executable", station, "--config-file", os.devnull]
    done = run_apart(Path(sys.executable), tmp_path, "-m", "mypy", *options, "program.py", "wrong.py")
    assert done.stdout.startswith('wrong.py:11: error: Argument 1 to "wait" of "Client" has incompatible type "Job"')
    assert "Found 1 error in 1 file" in done.stdout, done.stdout + done.stderr


def test_its_types_pass_pyright_from_outside(station: Path, tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(PROGRAM)
    (tmp_path / "wrong.py").write_text(WRONG)
    settings = {"typeCheckingMode": "strict", "include": ["."]}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings))
    done = run_node(["pyright", "--pythonpath", str(station), "--outputjson"], tmp_path)
    found = json.loads(done.stdout)
    faults = [Path(item["file"]).name for item in found["generalDiagnostics"] if item["severity"] == "error"]
    assert faults == ["wrong.py"], done.stdout


def test_names_that_are_handed_out_are_there() -> None:
    for name in quadpatch_client.__all__:
        assert getattr(quadpatch_client, name).__module__.startswith("quadpatch_client.")
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = quadpatch_client.no_such_name
