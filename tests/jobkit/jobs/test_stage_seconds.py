from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import delete, select

from jobkit.database.session import Database
from jobkit.database.tables import AttemptCountRow, AttemptRow, StageRow
from jobkit.errors import StaleAttemptError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.stage_seconds import StageSeconds, add_stages
from quadpatch_client.schema import TASKS, Job, JobError, JobResult

RESULT = JobResult(format="ply", files=[])
LOST = JobError(code="worker_lost", message="gone", retryable=True)


def sums(database: Database) -> dict[tuple[str, str, str], tuple[int, float]]:
    with database.read() as session:
        return {
            (row.stage, row.method, row.task): (row.count, row.seconds) for row in session.scalars(select(StageRow))
        }


def attempt_counts(database: Database) -> dict[tuple[str, str], int]:
    with database.read() as session:
        return {(row.outcome, row.code): row.count for row in session.scalars(select(AttemptCountRow))}


repairs = st.lists(
    st.builds(
        StageSeconds,
        st.sampled_from(["smooth", "dictionary"]),
        st.dictionaries(st.sampled_from(["read", "fill", "write"]), st.integers(0, 1000).map(float)),
        st.sampled_from(TASKS),
    ),
    max_size=6,
)


@pytest.fixture(scope="module")
def shared_database(tmp_path_factory: pytest.TempPathFactory) -> Database:
    database = Database(f"sqlite:///{tmp_path_factory.mktemp('stages') / 'quadpatch.db'}")
    database.migrate()
    return database


@given(repairs=repairs)
def test_sums_and_counts_are_those_of_all_repairs(shared_database: Database, repairs: Sequence[StageSeconds]) -> None:
    with shared_database.write() as session:
        session.execute(delete(StageRow))
    expected: dict[tuple[str, str, str], tuple[int, float]] = {}
    for repair in repairs:
        with shared_database.write() as session:
            add_stages(session, repair)
        for stage, seconds in repair.seconds.items():
            key = (stage, repair.method, repair.task)
            count, total = expected.get(key, (0, 0.0))
            expected[key] = (count + 1, total + seconds)
    assert sums(shared_database) == expected


def test_stages_are_added_with_the_result_and_only_with_it(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    first = attempts.start(job.id, "w", 30).attempt
    attempts.requeue(first, LOST)
    second = attempts.start(job.id, "w", 30).attempt
    stages = StageSeconds("smooth", {"read": 1.0, "fill": 2.5})
    with pytest.raises(StaleAttemptError):
        attempts.publish(first, RESULT, stages)
    assert sums(database) == {}
    attempts.publish(second, RESULT, stages)
    assert sums(database) == {("read", "smooth", "fill"): (1, 1.0), ("fill", "smooth", "fill"): (1, 2.5)}


def test_a_canceled_repair_adds_no_stages(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    Jobs(database).request_cancel(job.id)
    attempts.publish(attempt, RESULT, StageSeconds("smooth", {"read": 1.0}))
    assert sums(database) == {}
    assert attempt_counts(database) == {("canceled", ""): 1}


def test_counts_of_attempts_outlive_the_attempts(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempts.requeue(attempts.start(job.id, "w", 30).attempt, LOST)
    attempts.requeue(attempts.start(job.id, "w", 30).attempt, LOST)
    with database.write() as session:
        session.execute(delete(AttemptRow))
    assert attempt_counts(database) == {("requeued", "worker_lost"): 1, ("failed", "worker_lost"): 1}
