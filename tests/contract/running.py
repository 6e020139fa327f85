"""How schemathesis is run against a live service: its settings, and what exists there for it to find."""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import httpx

from tests.waiting import GUARD_S

ROOT = Path(__file__).parents[2]
KEY = "the-key-of-the-contract"
HEADERS = {"Authorization": f"Bearer {KEY}"}


@dataclass(frozen=True)
class Known:
    """Ids of what exists, so that requests reach more than a 404."""

    job_id: str
    model: str
    webhook_id: str
    delivery_id: str
    upload_id: str


def write_configuration(path: Path, known: Known) -> Path:
    """Write the project's settings of schemathesis, and after them the ids; return the path."""
    path.write_text(
        (ROOT / "schemathesis.toml").read_text()
        + f"""
[[operations]]
include-path-regex = "/(result|report|preview.png|events)$"
parameters = {{ "path.job_id" = "{known.job_id}" }}

[[operations]]
include-path-regex = "^/v1/models/{{name}}"
include-method = "GET"
parameters = {{ "path.name" = "{known.model}", "path.version" = 1 }}

[[operations]]
include-path-regex = "^/v1/webhooks/{{webhook_id}}/(deliveries|test|rotate)"
parameters = {{ "path.webhook_id" = "{known.webhook_id}", "path.delivery_id" = "{known.delivery_id}" }}

[[operations]]
include-path-regex = "^/v1/uploads/{{upload_id}}$"
include-method = ["GET", "PATCH"]
parameters = {{ "path.upload_id" = "{known.upload_id}" }}
"""
    )
    return path


def start_upload(url: str) -> str:
    """Start a resumable upload; return its id."""
    headers = {**HEADERS, "Tus-Resumable": "1.0.0", "Upload-Length": "1000"}
    return str(httpx.post(f"{url}/v1/uploads", headers=headers, timeout=GUARD_S).raise_for_status().json()["id"])


def command(url: str, configuration: Path, n_examples: int, seed: int | None = None) -> list[str]:
    """Return the command line: every check, every phase; without a seed the same requests each time."""
    return [
        str(Path(sys.executable).parent / "schemathesis"),
        f"--config-file={configuration}",
        "run",
        f"{url}/openapi.json",
        f"--header=Authorization:Bearer {KEY}",
        "--checks=all",
        f"--max-examples={n_examples}",
        "--generation-deterministic" if seed is None else f"--seed={seed}",
        "--no-color",
        "--warnings=off",
        f"--request-timeout={GUARD_S:g}",
        "--suppress-health-check=too_slow",
    ]


def run(words: list[str], folder: Path, timeout_s: float | None) -> tuple[int, str]:
    """Run schemathesis in a folder; return its exit code and what it says, which stays in `schemathesis.log` there."""
    path = folder / "schemathesis.log"
    with path.open("w") as log:
        found = subprocess.run(
            words,
            cwd=folder,
            env={**os.environ, "SCHEMATHESIS_HOOKS": str(Path(__file__).with_name("schemathesis_hooks.py"))},
            stdout=log,
            stderr=subprocess.STDOUT,
            timeout=timeout_s,
            check=False,
        )
    return found.returncode, path.read_text()
