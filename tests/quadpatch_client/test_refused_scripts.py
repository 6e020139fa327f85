"""Scripts of `docs/cookbook.md` at a service that refuses: they end, and say so by their exit code."""

import os
import subprocess
from pathlib import Path
from typing import Any

import pytest

from tests.integration.test_cookbook import COOKBOOK, SHELL, blocks
from tests.quadpatch_client.conftest import ScriptedServer
from tests.waiting import GUARD_S


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "scans").mkdir()
    for name in ("scan.ply", "scans/a.ply", "scans/b.ply"):
        (tmp_path / name).write_bytes(b"ply")
    return tmp_path


def exit_code(command: list[str], folder: Path, url: str) -> int:
    environment = {**os.environ, "URL": url, "SCAN": "scan.ply"}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, timeout=GUARD_S, check=False)
    return done.returncode


@pytest.mark.parametrize("script", blocks(COOKBOOK, "sh"))
def test_a_script_ends_at_the_first_request_that_is_refused(
    script: str, server: ScriptedServer, answers: Any, folder: Path
) -> None:
    server.answers = [answers["answer"](404)]
    assert exit_code([*SHELL, script], folder, server.url) != 0
    assert len(server.requests) == 1


@pytest.mark.parametrize("script", [block for block in blocks(COOKBOOK, "sh") if "while" in block.values[0]])
def test_what_is_pasted_into_a_terminal_does_not_ask_for_ever(
    script: str, server: ScriptedServer, answers: Any, folder: Path
) -> None:
    server.answers = [answers["answer"](202, b'{"id": "x"}'), answers["answer"](404)]
    assert exit_code(["bash", "-c", script], folder, server.url) != 0
