"""`python -m tests.contract`, or `make contract`: schemathesis with many examples against a local stack.

A real Valkey, dispatcher, API and workers run meanwhile. The exit code is 1 where a check failed, fewer requests were
made than asked for, a process was lost, or `GET /v1/jobs` does not answer afterwards. The dispatcher looks up the
names of webhooks that schemathesis makes up, and tries to deliver to those that it finds.
"""

import argparse
import os
import re
import sys
import tempfile
from pathlib import Path

import httpx
import psutil

from onebox.demo import running_stack
from quadpatch_client.schema import JobSpec
from quadpatch_client.sdk import Client
from tests.contract.running import HEADERS, KEY, Known, command, run, start_upload, write_configuration
from tests.quadpatch.shapes import open_grid, punched, write_ply
from tests.servers import free_port
from tests.waiting import GUARD_S

_SETTINGS = {
    "QUADPATCH_API_KEYS": KEY,
    "QUADPATCH_MAX_WAIT_S": "0.1",
    "QUADPATCH_MAX_UPLOAD_MB": "4",
    "QUADPATCH_WEBHOOK_ALLOWED_NETWORKS": "127.0.0.0/8",
    "QUADPATCH_LOG_FORMAT": "json",
    "RES_OPTIONS": "timeout:1 attempts:1",
}
_MODEL = "general-dictionary"
# `GET /metrics` counts every request that was answered.
_COUNTED = re.compile(r"^quadpatch_http_request_duration_seconds_count\{.*\} ([0-9.]+)$", re.MULTILINE)


def main(arguments: list[str]) -> int:
    """Run one campaign; returns the exit code."""
    parser = argparse.ArgumentParser(prog="make contract ARGS=...", description=__doc__)
    parser.add_argument("--examples", type=int, default=60, help="of each operation and phase; default 60")
    parser.add_argument("--requests", type=int, default=5000, help="that have to be answered; default 5000")
    parser.add_argument("--seed", type=int, default=1, help="of all chance; default 1")
    parser.add_argument("--keep", type=Path, help="folder for data and logs, kept; default: a temporary one")
    chosen = parser.parse_args(arguments)
    os.environ.update(_SETTINGS)
    if chosen.keep is not None:
        chosen.keep.mkdir(parents=True)
        return _campaign(chosen, chosen.keep)
    with tempfile.TemporaryDirectory(prefix="quadpatch-contract-") as folder:
        return _campaign(chosen, Path(folder))


def _campaign(chosen: argparse.Namespace, folder: Path) -> int:
    with running_stack(folder / "stack") as url:
        configuration = write_configuration(folder / "schemathesis.toml", furnish(url, folder))
        before, pids = answered(url), processes(folder)
        code, said = run(command(url, configuration, chosen.examples, chosen.seed), folder, None)
        n_answered = answered(url) - before
        jobs = httpx.get(f"{url}/v1/jobs", headers=HEADERS, timeout=GUARD_S)
        faults = {
            "schemathesis found failures": code != 0,
            f"{n_answered} requests, fewer than {chosen.requests}": n_answered < chosen.requests,
            f"GET /v1/jobs answers {jobs.status_code}": not jobs.is_success,
            "a process was lost": processes(folder) != pids,
        }
    sys.stdout.write(said)
    sys.stdout.write(f"\n{n_answered} requests answered; GET /v1/jobs: {jobs.status_code}\n")
    sys.stdout.write("".join(f"NOT KEPT: {words}\n" for words, is_so in faults.items() if is_so))
    return 1 if any(faults.values()) else 0


def furnish(url: str, folder: Path) -> Known:
    """Repair a small mesh, and subscribe to a port of this machine where nothing listens."""
    path = write_ply(folder / "plate.ply", punched(open_grid(20), (0.0, 0.0, 0.0), radius=0.2))
    with Client(url, KEY) as client:
        mesh = client.upload(path)
        spec = {"mesh_id": mesh.id, "method": {"method": "smooth"}, "output": {"preview": True}}
        job = client.wait(client.create_job(JobSpec.model_validate(spec)).id, timeout_s=GUARD_S)
    with httpx.Client(base_url=url, headers=HEADERS, timeout=GUARD_S) as http:
        hook = {"url": f"http://127.0.0.1:{free_port()}/hook"}
        webhook = http.post("/v1/webhooks", json=hook).raise_for_status().json()
        delivery = http.post(webhook["links"]["test"]).raise_for_status().json()
    return Known(job.id, _MODEL, webhook["id"], delivery["id"], start_upload(url))


def answered(url: str) -> int:
    """Return how many requests the API has answered."""
    text = httpx.get(f"{url}/metrics", headers=HEADERS, timeout=GUARD_S).raise_for_status().text
    return int(sum(float(number) for number in _COUNTED.findall(text)))


def processes(folder: Path) -> set[int]:
    """Return the ids of the local stack's own processes; engines come and go, and do not count."""
    (local_stack,) = [p for p in psutil.Process().children() if str(folder / "stack") in p.cmdline()]
    return {child.pid for child in local_stack.children()}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
