"""`docs/cookbook.md` and `docs/stations.md`: every command and program in them does what it says."""

import os
import re
import shlex
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest
import yaml
from typer.testing import CliRunner

from quadpatch_client.cli import app
from tests.integration.test_batch import small_scans
from tests.waiting import GUARD_S

ROOT = Path(__file__).resolve().parents[2]
COOKBOOK = (ROOT / "docs" / "cookbook.md").read_text("utf-8")
# As the cookbook says.
SHELL = ["bash", "-eu", "-o", "pipefail", "-c"]
STATIONS = (ROOT / "docs" / "stations.md").read_text("utf-8")


def blocks(text: str, language: str) -> list[Any]:
    """Blocks of one language, each named by the heading above it."""
    found = []
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        title = section.partition("\n")[0]
        found += [
            pytest.param(block, id=title) for block in re.findall(rf"```{language}\n(.*?)```", section, re.DOTALL)
        ]
    return found


@pytest.fixture
def folder(relief_file: Callable[[str], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    relief_file("float.ply").rename(tmp_path / "scan.ply")
    for name in ("scans", "drop"):
        small_scans(tmp_path / name, 2, "documented")
    (tmp_path / "scans" / "broken.ply").write_bytes(b"ply\n" + bytes(range(256)))
    (rule,) = re.findall(r"```\n(\{.*\})\n```", STATIONS)
    (tmp_path / "rule.json").write_text(rule)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(command: list[str], folder: Path, **environment: str) -> None:
    done = subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=GUARD_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("script", blocks(COOKBOOK, "sh"))
def test_scripts_of_the_cookbook_run(script: str, local_stack: Any, folder: Path) -> None:
    run([*SHELL, script], folder, URL=local_stack.url, SCAN="scan.ply")
    written = re.findall(r"(?:-o |> )(\w\S+?)(?=;|$|\s)", script)
    assert written
    assert all((folder / name).stat().st_size for name in written)
    if "batches" in script:
        assert (folder / "left_out.txt").read_text() == "scans/broken.ply is no mesh\n"
        with zipfile.ZipFile(folder / "results.zip") as archive:
            assert sum(name.endswith(".ply") for name in archive.namelist()) == 2


@pytest.mark.parametrize("program", blocks(COOKBOOK, "python"))
def test_programs_of_the_cookbook_run(program: str, local_stack: Any, folder: Path) -> None:
    run([sys.executable, "-c", f"URL, SCAN = {local_stack.url!r}, 'scan.ply'\n{program}"], folder)


@pytest.mark.parametrize("script", blocks(COOKBOOK, "powershell"))
def test_scripts_for_powershell_name_what_the_contract_has(script: str) -> None:
    contract = yaml.safe_load((ROOT / "openapi.yaml").read_text("utf-8"))
    properties = {
        name for schema in contract["components"]["schemas"].values() for name in schema.get("properties", {})
    }
    requests = re.findall(r"Invoke-\w+(?: -Method (\w+))? -Uri \"\$URL([^\"]+)\"", script)
    assert requests
    for method, path in requests:
        pattern = re.compile(re.sub(r"\\\$\\\(.*?\\\)", "[^/]+", re.escape(path.partition("?")[0])))
        routes = [route for route in contract["paths"] if pattern.fullmatch(re.sub(r"\{\w+\}", "x", route))]
        if "rules/" in path:
            routes = ["/v1/rules/{name}"]
        assert any((method or "Get").lower() in contract["paths"][route] for route in routes), (method, path)
    fields = re.findall(r"(\w+) = (?:@|Get-Item|\"|0|\$_)", script)
    assert set(fields) - {"rule", "body", "ids", "Prefer", "mesh", "file"} <= properties


@pytest.mark.parametrize("line", [line for block in blocks(STATIONS, "sh") for line in block.values[0].splitlines()])
def test_commands_for_stations_run(line: str, local_stack: Any, folder: Path) -> None:
    program, *words = shlex.split(line)
    assert program == "quadpatch-client"
    if "--saved-rule" in words:
        rule = {"acceptance": {"max_error_share": 0.5}}
        httpx.put(f"{local_stack.url}/v1/rules/castings", json=rule, timeout=GUARD_S).raise_for_status()
    if words[0] == "watch":
        words.append("--once")
    done = CliRunner().invoke(app, words, env={"QUADPATCH_CLIENT_URL": local_stack.url})
    assert done.exit_code == 0, done.stderr
