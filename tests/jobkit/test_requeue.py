from collections.abc import Iterator
from datetime import timedelta

import pytest
from redis import Redis
from rq import Queue
from rq.serializers import JSONSerializer
from sqlalchemy import update

from jobkit.access.tenants import Tenants
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow
from jobkit.errors import QueueUnavailableError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.timeouts import TimeLimits
from jobkit.meshes import MAX_ANALYSES, Meshes
from jobkit.queue import INSPECT_MESH, RUN_JOB, TaskQueue, job_entry, mesh_entry
from jobkit.requeue import GRACE_S, reconcile, submit_analysis, submit_job
from jobkit.settings import Settings
from quadpatch_client.schema import Job, JobState, Mesh, MeshState, TenantChanges

LIMITS = TimeLimits(queue_s=1e6, total_s=1e6, memory_mb=1000)


@pytest.fixture
def queue(settings: Settings) -> Iterator[TaskQueue]:
    queue = TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)
    yield queue
    queue.close()


@pytest.fixture
def rq_queue(queue: TaskQueue, settings: Settings) -> Queue:
    return Queue(settings.queue_name, connection=queue.connection, serializer=JSONSerializer)


def test_a_submitted_job_waits_under_the_dotted_path_of_its_task(
    database: Database, queue: TaskQueue, rq_queue: Queue, job: Job
) -> None:
    submit_job(database, queue, job.id, job.attempt)
    (waiting,) = rq_queue.get_jobs()
    assert (waiting.func_name, list(waiting.args), waiting.id) == (RUN_JOB, [job.id], job_entry(job.id, 1))
    assert waiting.timeout == 120


def test_an_analysis_waits_its_turn_behind_older_jobs(
    database: Database, queue: TaskQueue, rq_queue: Queue, job: Job, mesh: Mesh
) -> None:
    submit_job(database, queue, job.id, job.attempt)
    submit_analysis(database, queue, mesh.id)
    assert [waiting.func_name for waiting in rq_queue.get_jobs()] == [RUN_JOB, INSPECT_MESH]


def test_a_queue_that_lost_everything_is_filled_again(
    database: Database, queue: TaskQueue, rq_queue: Queue, job: Job, mesh: Mesh
) -> None:
    submit_job(database, queue, job.id, job.attempt)
    submit_analysis(database, queue, mesh.id)
    rq_queue.empty()
    found = reconcile(database, queue, LIMITS, utc_now() + timedelta(seconds=GRACE_S + 1))
    assert (found.enqueued_jobs, found.enqueued_meshes) == (1, 1)
    assert queue.entries() == {job_entry(job.id, 1), mesh_entry(mesh.id, 1)}


def test_what_waits_in_the_queue_is_not_put_there_twice(
    database: Database, queue: TaskQueue, rq_queue: Queue, job: Job, mesh: Mesh
) -> None:
    reconcile(database, queue, LIMITS)
    for _ in range(2):
        found = reconcile(database, queue, LIMITS, utc_now() + timedelta(seconds=GRACE_S + 1))
        assert (found.enqueued_jobs, found.enqueued_meshes) == (0, 0)
    assert len(rq_queue) == 2


def test_what_was_just_taken_out_is_left_alone_for_a_moment(
    database: Database, queue: TaskQueue, rq_queue: Queue, job: Job
) -> None:
    submit_job(database, queue, job.id, job.attempt)
    rq_queue.empty()
    assert reconcile(database, queue, LIMITS).enqueued_jobs == 0


def test_an_attempt_whose_worker_went_silent_is_started_again(database: Database, queue: TaskQueue, job: Job) -> None:
    attempts = Attempts(database)
    attempts.start(job.id, "w", 5)
    found = reconcile(database, queue, LIMITS, utc_now() + timedelta(seconds=6))
    assert (found.ended, found.enqueued_jobs) == (1, 1)
    assert job_entry(job.id, 2) in queue.entries()
    assert attempts.start(job.id, "w", 5).attempt.number == 2


def test_of_jobs_that_wait_for_memory_one_at_a_time_goes_to_the_front(
    database: Database, queue: TaskQueue, rq_queue: Queue, new_job: NewJob
) -> None:
    jobs = [Jobs(database).create(new_job)[0] for _ in range(4)]
    other, early, late, tried = (job.id for job in jobs)
    submit_job(database, queue, other, 0)
    now = utc_now()
    with database.write() as session:
        for job_id, since_s, pause_s in ((early, 60, 0), (late, 30, 0), (tried, 90, 1)):
            times = {
                "memory_wait_since": now - timedelta(seconds=since_s),
                "not_before": now + timedelta(seconds=pause_s),
            }
            session.execute(update(JobRow).where(JobRow.id == job_id).values(times))
    assert reconcile(database, queue, LIMITS, now).enqueued_jobs == 1
    assert rq_queue.get_job_ids()[:2] == [job_entry(early, 1), job_entry(other, 1)]
    assert reconcile(database, queue, LIMITS, now).enqueued_jobs == 0
    rq_queue.remove(job_entry(early, 1))
    assert reconcile(database, queue, LIMITS, now + timedelta(seconds=2)).enqueued_jobs == 1
    assert rq_queue.get_job_ids()[:2] == [job_entry(tried, 1), job_entry(other, 1)]


def test_the_row_stays_queued_when_the_queue_is_away(database: Database, job: Job) -> None:
    away = TaskQueue("redis://127.0.0.1:1/0", "none", 60)
    for call in (lambda: submit_job(database, away, job.id, 0), lambda: reconcile(database, away, LIMITS), away.ping):
        with pytest.raises(QueueUnavailableError):
            call()
    assert Jobs(database).get(job.id).state == JobState.QUEUED
    away.close()


def test_a_finished_or_canceled_job_never_comes_back(
    database: Database, queue: TaskQueue, job: Job, mesh: Mesh
) -> None:
    Jobs(database).request_cancel(job.id)
    later = utc_now() + timedelta(seconds=GRACE_S + 1)
    assert reconcile(database, queue, LIMITS, later).enqueued_jobs == 0


def test_an_analysis_that_kills_its_worker_is_given_up(database: Database, queue: TaskQueue, mesh: Mesh) -> None:
    """A file on which the reader crashes must not take down one worker after the other for ever."""
    meshes = Meshes(database)
    now = utc_now()
    for number in range(1, MAX_ANALYSES + 1):
        analysis = meshes.start_analysis(mesh.id, "w", -1.0)
        assert analysis.attempt == number
    reconcile(database, queue, LIMITS, now + timedelta(seconds=5))
    rejected = meshes.get(mesh.id)
    assert rejected.state == MeshState.REJECTED
    assert rejected.problem is not None
    assert rejected.problem.code == "analysis_failed"


def test_an_analysis_that_met_an_outage_comes_back_after_a_while_and_is_not_counted(
    database: Database, queue: TaskQueue, mesh: Mesh
) -> None:
    meshes = Meshes(database)
    for _ in range(MAX_ANALYSES + 2):
        analysis = meshes.start_analysis(mesh.id, "w", 30.0)
        assert not analysis.is_last
        meshes.forgive(analysis, 0.0)
    meshes.forgive(meshes.start_analysis(mesh.id, "w", 30.0), 60.0)
    now = utc_now()
    assert reconcile(database, queue, LIMITS, now).enqueued_meshes == 0
    assert reconcile(database, queue, LIMITS, now + timedelta(seconds=61)).enqueued_meshes == 1
    assert meshes.get(mesh.id).state == MeshState.ANALYSING


def test_the_password_of_the_queue_stands_in_no_error(settings: Settings) -> None:
    away = TaskQueue("redis://:s3cret@127.0.0.1:1/0", "none", 60)
    with pytest.raises(QueueUnavailableError) as caught:
        away.ping()
    assert "s3cret" not in str(caught.value)
    away.close()


def test_the_connection_is_the_one_of_the_settings(queue: TaskQueue) -> None:
    assert isinstance(queue.connection, Redis)
    queue.ping()


def test_only_so_many_jobs_of_a_tenant_come_back_as_may_run(
    database: Database, queue: TaskQueue, rq_queue: Queue, new_job: NewJob
) -> None:
    jobs = [Jobs(database).create(new_job)[0].id for _ in range(6)]
    Tenants(database).change("default", TenantChanges(jobs_at_once=3))
    for job_id in jobs[:2]:
        Attempts(database).start(job_id, "w", 600)
    reconcile(database, queue, LIMITS)
    assert [job.id for job in rq_queue.get_jobs() if job.func_name == RUN_JOB] == [job_entry(jobs[2], 1)]
    # Nor does it get another one while that waits for a worker.
    reconcile(database, queue, LIMITS, utc_now() + timedelta(seconds=2 * GRACE_S), takes_leases=False)
    assert [job.id for job in rq_queue.get_jobs() if job.func_name == RUN_JOB] == [job_entry(jobs[2], 1)]
