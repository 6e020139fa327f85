"""The running service against its own document: every check of schemathesis, fixed seed, bounded number of requests."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx

from jobkit.attempts import Attempts
from jobkit.database import Database
from jobkit.schema import JobResult, ResultFile
from jobkit.settings import Settings
from jobkit.store import open_store, result_key

ROOT = Path(__file__).parents[2]
KEY = "the-key-of-the-contract"
HEADERS = {"Authorization": f"Bearer {KEY}"}


def test_schemathesis_finds_nothing(
    serve: Callable[..., Any], settings: Settings, dictionary_bytes: Callable[[int], bytes], tmp_path: Path
) -> None:
    with serve(api_keys=KEY, max_wait_s=0.1, max_upload_mb=4) as service:
        job_id = furnish(service.url, settings, dictionary_bytes(1))
        configuration = tmp_path / "schemathesis.toml"
        configuration.write_text(
            (ROOT / "schemathesis.toml").read_text()
            # Things that exist, so that requests reach more than a 404.
            + f"""
[[operations]]
include-path-regex = "/(result|report|preview.png|events)$"
parameters = {{ "path.job_id" = "{job_id}" }}

[[operations]]
include-path-regex = "^/v1/models/{{name}}"
include-method = "GET"
parameters = {{ "path.name" = "general-dictionary", "path.version" = 1 }}
"""
        )
        found = subprocess.run(
            [
                str(Path(sys.executable).parent / "schemathesis"),
                f"--config-file={configuration}",
                "run",
                f"{service.url}/openapi.json",
                f"--header=Authorization:Bearer {KEY}",
                "--checks=all",
                "--max-examples=6",
                "--seed=1",
                "--generation-deterministic",
                "--no-color",
                "--warnings=off",
            ],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=240,
            check=False,
        )
    assert found.returncode == 0, found.stdout[-20_000:] + found.stderr
    assert "Selected: 21/21" in found.stdout
    assert "Tested: 21" in found.stdout


def furnish(url: str, settings: Settings, dictionary: bytes) -> str:
    """Publish a model, and bring one job to its end as a worker does; return its id."""
    with httpx.Client(base_url=url, headers=HEADERS) as client:
        client.post("/v1/models/general-dictionary/versions", content=dictionary).raise_for_status()
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
        ("report", "report.json", b"{}"),
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
