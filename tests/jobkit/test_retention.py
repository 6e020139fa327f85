import threading
from dataclasses import replace
from datetime import timedelta

import pytest
from sqlalchemy import func, select

from jobkit.database.clock import utc_now
from jobkit.database.idempotency import Idempotency
from jobkit.database.session import Database
from jobkit.database.tables import AttemptRow, EventRow, IdempotencyRow, JobRow
from jobkit.errors import (
    JobNotFinishedError,
    JobNotFoundError,
    MeshInUseError,
    MeshNotFoundError,
    StoreUnavailableError,
)
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.retention import BATCH, delete_job, delete_mesh, expire_jobs, expire_meshes, pin_job, pin_mesh
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import Denoising, Job, JobSpec, Mesh
from tests.jobkit.fixtures import DAY, AgingStore, KilledError, age_rows, fail, finish, keys_in, upload

KEY = Idempotency("station", "order-17", "a" * 64)


def results(store: ObjectStore) -> set[str]:
    return {key for key in keys_in(store) if key.startswith("results/")}


def count(database: Database, table: type[EventRow | AttemptRow | IdempotencyRow | JobRow]) -> int:
    with database.read() as session:
        return session.scalar(select(func.count()).select_from(table)) or 0


def test_a_deleted_job_leaves_neither_row_nor_file(database: Database, store: ObjectStore, new_job: NewJob) -> None:
    job = Jobs(database).create(new_job, KEY)[0]
    finish(database, store, job.id)
    assert len(results(store)) == 1
    delete_job(database, store, job.id)
    assert results(store) == set()
    assert [count(database, table) for table in (JobRow, EventRow, AttemptRow, IdempotencyRow)] == [0, 0, 0, 0]
    with pytest.raises(JobNotFoundError):
        delete_job(database, store, job.id)


def test_after_a_job_its_idempotency_key_is_free_again(database: Database, store: ObjectStore, new_job: NewJob) -> None:
    first = Jobs(database).create(new_job, KEY)[0]
    finish(database, store, first.id)
    delete_job(database, store, first.id)
    second, is_new = Jobs(database).create(new_job, KEY)
    assert is_new
    assert second.id != first.id


def test_a_job_that_has_not_ended_is_not_deleted(database: Database, store: ObjectStore, job: Job) -> None:
    attempts = Attempts(database)
    with pytest.raises(JobNotFinishedError, match="queued; cancel it first"):
        delete_job(database, store, job.id)
    attempt = attempts.start(job.id, "w", 60).attempt
    with pytest.raises(JobNotFinishedError, match="running; cancel it first"):
        delete_job(database, store, job.id)
    Jobs(database).request_cancel(job.id)
    with pytest.raises(JobNotFinishedError, match="canceling; cancel it first"):
        delete_job(database, store, job.id)
    attempts.acknowledge_cancel(attempt)
    delete_job(database, store, job.id)


def test_a_mesh_goes_only_after_the_jobs_that_name_it(database: Database, store: ObjectStore, new_job: NewJob) -> None:
    jobs = [Jobs(database).create(new_job)[0] for _ in range(2)]
    mesh_id = new_job.spec.mesh_id
    with pytest.raises(MeshInUseError, match=r"^2 jobs name mesh"):
        delete_mesh(database, mesh_id)
    for job in jobs:
        finish(database, store, job.id)
        delete_job(database, store, job.id)
    delete_mesh(database, mesh_id)
    with pytest.raises(MeshNotFoundError):
        delete_mesh(database, mesh_id)


def test_a_reference_is_kept_as_long_as_a_job_that_learns_from_it(
    database: Database, store: ObjectStore, new_job: NewJob
) -> None:
    reference = upload(database, store, b"clean\n")
    spec = JobSpec(mesh_id=new_job.spec.mesh_id, task="denoise", denoise=Denoising(reference=reference.id))
    job = Jobs(database).create(replace(new_job, spec=spec))[0]
    age_rows(database, 40 * DAY)
    finish(database, store, job.id)
    assert Meshes(database, 30).get(reference.id).expires_at is None
    assert expire_meshes(database, 30, utc_now() + 99 * DAY) == 0
    with pytest.raises(MeshInUseError, match=r"^1 job names mesh"):
        delete_mesh(database, reference.id)
    delete_job(database, store, job.id)
    assert expire_meshes(database, 30, utc_now() + 29 * DAY) == 0
    assert expire_meshes(database, 30, utc_now() + 31 * DAY) == 2


def test_a_job_whose_reference_is_gone_is_not_made(database: Database, store: ObjectStore, new_job: NewJob) -> None:
    reference = upload(database, store, b"clean\n")
    spec = JobSpec(mesh_id=new_job.spec.mesh_id, task="denoise", denoise=Denoising(reference=reference.id))
    delete_mesh(database, reference.id)
    with pytest.raises(MeshNotFoundError, match=reference.id):
        Jobs(database).create(replace(new_job, spec=spec))


def test_a_mesh_that_comes_back_at_once_has_its_bytes(database: Database, store: ObjectStore, mesh: Mesh) -> None:
    """The deletion leaves them to the sweep, which sees that they are young."""
    delete_mesh(database, mesh.id)
    again = upload(database, store, b"ply\n")
    assert again.id == mesh.id
    assert b"".join(store.read(Meshes(database).source(mesh.id).key)) == b"ply\n"


def test_a_mesh_is_never_deleted_from_under_a_job_that_is_being_made(
    database: Database, store: ObjectStore, new_job: NewJob
) -> None:
    """In either order: there is a job with its mesh, or neither."""
    for _ in range(10):
        mesh = upload(database, store, b"ply\n")
        made: list[Job] = []
        refused: list[MeshNotFoundError] = []

        def make(made: list[Job] = made, refused: list[MeshNotFoundError] = refused) -> None:
            try:
                made.append(Jobs(database).create(new_job)[0])
            except MeshNotFoundError as error:
                refused.append(error)

        thread = threading.Thread(target=make)
        thread.start()
        try:
            delete_mesh(database, mesh.id)
        except MeshInUseError:
            thread.join()
            assert made
        else:
            thread.join()
            assert refused
        for job in made:
            assert Meshes(database).get(job.mesh_id).id == mesh.id
            finish(database, store, job.id)
            delete_job(database, store, job.id)


def test_finished_jobs_expire_and_others_never(database: Database, store: ObjectStore, new_job: NewJob) -> None:
    jobs = Jobs(database)
    old, failed, pinned, waiting = (jobs.create(new_job)[0].id for _ in range(4))
    finish(database, store, old)
    fail(database, store, failed)
    finish(database, store, pinned)
    pin_job(database, pinned, True)
    assert expire_jobs(database, store, 30, utc_now() + 29 * DAY) == 0
    assert expire_jobs(database, store, 0, utc_now() + 9999 * DAY) == 0
    assert expire_jobs(database, store, 30, utc_now() + 31 * DAY) == 2
    assert {job.id for job in jobs.page(10).items} == {pinned, waiting}
    assert results(store) == {f"results/{pinned}/1/repaired.ply"}
    pin_job(database, pinned, False)
    assert expire_jobs(database, store, 30, utc_now() + 31 * DAY) == 1


def test_many_jobs_expire_in_batches_and_break_off_when_told(
    database: Database, store: ObjectStore, new_job: NewJob
) -> None:
    jobs = Jobs(database)
    for _ in range(BATCH + 3):
        jobs.request_cancel(jobs.create(new_job)[0].id)
    later = utc_now() + 2 * DAY
    assert expire_jobs(database, store, 1, later, lambda: True) == 0
    answers = iter([False, True])
    assert expire_jobs(database, store, 1, later, lambda: next(answers)) == BATCH
    assert expire_jobs(database, store, 1, later) == 3
    assert count(database, EventRow) == 0


def test_clients_are_told_what_expires_when(database: Database, store: ObjectStore, new_job: NewJob) -> None:
    jobs, meshes = Jobs(database, 30), Meshes(database, 7)
    job, mesh_id = jobs.create(new_job)[0], new_job.spec.mesh_id
    assert (job.expires_at, meshes.get(mesh_id).expires_at) == (None, None)
    finished = finish(database, store, job.id)
    assert finished.finished_at is not None
    assert jobs.get(job.id).expires_at == finished.finished_at + 30 * DAY
    assert meshes.get(mesh_id).expires_at is None
    pin_job(database, job.id, True)
    assert (jobs.get(job.id).pinned, jobs.get(job.id).expires_at) == (True, None)
    delete_job(database, store, job.id)
    assert meshes.get(mesh_id).expires_at == finished.finished_at + 7 * DAY
    pin_mesh(database, mesh_id, True)
    assert (meshes.get(mesh_id).pinned, meshes.get(mesh_id).expires_at) == (True, None)


def test_a_mesh_is_kept_from_the_end_of_the_last_job_on_it(
    database: Database, store: ObjectStore, new_job: NewJob
) -> None:
    job = Jobs(database).create(new_job)[0]
    age_rows(database, 40 * DAY)
    finish(database, store, job.id)
    assert expire_meshes(database, 30, utc_now() + 99 * DAY) == 0
    delete_job(database, store, job.id)
    assert expire_meshes(database, 30, utc_now() + 29 * DAY) == 0
    assert expire_meshes(database, 30, utc_now() + 31 * DAY) == 1


def test_another_upload_of_the_same_bytes_starts_the_time_again(database: Database, store: ObjectStore) -> None:
    mesh = upload(database, store, b"again")
    age_rows(database, 29 * DAY)
    assert upload(database, store, b"again").id == mesh.id
    assert expire_meshes(database, 30, utc_now() + 2 * DAY) == 0
    age_rows(database, 29 * DAY)
    assert expire_meshes(database, 30, utc_now() + 2 * DAY) == 1


def test_a_pinned_mesh_never_expires_and_none_does_without_a_limit(database: Database, mesh: Mesh) -> None:
    later = utc_now() + 9999 * DAY
    assert expire_meshes(database, 0, later) == 0
    pin_mesh(database, mesh.id, True)
    assert expire_meshes(database, 30, later) == 0
    pin_mesh(database, mesh.id, False)
    assert expire_meshes(database, 30, later, lambda: True) == 0
    assert expire_meshes(database, 30, later) == 1


def test_nothing_can_be_pinned_that_is_not_there(database: Database) -> None:
    with pytest.raises(JobNotFoundError):
        pin_job(database, "job_none", True)
    with pytest.raises(MeshNotFoundError):
        pin_mesh(database, "0" * 64, True)


@pytest.mark.parametrize("kills_after", [False, True])
@pytest.mark.parametrize("is_asked_for", [False, True])
def test_a_process_killed_between_row_and_files_leaves_no_row_behind(
    database: Database, store: ObjectStore, new_job: NewJob, is_asked_for: bool, kills_after: bool
) -> None:
    job = Jobs(database).create(new_job)[0]
    finish(database, store, job.id)
    killing = AgingStore(store)
    killing.kill_countdown, killing.kills_after = 0, kills_after

    def remove() -> None:
        if is_asked_for:
            delete_job(database, killing, job.id)
        else:
            expire_jobs(database, killing, 1, utc_now() + timedelta(days=2))

    with pytest.raises(KilledError):
        remove()
    with pytest.raises(JobNotFoundError):
        Jobs(database).get(job.id)


def test_a_store_that_is_away_keeps_no_job_from_being_deleted(
    database: Database, store: ObjectStore, new_job: NewJob
) -> None:
    class AwayStore(AgingStore):
        def delete_prefix(self, prefix: str) -> None:
            raise StoreUnavailableError("away")

    job = Jobs(database).create(new_job)[0]
    finish(database, store, job.id)
    delete_job(database, AwayStore(store), job.id)
    with pytest.raises(JobNotFoundError):
        Jobs(database).get(job.id)
    assert len(results(store)) == 1
