"""Documents, examples and messages agree with the code."""

import inspect
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

import quadpatch_client.sdk
from benchmarks.samples import BLOCK, DOCUMENTS, ELLIPSIS, RECORD, line, wrapped
from jobkit.jobs.timeouts import CANCEL_TIMEOUT_S
from quadpatch_client.schema import HoleCounts, Job, JobResult, Mesh, MeshFacts
from tests.waiting import GUARD_S, wait_until

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "SECURITY.md", *sorted((ROOT / "docs").rglob("*.md"))]
TEXTS = [*PAGES, *ROOT.glob("service/**/*.py")]
SOURCES = [
    p for folder in ("quadpatch", "training", "client", "worker", "onebox") for p in ROOT.glob(f"{folder}/**/*.py")
]


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_curl_saves_no_error_as_a_mesh(path: Path) -> None:
    for row in path.read_text("utf-8").splitlines():
        for options in re.findall(r"\bcurl -(\w*O\w*)", row):
            assert "f" in options, row


@pytest.mark.parametrize("path", [*TEXTS, *SOURCES], ids=lambda path: str(path.relative_to(ROOT)))
def test_no_document_names_an_index_that_does_not_have_the_project(path: Path) -> None:
    assert not re.search(r"install '?quadpatch\b", path.read_text("utf-8"))


def test_the_docstring_of_the_sdk_calls_methods_that_there_are() -> None:
    called = re.findall(r"\bclient\.(\w+)\(", inspect.getdoc(quadpatch_client.sdk) or "")
    assert {"upload", "create_job", "wait", "download"} <= set(called)
    assert all(callable(getattr(quadpatch_client.sdk.Client, name)) for name in called)


def test_examples_of_codes_are_codes_and_of_instances_instances() -> None:
    document = yaml.safe_load((ROOT / "openapi.yaml").read_text("utf-8"))
    schemas: dict[str, Any] = document["components"]["schemas"]
    table = (ROOT / "docs/api.md").read_text("utf-8")
    method = (ROOT / "docs/method.md").read_text("utf-8")
    shown = {
        (name, example)
        for name, schema in schemas.items()
        for example in schema.get("properties", {}).get("code", {}).get("examples", [])
    }
    assert {name for name, _ in shown} >= {"JobError", "MeshProblem", "Problem"}
    for name, example in shown:
        # Codes of single fields are those of the validation, those of holes explain verdicts.
        is_explained = f"`{example}`" in method if name == "HoleReport" else f"| `{example}` |" in table
        assert name == "FieldError" or is_explained, (name, example)
    assert schemas["Problem"]["properties"]["instance"]["examples"][0].startswith("urn:quadpatch:request:")


def test_the_wait_for_a_cancel_is_that_of_the_code() -> None:
    parts = (ROOT / "docs/architecture.md").read_text("utf-8").split("\n## ")
    (life,) = [part for part in parts if part.startswith("Life of a job")]
    assert f"{CANCEL_TIMEOUT_S} s" in life


def test_a_local_stack_that_is_stopped_while_it_starts_does_not_say_that_it_is_ready(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "onebox", "serve", "--data", str(tmp_path / "var"), "--port", "0"]
    said = tmp_path / "said"
    environment = {k: v for k, v in os.environ.items() if not k.startswith("QUADPATCH_")}
    with said.open("wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output, env=environment)
    try:
        # The queue is the first to start; the API has not begun to import by then.
        wait_until(lambda: list((tmp_path / "var" / "logs").glob("valkey.log")), process)
        process.send_signal(signal.SIGTERM)
        assert process.wait(timeout=GUARD_S) == 0
    finally:
        process.kill()
        process.wait()
    assert "is ready on" not in said.read_text("utf-8")
    assert "stopped before it was ready" in said.read_text("utf-8")


def test_samples_are_those_that_the_script_wrote() -> None:
    recorded = json.loads(RECORD.read_text("utf-8"))
    shown = {m["name"]: m["text"] for path in DOCUMENTS for m in BLOCK.finditer(path.read_text("utf-8"))}
    assert shown == recorded


@pytest.mark.parametrize(
    ("name", "models"),
    [
        ("start", (Job,)),
        ("wait", (Job, JobResult, HoleCounts)),
        ("follow", (Job, JobResult, HoleCounts)),
        ("upload", (Mesh,)),
        ("mesh", (Mesh, MeshFacts)),
    ],
)
def test_samples_show_fields_of_the_contract(name: str, models: tuple[Any, ...]) -> None:
    answer = json.loads(RECORD.read_text("utf-8"))[name].split("\n", 1)[1]
    whole = json.loads(re.sub(rf",\s*{ELLIPSIS}", "", answer))
    assert whole.keys() <= models[0].model_fields.keys()
    for field, model in zip(("result", "facts"), models[1:2] * 2, strict=False):
        if whole.get(field):
            assert whole[field].keys() <= model.model_fields.keys()
    if HoleCounts in models:
        counts = HoleCounts.model_validate(whole["result"]["holes"])
        assert counts.found == counts.filled + counts.filled_smooth + counts.skipped + counts.refused


def test_a_sample_is_broken_between_its_members() -> None:
    answer = {"a": "x" * 80, "b": "y" * 80}
    text = wrapped(line(answer, ("a", "b")))
    assert len(text.splitlines()) == 2
    assert json.loads(re.sub(rf",\s*{ELLIPSIS}", "", text)) == answer
