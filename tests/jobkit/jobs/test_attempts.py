"""Also tests `jobkit.jobs.events`."""

import contextlib
import functools
import itertools
import threading
from collections.abc import Callable
from datetime import timedelta

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sqlalchemy import update

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow
from jobkit.errors import JobFinishedError, JobNotFoundError, StaleAttemptError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.endings import Attempt
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.timeouts import TimeLimits, end_overdue
from jobkit.version import VERSION
from quadpatch_client.schema import TRANSITIONS, Job, JobError, JobResult, JobState

LOST = JobError(code="engine_crashed", message="the engine died", stage="fill", retryable=True)
RESULT = JobResult(format="ply")
MADE = RESULT.model_copy(update={"version": VERSION})
LIMITS = TimeLimits(queue_s=1e6, total_s=1e6, memory_mb=1000)


def test_starting_raises_the_attempt_and_leases_the_job(database: Database, job: Job) -> None:
    started = Attempts(database).start(job.id, "worker-1", 30)
    assert started.attempt == Attempt(job.id, 1)
    assert started.job.state == JobState.RUNNING
    assert started.job.started_at is not None


def test_a_job_that_is_not_there_cannot_be_started(database: Database) -> None:
    with pytest.raises(JobNotFoundError):
        Attempts(database).start("job_none", "worker-1", 30)


def test_of_many_workers_that_take_one_job_exactly_one_gets_it(database: Database, job: Job) -> None:
    outcomes: list[str] = []

    def take(worker: str) -> None:
        try:
            Attempts(database).start(job.id, worker, 30)
            outcomes.append("started")
        except StaleAttemptError:
            outcomes.append("stale")

    threads = [threading.Thread(target=take, args=(f"worker-{i}",)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(outcomes) == ["stale"] * 7 + ["started"]
    assert Jobs(database).get(job.id).attempt == 1


def test_publishing_ends_the_job_with_its_result(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    attempts.report_progress(attempt, "inpaint", 62.5)
    assert Jobs(database).get(job.id).stage == "inpaint"
    assert attempts.publish(attempt, RESULT) == JobState.SUCCEEDED
    ended = Jobs(database).get(job.id)
    assert (ended.state, ended.percent, ended.stage, ended.result) == (JobState.SUCCEEDED, 100.0, None, MADE)
    assert ended.finished_at is not None


def test_warnings_show_in_the_state(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    state = attempts.publish(attempt, JobResult(format="ply", warnings=["unit unknown"]))
    assert state == JobState.SUCCEEDED_WITH_WARNINGS == Jobs(database).get(job.id).state


def test_a_late_twin_can_write_nothing(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    late = attempts.start(job.id, "w1", 30).attempt
    assert attempts.requeue(late, LOST) == JobState.QUEUED
    fresh = attempts.start(job.id, "w2", 30).attempt
    assert fresh.number == 2
    for write in (
        lambda: attempts.publish(late, RESULT),
        lambda: attempts.fail(late, LOST),
        lambda: attempts.requeue(late, LOST),
        lambda: attempts.heartbeat(late, 30),
        lambda: attempts.report_progress(late, "fill", 10.0),
        lambda: attempts.acknowledge_cancel(late),
    ):
        before = Jobs(database).get(job.id)
        with pytest.raises(StaleAttemptError):
            write()
        assert Jobs(database).get(job.id) == before
    assert attempts.publish(fresh, RESULT) == JobState.SUCCEEDED


def test_publishing_twice_is_refused(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    attempts.publish(attempt, RESULT)
    with pytest.raises(StaleAttemptError):
        attempts.publish(attempt, RESULT)


def test_the_last_attempt_that_is_lost_fails_the_job(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    for expected in (JobState.QUEUED, JobState.FAILED):
        attempt = attempts.start(job.id, "w", 30).attempt
        assert attempts.requeue(attempt, LOST) == expected
    ended = Jobs(database).get(job.id)
    assert ended.error == LOST
    assert ended.attempt == ended.max_attempts == 2


def test_a_heartbeat_brings_the_cancel_flag(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    assert attempts.heartbeat(attempt, 30) is False
    Jobs(database).request_cancel(job.id)
    assert attempts.heartbeat(attempt, 30) is True
    attempts.acknowledge_cancel(attempt)
    assert Jobs(database).get(job.id).state == JobState.CANCELED


@pytest.mark.parametrize("ending", ["publish", "fail", "requeue"])
def test_whatever_ends_an_attempt_after_a_cancel_ends_in_canceled(database: Database, job: Job, ending: str) -> None:
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    Jobs(database).request_cancel(job.id)
    state = attempts.publish(attempt, RESULT) if ending == "publish" else getattr(attempts, ending)(attempt, LOST)
    ended = Jobs(database).get(job.id)
    assert state == ended.state == JobState.CANCELED
    assert ended.result is None


def test_an_attempt_that_is_handed_back_does_not_count(database: Database, job: Job) -> None:
    """Stopped workers and outages may come as often as they like; the job's own attempts are not used up."""
    attempts = Attempts(database)
    for number in range(1, 6):
        started = attempts.start(job.id, "w", 30)
        assert started.attempt.number == number
        assert attempts.hand_back(started.attempt, LOST) == JobState.QUEUED
    assert attempts.requeue(attempts.start(job.id, "w", 30).attempt, LOST) == JobState.QUEUED
    assert attempts.requeue(attempts.start(job.id, "w", 30).attempt, LOST) == JobState.FAILED


def test_a_cancel_is_read_by_the_latest_attempt_alone(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    first = attempts.start(job.id, "w", 30).attempt
    assert not attempts.is_canceling(first)
    attempts.requeue(first, LOST)
    second = attempts.start(job.id, "w", 30).attempt
    with pytest.raises(StaleAttemptError):
        attempts.is_canceling(first)
    Jobs(database).request_cancel(job.id)
    assert attempts.is_canceling(second)
    assert attempts.heartbeat(second, 30)
    attempts.acknowledge_cancel(second)
    with pytest.raises(StaleAttemptError):
        attempts.is_canceling(second)


def test_a_job_that_waits_out_an_outage_is_not_started_before_its_time(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempts.hand_back(attempts.start(job.id, "w", 30).attempt, LOST, delay_s=3600)
    with pytest.raises(StaleAttemptError, match="now"):
        attempts.start(job.id, "w", 30)
    with database.write() as session:
        session.execute(update(JobRow).values(not_before=utc_now() - timedelta(seconds=1)))
    assert attempts.start(job.id, "w", 30).attempt.number == 2


@settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(endings=st.lists(st.sampled_from(["hand_back", "requeue"]), max_size=10))
def test_attempts_that_count_are_never_more_than_allowed(
    database: Database, new_job: NewJob, endings: list[str]
) -> None:
    attempts, jobs = Attempts(database), Jobs(database)
    job = jobs.create(new_job)[0]
    counted = 0
    for ending in endings:
        attempt = attempts.start(job.id, "w", 30).attempt
        state = getattr(attempts, ending)(attempt, LOST)
        counted += ending == "requeue"
        assert state == (JobState.FAILED if counted == job.max_attempts else JobState.QUEUED)
        if state.is_terminal:
            break


STEPS = st.lists(
    st.sampled_from(["start", "progress", "publish", "fail", "requeue", "hand_back", "cancel", "expire"]), max_size=14
)


@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(steps=STEPS)
def test_no_order_of_calls_leaves_the_drawn_life_of_a_job(
    database: Database, new_job: NewJob, steps: list[str]
) -> None:
    """Events count up from 1 without a gap, and every change of state is one that design allows."""
    attempts, jobs = Attempts(database), Jobs(database)
    job_id = jobs.create(new_job)[0].id
    states = [JobState.QUEUED]
    for step in steps:
        attempt = Attempt(job_id, jobs.get(job_id).attempt)
        calls: dict[str, Callable[[], object]] = {
            "start": lambda: attempts.start(job_id, "w", 30),
            "progress": functools.partial(attempts.report_progress, attempt, "fill", 5.0),
            "publish": functools.partial(attempts.publish, attempt, RESULT),
            "fail": functools.partial(attempts.fail, attempt, LOST),
            "requeue": functools.partial(attempts.requeue, attempt, LOST),
            "cancel": lambda: jobs.request_cancel(job_id),
            "hand_back": functools.partial(attempts.hand_back, attempt, LOST),
            "expire": lambda: end_overdue(database, LIMITS, utc_now() + timedelta(seconds=60)),
        }
        with contextlib.suppress(StaleAttemptError, JobFinishedError):
            calls[step]()
        states.append(jobs.get(job_id).state)
    assert all(new == old or new in TRANSITIONS[old] for old, new in itertools.pairwise(states))
    events = jobs.events(job_id).items
    assert [event.sequence for event in events] == list(range(1, jobs.get(job_id).revision + 1))
