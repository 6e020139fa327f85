"""The client is a distribution of its own, of the version of the service."""

import tomllib
from importlib.metadata import requires
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[2]
CLIENT = tomllib.loads((ROOT / "client/pyproject.toml").read_text("utf-8"))["project"]
SERVICE = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


def test_the_client_has_the_version_of_the_service_which_needs_just_that() -> None:
    assert CLIENT["version"] == SERVICE["version"]
    assert f"quadpatch-client=={SERVICE['version']}" in SERVICE["dependencies"]
    assert CLIENT["requires-python"] == SERVICE["requires-python"]


def test_the_client_asks_for_few_libraries_in_the_bounds_of_the_service() -> None:
    asked = [Requirement(text) for text in requires("quadpatch-client") or []]
    assert {requirement.name for requirement in asked} == {"httpx", "pydantic", "rich", "typer"}
    own = {*SERVICE["dependencies"], *SERVICE["optional-dependencies"]["service"]}
    assert set(CLIENT["dependencies"]) <= own
