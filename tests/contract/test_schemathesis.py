"""The running service against its own document: every check of schemathesis, fixed seed, bounded number of requests."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest

from jobkit.database.session import Database
from jobkit.jobs.attempts import Attempts
from jobkit.models.proofs import Proofs
from jobkit.settings import Settings
from jobkit.storage.base import result_key
from jobkit.storage.open import open_store
from quadpatch_client.schema import JobResult, ResultFile
from tests.contract.running import HEADERS, KEY, Known, command, run, start_upload, write_configuration
from tests.waiting import GUARD_S


@pytest.mark.slow
def test_schemathesis_finds_nothing(
    serve: Callable[..., Any],
    settings: Settings,
    dictionary_bytes: Callable[[int], bytes],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # Names in the URLs of subscriptions are looked up; without a network that should fail soon.
    monkeypatch.setenv("RES_OPTIONS", "timeout:1 attempts:1")
    with serve(api_keys=KEY, max_wait_s=0.1, max_upload_mb=4) as service:
        document = httpx.get(f"{service.url}/openapi.json", timeout=GUARD_S).json()
        job_id = furnish(service.url, settings, dictionary_bytes(1), report_of(document))
        webhook_id, delivery_id = subscribe(service.url)
        known = Known(job_id, "general-dictionary", webhook_id, delivery_id, start_upload(service.url))
        configuration = write_configuration(tmp_path / "schemathesis.toml", known)
        code, said = run(command(service.url, configuration, 4), tmp_path, 2 * GUARD_S)
    assert code == 0, said[-20_000:]
    count = sum(len(operations) for operations in document["paths"].values())
    assert f"Selected: {count}/{count}" in said
    assert f"Tested: {count}" in said


def subscribe(url: str) -> tuple[str, str]:
    """Make a subscription and a delivery to it; return their ids."""
    with httpx.Client(base_url=url, headers=HEADERS, timeout=GUARD_S) as client:
        webhook = client.post("/v1/webhooks", json={"url": "https://8.8.8.8/hook"}).raise_for_status().json()
        delivery = client.post(webhook["links"]["test"]).raise_for_status().json()
    return webhook["id"], delivery["id"]


def prove(settings: Settings, reference: str) -> None:
    """Do what a worker does with a model that can be used."""
    database = Database(settings.effective_database_url)
    proofs = Proofs(database)
    proofs.accept(proofs.start(reference, "test", 60))
    database.close()


def report_of(document: dict[str, Any]) -> bytes:
    """Return the report that the document shows as an example."""
    answer = document["paths"]["/v1/jobs/{job_id}/report"]["get"]["responses"]["200"]
    return json.dumps(answer["content"]["application/json"]["example"]).encode()


def furnish(url: str, settings: Settings, dictionary: bytes, report: bytes) -> str:
    """Publish a model, and bring one job to its end as a worker does; return its id."""
    with httpx.Client(base_url=url, headers=HEADERS, timeout=GUARD_S) as client:
        path = "/v1/models/general-dictionary/versions"
        client.post(path, content=dictionary, headers={"Prefer": "wait=0"}).raise_for_status()
        prove(settings, "general-dictionary@1")
        client.put("/v1/aliases/default", json={"model": "general-dictionary@1"}).raise_for_status()
        mesh = client.post("/v1/meshes?filename=scan.ply", content=b"ply").raise_for_status().json()
        job_id = str(client.post("/v1/jobs", json={"mesh_id": mesh["id"]}).raise_for_status().json()["id"])
    database = Database(settings.effective_database_url)
    store = open_store(settings.effective_object_store_url)
    attempts = Attempts(database)
    attempt = attempts.start(job_id, "test", 60).attempt
    files = []
    for role, name, data in (
        ("result", "repaired.ply", b"ply"),
        ("report", "report.json", report),
        ("preview", "p.png", b"\x89PNG"),
    ):
        with store.writer("") as writer:
            writer.write(data)
            stored = writer.commit(result_key(job_id, attempt.number, name))
        facts = {"media_type": "application/octet-stream", "size_bytes": stored.size_bytes, "sha256": stored.sha256}
        files.append(ResultFile.model_validate({"role": role, "name": name, **facts}))
    attempts.publish(attempt, JobResult(format="ply", files=files))
    database.close()
    return job_id
