"""`python -m tests.faults.batches`: a batch of meshes while API, worker and dispatcher are killed.

Each mesh has to have one result, the archive has to open, and its table has to agree with it. The exit code is 1 where
one of these does not hold.
"""

import argparse
import csv
import hashlib
import io
import itertools
import json
import logging
import random
import signal
import sys
import tempfile
import time
import zipfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.faults.backends import BackendName, open_backend
from tests.faults.cluster import APIS, DISPATCHERS, WORKERS, Cluster, Setup
from tests.faults.load import SMOOTH, ExpectedState, Station, make_mesh
from tests.faults.network import open_network
from tests.waiting import GUARD_S

_LOOK_S = 0.5
_log = logging.getLogger("faults")


@dataclass(frozen=True)
class BatchCampaign:
    """How large a batch is, and how often each kind of process is killed meanwhile."""

    n_meshes: int
    n_kills: int = 1
    backend: BackendName = "sqlite-local"
    settings: dict[str, str] = field(default_factory=dict)
    timeout_s: float = 4 * GUARD_S


@dataclass(frozen=True)
class BatchOutcome:
    """What came of it; `faults` are sentences, none where all is right."""

    faults: list[str]
    counts: dict[str, int]
    kills: Counter[str]
    attempts: Counter[int]
    n_events: int
    archive_bytes: int
    create_s: float
    total_s: float


def run_batch(campaign: BatchCampaign, root: Path) -> BatchOutcome:
    """Run a batch in an empty folder, and check what it left."""
    with ExitStack() as stack:
        network = stack.enter_context(open_network(False))
        backend = stack.enter_context(open_backend(campaign.backend, root, network))
        settings = {**campaign.settings, **backend.environment}
        setup = Setup(root, backend.data.folder, network, settings, backend.shares_data)
        cluster = stack.enter_context(_running(Cluster(setup, backend.servers)))
        urls = [cluster.url(name) for name in APIS]
        station = stack.enter_context(closing(Station(urls, ExpectedState())))
        return _run(campaign, cluster, station)


def _run(campaign: BatchCampaign, cluster: Cluster, station: Station) -> BatchOutcome:
    mesh_ids = [station.upload(make_mesh(seed, 0)) for seed in range(campaign.n_meshes)]
    _log.info("%d meshes uploaded", len(mesh_ids))
    started = time.monotonic()
    body = {"mesh_ids": mesh_ids, "spec": {"method": SMOOTH, "output": {"preview": False}}}
    made = station.request("POST", "/v1/batches", json=body, headers={"Idempotency-Key": "batch"})[0].json()
    create_s, path = time.monotonic() - started, f"/v1/batches/{made['id']}"
    kills = _kill_meanwhile(campaign, cluster, station, path)
    batch = _get(station, path)
    total_s = time.monotonic() - started
    jobs = list(_jobs(station, made["id"]))
    events = list(_events(station, path))
    archive, _ = station.request("GET", f"{path}/results.zip")
    table, _ = station.request("GET", f"{path}/figures.csv")
    faults = [
        *_faults_of_jobs(mesh_ids, jobs, batch),
        *_faults_of_events(events, batch),
        *_faults_of_archive(archive.content, table.content, jobs),
    ]
    attempts = Counter(job["attempt"] for job in jobs)
    return BatchOutcome(faults, batch["counts"], kills, attempts, len(events), len(archive.content), create_s, total_s)


def _kill_meanwhile(campaign: BatchCampaign, cluster: Cluster, station: Station, path: str) -> Counter[str]:
    """Kill a process of each kind so often, spread over the batch, and wait for its end."""
    rng, kills = random.Random(campaign.n_meshes), Counter[str]()
    groups = [APIS, WORKERS, DISPATCHERS] * campaign.n_kills
    steps = [(place + 1) / (len(groups) + 1) for place in range(len(groups))]
    due = iter([*zip(steps, groups, strict=True), (2.0, ())])
    share, group = next(due)
    deadline = time.monotonic() + campaign.timeout_s
    while (batch := _get(station, path))["state"] != "ended":
        if time.monotonic() > deadline:
            raise AssertionError(f"the batch has not ended: {batch['counts']}")
        n_done = sum(batch["counts"].get(state, 0) for state in ("succeeded", "succeeded_with_warnings", "failed"))
        while n_done >= share * batch["n_jobs"]:
            name = rng.choice(group)
            cluster.kill(name, signal.SIGKILL)
            kills[name.partition("-")[0]] += 1
            _log.info("%s killed at %d of %d jobs", name, n_done, batch["n_jobs"])
            share, group = next(due)
        time.sleep(_LOOK_S)
    return kills


def _faults_of_jobs(mesh_ids: Sequence[str], jobs: Sequence[dict[str, Any]], batch: dict[str, Any]) -> Iterator[str]:
    if [job["mesh_id"] for job in jobs] != list(mesh_ids):
        yield f"{len(jobs)} jobs for {len(mesh_ids)} meshes, or in another order"
    states = Counter(job["state"] for job in jobs)
    if states != Counter(batch["counts"]):
        yield f"the batch counts {batch['counts']}, its jobs are {dict(states)}"
    yield from (f"job {job['id']} is {job['state']}: {job['error']}" for job in jobs if job["result"] is None)


def _faults_of_events(events: Sequence[dict[str, Any]], batch: dict[str, Any]) -> Iterator[str]:
    if [event["sequence"] for event in events] != [*range(1, batch["revision"] + 1)]:
        yield "the numbers of the events have gaps"
    if [event["type"] for event in events].count("ended") != 1 or events[-1]["type"] != "ended":
        yield "the end was not told once, and last"


def _faults_of_archive(data: bytes, table: bytes, jobs: Sequence[dict[str, Any]]) -> Iterator[str]:
    archive = zipfile.ZipFile(io.BytesIO(data))
    if (broken := archive.testzip()) is not None:
        yield f"{broken} in the archive is damaged"
    if archive.read("figures.csv") != table:
        yield "the table in the archive is another one"
    rows = list(csv.DictReader(io.StringIO(table.decode(), newline="")))
    if [row["job_id"] for row in rows] != [job["id"] for job in jobs]:
        yield "the table has other jobs"
    if sorted(archive.namelist()) != sorted(["figures.csv", *(row["file"] for row in rows if row["file"])]):
        yield "the table names other files than the archive has"
    for row, job in zip(rows, jobs, strict=True):
        file = next(file for file in job["result"]["files"] if file["role"] == "result")
        sha256 = hashlib.sha256(archive.read(row["file"])).hexdigest()
        n_holes = str(job["result"]["holes"]["found"])
        if (sha256, n_holes) != (row["file_sha256"], row["holes_found"]) or sha256 != file["sha256"]:
            yield f"the line of job {job['id']} is wrong"


def _get(station: Station, path: str) -> dict[str, Any]:
    found: dict[str, Any] = station.request("GET", path)[0].raise_for_status().json()
    return found


def _jobs(station: Station, batch_id: str) -> Iterator[dict[str, Any]]:
    cursor = ""
    while cursor is not None:
        page = _get(station, f"/v1/jobs?batch_id={batch_id}&oldest_first=true&limit=200" + cursor)
        yield from page["items"]
        cursor = page["next_cursor"] and f"&cursor={page['next_cursor']}"


def _events(station: Station, path: str) -> Iterator[dict[str, Any]]:
    for after in itertools.accumulate(itertools.repeat(1000), initial=0):
        page = _get(station, f"{path}/events?after={after}&limit=1000")
        yield from page["items"]
        if page["next_after"] is None:
            return


@contextmanager
def _running(cluster: Cluster) -> Iterator[Cluster]:
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()


def main(arguments: list[str]) -> int:
    """Run one batch; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.faults.batches", description=__doc__)
    parser.add_argument("--meshes", type=int, default=500)
    parser.add_argument("--kills", type=int, default=3, help="how often an API, a worker and a dispatcher are killed")
    parser.add_argument("--backend", choices=("sqlite-local", "postgres-s3"), default="sqlite-local")
    parser.add_argument("--timeout", type=float, default=7200.0, help="seconds")
    chosen = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(message)s")
    logging.getLogger("httpx").setLevel(logging.WARNING)
    campaign = BatchCampaign(chosen.meshes, chosen.kills, chosen.backend, timeout_s=chosen.timeout)
    with tempfile.TemporaryDirectory(prefix="quadpatch-batch-") as folder:
        outcome = run_batch(campaign, Path(folder))
    sys.stdout.write(json.dumps(outcome.__dict__, indent=1) + "\n")
    return 1 if outcome.faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
