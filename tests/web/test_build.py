"""The built page in `service/page`, held to its sources in `web/`."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import get_args

import pytest

from quadpatch_client.schema import STAGES, BatchState, JobState, MeshState, Scope
from quadpatch_rules.tasks import TASKS
from tests.waiting import GUARD_S

ROOT = Path(__file__).parents[2]
WEB, BUILT = ROOT / "web", ROOT / "service" / "page"


def run_node(*arguments: str, folder: Path = WEB) -> subprocess.CompletedProcess[str]:
    if not (WEB / "node_modules").is_dir():
        pytest.skip("the Node.js packages of web/ are not installed; `make test` does")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        arguments,
        cwd=folder,
        env={**os.environ, "PATH": path, "NO_COLOR": "1"},
        capture_output=True,
        text=True,
        timeout=GUARD_S,
        check=False,
    )


def test_a_build_gives_the_bytes_that_are_handed_out(tmp_path: Path) -> None:
    done = run_node("node", "build.mjs", str(tmp_path))
    assert done.returncode == 0, done.stderr
    for path in BUILT.iterdir():
        assert (tmp_path / path.name).read_bytes() == path.read_bytes(), f"{path.name} is old: run `make web`"
    assert {path.name for path in tmp_path.iterdir()} == {path.name for path in BUILT.iterdir()}


def test_the_sources_keep_to_their_types_and_to_the_contract(tmp_path: Path) -> None:
    shutil.copytree(WEB / "src", tmp_path / "src")
    shutil.copy(WEB / "tsconfig.json", tmp_path)
    document, types = str(ROOT / "openapi.yaml"), str(tmp_path / "src" / "api" / "schema.d.ts")
    programs = WEB / "node_modules" / ".bin"
    written = run_node(str(programs / "openapi-typescript"), document, "--default-non-nullable", "false", "-o", types)
    assert written.returncode == 0, written.stderr
    (tmp_path / "node_modules").symlink_to(WEB / "node_modules")
    done = run_node(str(programs / "tsc"), folder=tmp_path)
    assert done.returncode == 0, done.stdout


def test_versions_are_pinned_and_no_package_runs_a_script_of_its_own() -> None:
    package = (WEB / "package.json").read_text("utf-8")
    versions = re.findall(r'^    "[@\w/.-]+": "([^"]+)",?$', package.split('"dependencies"')[1], re.MULTILINE)
    assert len(versions) >= 8
    assert all(re.fullmatch(r"\d+\.\d+\.\d+", version) for version in versions)
    assert "--ignore-scripts" in (ROOT / "Makefile").read_text("utf-8").split("$(WEB_READY):")[1].split("\n\n")[0]


@pytest.mark.parametrize(
    ("group", "codes"),
    [
        ("job_state", [state.value for state in JobState]),
        ("mesh_state", [state.value for state in MeshState]),
        ("batch_state", list(get_args(BatchState))),
        ("scope", [scope.value for scope in Scope]),
        ("stage", STAGES),
        ("task", TASKS),
    ],
)
def test_every_code_has_a_sentence(group: str, codes: list[str]) -> None:
    sentences = set(re.findall(r"^  (\w+):", (WEB / "src" / "text" / "en_codes.ts").read_text("utf-8"), re.MULTILINE))
    assert {f"{group}_{code}" for code in codes} <= sentences


def test_reasons_why_holes_stay_open_have_sentences() -> None:
    sentences = (WEB / "src" / "text" / "en_codes.ts").read_text("utf-8")
    method = (ROOT / "docs" / "method.md").read_text("utf-8")
    table = method.split("| code | stays open because |")[1].split("\n\n")[0]
    codes = re.findall(r"^\| `(\w+)`", table, re.MULTILINE)
    assert len(codes) >= 9
    assert [code for code in codes if f"  reason_{code}:" not in sentences] == []


def test_the_page_and_its_document_name_the_same_keys() -> None:
    table = (ROOT / "docs" / "page.md").read_text("utf-8").split("| keys | do |")[1].split("\n\n")[0]
    documented = re.findall(r"^\| ([^|-]+) \|", table, re.MULTILINE)
    about = (WEB / "src" / "pages" / "about.tsx").read_text("utf-8")
    named = re.findall(r"^ +\[(?:\"(.+?)\"|t\(\"(arrow_keys)\"\)), t\(\"shortcut_", about, re.MULTILINE)
    shown = [key or name.replace("_", " ") for key, name in named]
    assert [keys.replace(", then ", ", ") for keys in documented] == shown
    assert len(shown) == 6
