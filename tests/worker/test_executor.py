"""A worker process, and a queue that comes and goes.

Also tests `worker.__main__`.
"""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from jobkit.database.session import Database
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.queue import TaskQueue
from jobkit.requeue import submit_job
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from onebox.valkey import prepare_valkey, running_valkey
from quadpatch_client.schema import JobSpec, JobState, ResolvedModel
from tests.integration.conftest import ply_bytes, punched_relief
from tests.waiting import GUARD_S, end, wait_until

SMOOTH, LEARN = {"method": "smooth"}, {"method": "dictionary", "model": "self"}


@pytest.fixture
def queue_folder(tmp_path: Path) -> Path:
    return tmp_path / "own-valkey"


@pytest.fixture
def worker(settings: Settings, queue_folder: Path, tmp_path: Path) -> Iterator[subprocess.Popen[bytes]]:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("QUADPATCH_")}
    environment |= {
        "QUADPATCH_DATA_DIR": str(settings.data_dir),
        "QUADPATCH_REDIS_URL": prepare_valkey(queue_folder).url,
        "QUADPATCH_DATABASE_URL": settings.database_url.get_secret_value(),
        "QUADPATCH_OBJECT_STORE_URL": settings.object_store_url,
        "OMP_NUM_THREADS": "1",
    }
    with (tmp_path / "worker.log").open("wb") as log:
        process = subprocess.Popen([sys.executable, "-m", "worker"], env=environment, stdout=log, stderr=log)
    try:
        yield process
    finally:
        end(process)


@pytest.mark.slow
def test_a_worker_outlives_a_queue_that_goes_away_in_the_middle_of_a_task(
    worker: subprocess.Popen[bytes], queue_folder: Path, database: Database, store: ObjectStore
) -> None:
    with store.writer("meshes") as writer:
        writer.write(ply_bytes(*punched_relief(100)))
        stored = writer.commit()
    mesh = Meshes(database).add(stored, "scan.ply", "ply")[0]
    jobs = Jobs(database)

    def start(queue: TaskQueue, method: dict[str, str]) -> str:
        spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": method, "output": {"preview": False}})
        job = jobs.create(NewJob(spec, ResolvedModel(requested=method.get("model", "smooth"), kind="none"), 3))[0]
        submit_job(database, queue, job.id, 0)
        return job.id

    def state(job_id: str) -> JobState:
        return jobs.get(job_id).state

    with ExitStack() as valkey:
        queue = TaskQueue(valkey.enter_context(running_valkey(queue_folder)), "quadpatch", 60)
        first = start(queue, LEARN)
        wait_until(lambda: state(first) is JobState.RUNNING)
    wait_until(lambda: state(first).has_result)
    with running_valkey(queue_folder), closing(queue):
        second = start(queue, SMOOTH)
        wait_until(lambda: state(second).has_result)
        assert worker.poll() is None
        worker.send_signal(signal.SIGTERM)
        assert worker.wait(GUARD_S) == 0
