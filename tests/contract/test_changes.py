"""The comparison of two documents finds what breaks clients, and nothing else."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.contract.changes import changes, main

MESH = {
    "type": "object",
    "required": ["id"],
    "properties": {"id": {"type": "string"}, "size": {"type": "integer"}},
}
SPEC = {"type": "object", "properties": {"task": {"type": "string", "enum": ["fill", "denoise"]}}}
Edit = Callable[[dict[str, Any]], Any]


def document() -> dict[str, Any]:
    def reference(name: str) -> dict[str, Any]:
        return {"content": {"application/json": {"schema": {"$ref": f"#/components/schemas/{name}"}}}}

    answer = {"200": {"description": "It.", **reference("Mesh")}}
    show = {"operationId": "show", "responses": answer}
    start = {"operationId": "start", "requestBody": reference("Spec"), "responses": answer}
    limit = {"name": "limit", "in": "query", "schema": {"type": "integer", "maximum": 100}}
    return {
        "openapi": "3.1.0",
        "info": {"title": "Meshes", "version": "1"},
        "paths": {"/meshes": {"get": {**show, "parameters": [limit]}, "post": start}},
        "components": {"schemas": {"Mesh": yaml.safe_load(yaml.dump(MESH)), "Spec": yaml.safe_load(yaml.dump(SPEC))}},
    }


def written(path: Path, content: dict[str, Any]) -> Path:
    path.write_text(yaml.safe_dump(content), "utf-8")
    return path


def schema(content: dict[str, Any], name: str) -> dict[str, Any]:
    found: dict[str, Any] = content["components"]["schemas"][name]
    return found


BREAKS: dict[str, Edit] = {
    "an operation is gone": lambda d: d["paths"]["/meshes"].pop("post"),
    "a field of an answer is gone": lambda d: schema(d, "Mesh")["properties"].pop("size"),
    "a field of an answer has another type": lambda d: schema(d, "Mesh")["properties"].update(size={"type": "string"}),
    "a field of a request is needed": lambda d: schema(d, "Spec").update(required=["task"]),
    "a value of a request is refused": lambda d: schema(d, "Spec")["properties"]["task"]["enum"].pop(),
    "a limit is lower": lambda d: d["paths"]["/meshes"]["get"]["parameters"][0]["schema"].update(maximum=10),
    "a status is gone": lambda d: d["paths"]["/meshes"]["get"]["responses"].pop("200"),
}
COMPATIBLE: dict[str, Edit] = {
    "nothing": lambda _: None,
    "an operation is new": lambda d: d["paths"].update({"/jobs": d["paths"]["/meshes"]}),
    "a field of an answer is new": lambda d: schema(d, "Mesh")["properties"].update(name={"type": "string"}),
    "a field of a request is new": lambda d: schema(d, "Spec")["properties"].update(seed={"type": "integer"}),
    "a value of a request is new": lambda d: schema(d, "Spec")["properties"]["task"]["enum"].append("encode"),
    "words": lambda d: d["info"].update(description="All about meshes."),
}


@pytest.mark.parametrize("name", BREAKS)
def test_a_change_that_breaks_clients_is_found(name: str, tmp_path: Path) -> None:
    after = document()
    BREAKS[name](after)
    paths = written(tmp_path / "before.yaml", document()), written(tmp_path / "after.yaml", after)
    assert any(change.is_breaking for change in changes(*paths))


@pytest.mark.parametrize("name", COMPATIBLE)
def test_a_change_that_clients_do_not_notice_is_none(name: str, tmp_path: Path) -> None:
    after = document()
    COMPATIBLE[name](after)
    paths = written(tmp_path / "before.yaml", document()), written(tmp_path / "after.yaml", after)
    assert not [change for change in changes(*paths) if change.is_breaking]


def test_the_command_says_where(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    after = document()
    BREAKS["an operation is gone"](after)
    paths = [str(written(tmp_path / "before.yaml", document())), str(written(tmp_path / "after.yaml", after))]
    assert main(paths) == 1
    assert "remove /paths//meshes/post" in capsys.readouterr().out
    assert main([paths[0], paths[0]]) == 0
