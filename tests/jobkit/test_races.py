"""Many threads at one row: what must happen once happens once, on either database."""

import threading
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from typing import Any

import pytest
from sqlalchemy import select, update

from jobkit.database.clock import utc_now
from jobkit.database.idempotency import Idempotency
from jobkit.database.leadership import Leadership
from jobkit.database.session import Database
from jobkit.database.tables import AttemptRow, JobRow, LeaderRow
from jobkit.errors import JobFinishedError, StaleAttemptError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.endings import Attempt, end_attempt, retry_ending
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.timeouts import TimeLimits, end_overdue
from jobkit.meshes import Meshes
from jobkit.models.registry import Registry
from jobkit.storage.base import ObjectStore, StoredObject
from quadpatch_client.schema import Job, JobError, JobResult, JobState, Mesh
from tests.waiting import GUARD_S, let_others_run

LIMITS = TimeLimits(queue_s=1e6, total_s=1e6, memory_mb=1000)
ERROR = JobError(code="worker_lost", message="it fell silent", retryable=True)


@pytest.fixture
def database(any_database: Database) -> Database:
    return any_database


def at_once(calls: list[Callable[[], Any]]) -> list[Any]:
    """Make all calls in the same moment; gives what they return, or the error where a call lost its race."""
    barrier = threading.Barrier(len(calls))

    def run(call: Callable[[], Any]) -> Any:
        barrier.wait(GUARD_S)
        try:
            return call()
        except (StaleAttemptError, JobFinishedError) as error:
            return error

    with ThreadPoolExecutor(len(calls)) as pool:
        return list(pool.map(run, calls))


def assert_log_is_whole(database: Database, job_id: str) -> None:
    """No event is missing, none is there twice, and the last one is the job's revision."""
    events = Jobs(database).events(job_id, limit=1_000).items
    with database.read() as session:
        revision = session.scalars(select(JobRow.revision).where(JobRow.id == job_id)).one()
    assert [event.sequence for event in events] == list(range(1, revision + 1))


def test_a_job_is_started_by_one_of_many_workers(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    answers = at_once([lambda i=i: attempts.start(job.id, f"w{i}", 30) for i in range(8)])  # type: ignore[misc]
    assert sum(not isinstance(answer, StaleAttemptError) for answer in answers) == 1
    assert Jobs(database).get(job.id).attempt == 1
    assert_log_is_whole(database, job.id)


def test_the_first_jobs_of_a_tenant_may_start_at_once(database: Database, new_job: NewJob) -> None:
    ids = [Jobs(database).create(new_job)[0].id for _ in range(6)]
    started = at_once([lambda i=i: Attempts(database).start(ids[i], f"w{i}", 60) for i in range(6)])  # type: ignore[misc]
    assert [attempt.attempt.job_id for attempt in started] == ids


def test_a_job_ends_in_one_way_under_competing_endings(database: Database, new_job: NewJob) -> None:
    jobs, attempts = Jobs(database), Attempts(database)
    endings = Counter[str]()
    for _ in range(12):
        job = jobs.create(new_job)[0]
        mine = attempts.start(job.id, "w", 30).attempt
        later = utc_now() + timedelta(seconds=60)
        answers = at_once(
            [
                lambda: attempts.publish(mine, JobResult(format="ply")),  # noqa: B023 - called within the loop
                lambda: attempts.fail(mine, ERROR),  # noqa: B023
                lambda: attempts.requeue(mine, ERROR),  # noqa: B023
                lambda: end_overdue(database, LIMITS, later),  # noqa: B023
                lambda: end_overdue(database, LIMITS, later),  # noqa: B023
            ]
        )
        ended = [a for a in answers if isinstance(a, JobState) or a == 1]
        assert len(ended) == 1, answers
        state = jobs.get(job.id).state
        assert state == (ended[0] if isinstance(ended[0], JobState) else JobState.QUEUED)
        endings[state] += 1
        with database.read() as session:
            outcomes = session.scalars(select(AttemptRow.outcome).where(AttemptRow.job_id == job.id)).all()
        assert len(outcomes) == 1
        assert outcomes[0] is not None
        assert_log_is_whole(database, job.id)
        if state == JobState.QUEUED:
            jobs.request_cancel(job.id)
    assert sum(endings.values()) == 12


def test_a_cancel_reaches_a_job_that_goes_back_to_the_queue_and_out_again(database: Database, new_job: NewJob) -> None:
    jobs, attempts = Jobs(database), Attempts(database)
    for _ in range(3):
        job = jobs.create(new_job)[0]

        def shuttle(job_id: str = job.id) -> None:
            for _ in range(20):
                attempts.hand_back(attempts.start(job_id, "w", 30).attempt, ERROR)

        _, answer = at_once([shuttle, lambda: jobs.request_cancel(job.id)])  # noqa: B023
        assert isinstance(answer, Job), answer
        left = jobs.get(job.id)
        if left.state == JobState.CANCELING:
            attempts.acknowledge_cancel(Attempt(job.id, left.attempt))
        assert jobs.get(job.id).state == JobState.CANCELED
        assert_log_is_whole(database, job.id)


def test_a_cancel_reaches_a_job_that_is_just_being_handed_back(database: Database, job: Job) -> None:
    mine = Attempts(database).start(job.id, "w", 30).attempt
    with ThreadPoolExecutor(1) as pool:
        with database.write() as session:
            end_attempt(session, mine, retry_ending(ERROR), utc_now())
            # The other one still finds a running job, and then waits for this transaction.
            canceled = pool.submit(Jobs(database).request_cancel, job.id)
            let_others_run()
            assert not canceled.done()
        assert canceled.result(GUARD_S).state == JobState.CANCELED
    assert_log_is_whole(database, job.id)


def test_a_lease_that_is_renewed_while_it_is_taken_for_lost_stays(database: Database, job: Job) -> None:
    Attempts(database).start(job.id, "w", 30)
    later = utc_now() + timedelta(seconds=60)
    with ThreadPoolExecutor(1) as pool:
        with database.write() as session:
            session.execute(update(JobRow).values(lease_until=later + timedelta(seconds=30)))
            # The other one finds the old lease, and then waits for this transaction.
            taken = pool.submit(end_overdue, database, LIMITS, later)
            let_others_run()
            assert not taken.done()
        assert taken.result(GUARD_S) == 0
    assert Jobs(database).get(job.id).state == JobState.RUNNING


def test_progress_from_many_sides_is_logged_without_a_gap(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    mine = attempts.start(job.id, "w", 30).attempt

    def report(stage: str) -> None:
        for percent in range(20):
            attempts.report_progress(mine, stage, float(percent))
            attempts.heartbeat(mine, 30, memory_mb=percent)

    at_once([lambda i=i: report(f"stage-{i}") for i in range(4)])  # type: ignore[misc]
    assert_log_is_whole(database, job.id)
    assert len(Jobs(database).events(job.id, limit=1_000).items) == 82


def test_a_request_that_comes_many_times_at_once_makes_one_job(database: Database, new_job: NewJob) -> None:
    jobs, key = Jobs(database), Idempotency("somebody", "order-17", "0" * 64)
    answers = at_once([lambda: jobs.create(new_job, key) for _ in range(8)])
    assert len({job.id for job, _ in answers}) == 1
    assert sum(is_new for _, is_new in answers) == 1
    assert len(jobs.page(10).items) == 1


def test_one_of_many_candidates_leads(database: Database) -> None:
    candidates = [Leadership(database, "dispatcher", f"d{i}", 30) for i in range(8)]
    for _ in range(5):
        leads = at_once([candidate.lead for candidate in candidates])
        assert sum(leads) == 1
        assert at_once([candidate.lead for candidate in candidates]) == leads
        with database.write() as session:
            session.execute(update(LeaderRow).values(until=utc_now() - timedelta(seconds=1)))
        # The leader may renew even then, unless another one was first.
        assert sum(at_once([candidate.lead for candidate in candidates])) == 1
        candidates[0].resign()


def test_one_of_many_candidates_follows_a_leader_that_fell_silent(database: Database) -> None:
    assert Leadership(database, "dispatcher", "gone", -1).lead()
    candidates = [Leadership(database, "dispatcher", f"d{i}", 30) for i in range(8)]
    assert sum(at_once([candidate.lead for candidate in candidates])) == 1


def test_an_upload_that_arrives_many_times_at_once_is_one_mesh_and_analysed_once(database: Database) -> None:
    meshes, stored = Meshes(database), StoredObject("meshes/aa/aa", 5, "a" * 64)
    answers = at_once([lambda: meshes.add(stored, "scan.ply", "ply") for _ in range(8)])
    assert sum(is_new for _, is_new in answers) == 1
    started = at_once([lambda: meshes.start_analysis("a" * 64, "w", 30) for _ in range(8)])
    assert sum(not isinstance(answer, StaleAttemptError) for answer in started) == 1


def test_versions_of_a_model_that_are_published_at_once_get_numbers_of_their_own(
    database: Database, store: ObjectStore, dictionary_bytes: Callable[[int], bytes]
) -> None:
    registry = Registry(database, store)

    def publish(seed: int) -> int:
        with store.writer("models") as writer:
            writer.write(dictionary_bytes(seed))
            return registry.publish("parts", writer.commit())[0].version

    files = [dictionary_bytes(seed) for seed in range(6)]
    assert len(set(files)) == 6
    assert sorted(at_once([lambda i=i: publish(i) for i in range(6)])) == [1, 2, 3, 4, 5, 6]  # type: ignore[misc]


def test_a_mesh_and_its_job_are_read_as_of_one_moment(database: Database, mesh: Mesh, job: Job) -> None:
    with database.read() as session:
        before = session.scalars(select(JobRow.state).where(JobRow.id == job.id)).one()
        Attempts(database).start(job.id, "w", 30)
        assert session.scalars(select(JobRow.state).where(JobRow.id == job.id)).one() == before
    assert Jobs(database).get(job.id).state == JobState.RUNNING
