"""The API of a local stack to put under load: started in a fresh folder, filled with jobs, some of them moving."""

import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil

from jobkit.database.session import Database
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.endings import Attempt
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.settings import Settings
from jobkit.storage.open import open_store
from onebox.local_stack import ready_check, usable_port
from onebox.valkey import running_valkey
from quadpatch_client.schema import HoleCounts, JobResult, JobSpec, ResolvedModel

HOST = "127.0.0.1"
# Jobs that workers report progress of, as often as they do at most.
N_RUNNING, _PROGRESS_S = 4, 0.5
_START_S = 60.0


@dataclass(frozen=True)
class RunningService:
    """The API under load."""

    port: int
    process: psutil.Process
    settings: Settings


@contextmanager
def running_service(folder: Path, changes: Mapping[str, str | int]) -> Iterator[RunningService]:
    """Run a queue and `python -m service` in a folder, with default settings but for these changes."""
    port = usable_port(HOST, 0)
    with running_valkey(folder / "valkey") as redis_url:
        settings = Settings.model_validate({"data_dir": folder / "data", "redis_url": redis_url, **changes})
        named = {"DATA_DIR": settings.data_dir, "REDIS_URL": redis_url, "PORT": port}
        named |= {name.upper(): value for name, value in changes.items()}
        own = {name: value for name, value in os.environ.items() if not name.startswith("QUADPATCH_")}
        environment = own | {f"QUADPATCH_{name}": str(value) for name, value in named.items()}
        with (folder / "api.log").open("wb") as log:
            command = [sys.executable, "-m", "service"]
            process = subprocess.Popen(command, env=environment, stdout=log, stderr=subprocess.STDOUT)
        try:
            _wait_until_ready(port, process)
            yield RunningService(port, psutil.Process(process.pid), settings)
        finally:
            process.terminate()
            process.wait(30)


@contextmanager
def moving(service: RunningService, attempts: list[Attempt]) -> Iterator[None]:
    """Report progress of these attempts twice a second, as workers do."""
    database = Database(service.settings.effective_database_url)
    book, ended = Attempts(database), threading.Event()

    def report() -> None:
        step = 0
        while not ended.wait(_PROGRESS_S):
            step += 1
            for attempt in attempts:
                book.report_progress(attempt, "inpaint", step % 990 / 10)

    reporter = threading.Thread(target=report)
    reporter.start()
    try:
        yield
    finally:
        ended.set()
        reporter.join()
        database.close()


def furnish(settings: Settings, n_jobs: int) -> tuple[list[str], list[Attempt]]:
    """Write jobs: one in four has ended, a few run, the others wait; return all ids, and the attempts that run."""
    database = Database(settings.effective_database_url)
    store = open_store(settings.effective_object_store_url)
    with store.writer("meshes") as writer:
        writer.write(b"ply\n")
        stored = writer.commit()
    mesh = Meshes(database).add(stored, "scan.ply", "ply")[0]
    jobs, attempts = Jobs(database), Attempts(database)
    new = NewJob(JobSpec(mesh_id=mesh.id), ResolvedModel(requested="self", kind="self"), 3)
    ids = [jobs.create(new)[0].id for _ in range(n_jobs)]
    for job_id in ids[: n_jobs // 4]:
        attempt = attempts.start(job_id, "benchmark", 3600).attempt
        attempts.report_progress(attempt, "write", 99.0)
        attempts.publish(attempt, JobResult(format="ply", holes=HoleCounts(found=3, filled=3), seconds=8.0))
    running = ids[n_jobs // 4 : n_jobs // 4 + N_RUNNING]
    started = [attempts.start(job_id, f"benchmark-{i}", 3600).attempt for i, job_id in enumerate(running)]
    database.close()
    return ids, started


def _wait_until_ready(port: int, process: subprocess.Popen[bytes]) -> None:
    is_ready = ready_check(f"http://{HOST}:{port}/healthz")
    deadline = time.monotonic() + _START_S
    while not is_ready():
        if process.poll() is not None or time.monotonic() > deadline:
            raise SystemExit("the service does not start; its log says why")
        time.sleep(0.05)
