"""The document, read by the linters that integrators use; not one warning is left."""

from pathlib import Path

import pytest

from tests.contract.tools import DOCUMENT, NODE, run_node

LINTERS = {
    "redocly": ["redocly", "lint", "--config", str(NODE / "redocly.yaml")],
    "spectral": ["spectral", "lint", "--ruleset", str(NODE / "spectral.yaml"), "--fail-severity", "hint"],
}


@pytest.mark.parametrize("name", LINTERS)
def test_a_linter_finds_nothing(name: str) -> None:
    done = run_node([*LINTERS[name], str(DOCUMENT)])
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("name", LINTERS)
def test_a_linter_finds_a_reference_that_leads_nowhere(name: str, tmp_path: Path) -> None:
    damaged = tmp_path / "openapi.yaml"
    damaged.write_text(DOCUMENT.read_text("utf-8").replace("schemas/MeshPage'", "schemas/Nothing'"), "utf-8")
    done = run_node([*LINTERS[name], str(damaged)])
    assert done.returncode != 0
    assert "Nothing" in done.stdout + done.stderr
