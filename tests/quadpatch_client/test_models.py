"""The list of models, fetched page by page."""

import json
from collections.abc import Callable
from typing import Any

from typer.testing import CliRunner

from quadpatch_client.cli import app
from quadpatch_client.sdk import Client

SHA256 = "0" * 64


def version(name: str, **more: Any) -> dict[str, Any]:
    path = f"/v1/models/{name}/versions/1"
    return {
        "name": name,
        "version": 1,
        "kind": "dictionary",
        "sha256": SHA256,
        "size_bytes": 1,
        "format": "safetensors",
        "card": {},
        "created_at": "2026-11-22T09:15:02.250Z",
        "links": {"self": path, "artifact": f"{path}/artifact"},
        **more,
    }


def page(name: str, next_cursor: str | None, **more: Any) -> bytes:
    models = [{"name": name, "latest": 1, "versions": [version(name, **more)]}]
    return json.dumps({"models": models, "aliases": [], "next_cursor": next_cursor}).encode()


def test_all_pages_are_one_list(server: Any, answers: dict[str, Callable[..., Any]]) -> None:
    answer = answers["answer"]
    server.answers = [answer(200, page("a", "a")), answer(200, page("b", None))]
    with Client(server.url) as client:
        assert [model.name for model in client.models().models] == ["a", "b"]
    assert [path for _, path, _, _ in server.requests] == ["/v1/models?limit=100", "/v1/models?limit=100&cursor=a"]


def test_the_table_says_what_may_be_used(server: Any, answers: dict[str, Callable[..., Any]]) -> None:
    answer = answers["answer"]
    refused = {"state": "refused", "problem": {"code": "unusable_model", "message": "no unit norm"}}
    deprecated = {"deprecated": {"at": "2026-11-22T09:15:02.250Z"}}
    server.answers = [
        answer(200, page("a", "a", **refused)),
        answer(200, page("b", "b", **deprecated)),
        answer(200, page("c", "c", state="proving")),
        # An older service says nothing of states.
        answer(200, page("d", None)),
    ]
    shown = CliRunner().invoke(app, ["models", "--url", server.url], env={"COLUMNS": "200"}).stdout
    for words in ("refused: no unit norm", "deprecated", "proving", "ready"):
        assert words in shown
