from datetime import timedelta

import pytest

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.errors import StaleAttemptError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.timeouts import CANCEL_TIMEOUT_S, TimeLimits, end_overdue
from quadpatch_client.schema import Job, JobResult, JobState, Limits

LIMITS = TimeLimits(queue_s=1e6, total_s=1e6, memory_mb=1000)


def end_later(database: Database, seconds: float, limits: TimeLimits = LIMITS) -> int:
    return end_overdue(database, limits, utc_now() + timedelta(seconds=seconds))


def lose(database: Database, job: Job, memory_mb: int = 0) -> None:
    attempts = Attempts(database)
    attempts.heartbeat(attempts.start(job.id, "w", 30).attempt, 30, memory_mb)
    assert end_later(database, 40) == 1


def test_an_expired_lease_goes_back_and_a_renewed_one_stays(database: Database, job: Job, new_job: NewJob) -> None:
    attempts = Attempts(database)
    other = Jobs(database).create(new_job)[0]
    lost = attempts.start(job.id, "w1", 30).attempt
    kept = attempts.start(other.id, "w2", 30).attempt
    attempts.heartbeat(kept, 60)
    assert end_later(database, 40) == 1
    assert Jobs(database).get(job.id).state == JobState.QUEUED
    assert Jobs(database).get(other.id).state == JobState.RUNNING
    with pytest.raises(StaleAttemptError):
        attempts.heartbeat(lost, 30)


def test_a_job_that_silences_every_worker_is_given_up(database: Database, job: Job) -> None:
    for _ in range(job.max_attempts):
        lose(database, job)
    ended = Jobs(database).get(job.id)
    assert ended.state == JobState.FAILED
    assert ended.error is not None
    assert (ended.error.code, ended.error.retryable) == ("worker_lost", False)


@pytest.mark.parametrize(("memory_mb", "code"), [(950, "out_of_memory"), (500, "worker_lost")])
def test_a_worker_that_fell_silent_close_to_the_memory_limit_ran_out_of_memory(
    database: Database, job: Job, memory_mb: int, code: str
) -> None:
    for _ in range(job.max_attempts):
        lose(database, job, memory_mb)
    error = Jobs(database).get(job.id).error
    assert error is not None
    assert error.code == code


def test_the_memory_limit_of_the_job_itself_counts(database: Database, new_job: NewJob) -> None:
    spec = new_job.spec.model_copy(update={"limits": Limits(memory_mb=512)})
    job = Jobs(database).create(NewJob(spec, new_job.model, max_attempts=1))[0]
    lose(database, job, 500)
    error = Jobs(database).get(job.id).error
    assert error is not None
    assert (error.code, "of 512 MiB" in error.message) == ("out_of_memory", True)


def test_the_peak_of_memory_is_kept_when_it_falls_again(database: Database, new_job: NewJob) -> None:
    job = Jobs(database).create(NewJob(new_job.spec, new_job.model, max_attempts=1))[0]
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    for memory_mb in (100, 990, 300):
        attempts.heartbeat(attempt, 30, memory_mb)
    assert end_later(database, 40) == 1
    error = Jobs(database).get(job.id).error
    assert error is not None
    assert "990 of 1000 MiB" in error.message


def test_a_cancel_waits_for_a_living_worker_and_for_a_dead_one_a_moment_only(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    Jobs(database).request_cancel(job.id)
    assert end_later(database, 0) == 0
    assert Jobs(database).get(job.id).state == JobState.CANCELING
    assert end_later(database, CANCEL_TIMEOUT_S + 0.5) == 1
    assert Jobs(database).get(job.id).state == JobState.CANCELED
    with pytest.raises(StaleAttemptError):
        attempts.publish(attempt, JobResult(format="ply"))


def test_a_job_that_no_worker_takes_is_given_up(database: Database, job: Job) -> None:
    limits = TimeLimits(queue_s=60, total_s=1e6, memory_mb=1000)
    assert end_later(database, 50, limits) == 0
    assert end_later(database, 70, limits) == 1
    error = Jobs(database).get(job.id).error
    assert error is not None
    assert (error.code, error.retryable) == ("queue_time_exceeded", True)


def test_going_back_to_the_queue_starts_the_wait_anew(database: Database, job: Job) -> None:
    limits = TimeLimits(queue_s=35, total_s=1e6, memory_mb=1000)
    lose(database, job)
    assert end_later(database, 30, limits) == 0
    assert Jobs(database).get(job.id).state == JobState.QUEUED


@pytest.mark.parametrize("starts", [False, True])
def test_a_job_has_to_end_within_its_total_time_whether_it_waits_or_runs(
    database: Database, job: Job, starts: bool
) -> None:
    if starts:
        Attempts(database).start(job.id, "w", 1e6)
    limits = TimeLimits(queue_s=1e6, total_s=60, memory_mb=1000)
    assert end_later(database, 50, limits) == 0
    assert end_later(database, 70, limits) == 1
    ended = Jobs(database).get(job.id)
    assert ended.error is not None
    assert (ended.state, ended.error.code) == (JobState.FAILED, "total_time_exceeded")


def test_what_has_ended_is_left_alone(database: Database, job: Job) -> None:
    Jobs(database).request_cancel(job.id)
    before = Jobs(database).get(job.id)
    assert end_later(database, 1e7, TimeLimits(1, 1, 1000)) == 0
    assert Jobs(database).get(job.id) == before
