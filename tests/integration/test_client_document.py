"""`docs/client.md`: every command and every program in it does what it says."""

import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from quadpatch_client.cli import app
from quadpatch_client.schema import RuleContent
from quadpatch_client.sdk import Client
from tests.integration.test_batch import small_scans
from tests.waiting import GUARD_S

TEXT = (Path(__file__).resolve().parents[2] / "docs" / "client.md").read_text("utf-8")
COMMANDS = [line for block in re.findall(r"```sh\n(.*?)```", TEXT, re.DOTALL) for line in block.splitlines()]
PROGRAMS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


@pytest.fixture
def folder(relief_file: Callable[[str], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    scan = relief_file("float.ply").rename(tmp_path / "scan.ply")
    for name in ("scans", "good_scans", "drop"):
        small_scans(tmp_path / name, 2, "documented")
    for name in ("a.ply", "b.ply"):
        (tmp_path / "good_scans" / name).write_bytes(scan.read_bytes())
    (tmp_path / "rule.json").write_text('{"holes": {"max_diameter": 20}}')
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_there_are_commands_and_programs_to_try() -> None:
    named = {shlex.split(line)[1] for line in COMMANDS}
    assert {"holes", "plan", "repair", "jobs", "wait", "fetch", "batch", "watch", "models", "rules", "train"} <= named
    assert len(PROGRAMS) == 2


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_of_the_document_run(line: str, local_stack: Any, folder: Path) -> None:
    program, *words = shlex.split(line)
    assert program == "quadpatch-client"
    if "$JOB" in words:
        with Client(local_stack.url) as client:
            words = [client.repair(folder / "scan.ply").id if word == "$JOB" else word for word in words]
    if words[:2] == ["rules", "show"]:
        with Client(local_stack.url) as client:
            client.save_rule(words[2], RuleContent())
    if words[0] == "watch":
        words.append("--once")
    done = CliRunner().invoke(app, words, env={"QUADPATCH_CLIENT_URL": local_stack.url})
    assert done.exit_code == 0, done.stderr


@pytest.mark.parametrize("program", PROGRAMS)
def test_programs_of_the_document_run(program: str, local_stack: Any, folder: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", f"URL = {local_stack.url!r}\n{program}"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=GUARD_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    made = [*folder.glob("repaired.ply"), *folder.glob("scans/*.repaired.ply")]
    assert made, done.stdout
