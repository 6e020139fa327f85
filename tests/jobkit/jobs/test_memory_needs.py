from datetime import timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import update

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.memory_needs import BASE_MB, BY_GEOMETRY, MemoryNeeds, expected_from_bytes
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.past_jobs import MIN_PAST, kind_of
from quadpatch_client.schema import JobResult

MIB = 1 << 20


@pytest.fixture
def database(any_database: Database) -> Database:
    return any_database


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def finish(database: Database, new_job: NewJob, peaks_mb: list[int | None]) -> None:
    with database.write() as session:
        session.execute(update(MeshRow).values(size_bytes=MIB))
    for number, peak_mb in enumerate(peaks_mb):
        attempt = Attempts(database).start(Jobs(database).create(new_job)[0].id, "w", 60).attempt
        Attempts(database).publish(attempt, JobResult(format="ply", peak_memory_mb=peak_mb))
        with database.write() as session:
            ended = {"finished_at": utc_now() + timedelta(seconds=number)}
            session.execute(update(JobRow).where(JobRow.id == attempt.job_id).values(**ended))


def test_nine_of_ten_past_jobs_would_have_fitted_into_what_is_expected(database: Database, new_job: NewJob) -> None:
    kind = kind_of("fill", new_job.model.kind)
    finish(database, new_job, [BASE_MB + 10 * number for number in range(1, 11)])
    needs = MemoryNeeds(database)
    assert needs.expected_mb(kind, MIB) == expected_from_bytes(kind, MIB)
    needs.refresh()
    assert needs.expected_mb(kind, MIB) == BASE_MB + 90
    assert needs.expected_mb(kind, 2 * MIB) == BASE_MB + 180
    assert needs.expected_mb(kind, MIB // 2) == BASE_MB + 45
    assert needs.expected_mb(kind, 8 * MIB) == expected_from_bytes(kind, 8 * MIB)
    assert needs.expected_mb(BY_GEOMETRY, MIB) == expected_from_bytes(BY_GEOMETRY, MIB)


def test_jobs_of_versions_that_noted_no_peak_are_no_basis(database: Database, new_job: NewJob) -> None:
    finish(database, new_job, [*[None] * MIN_PAST, *[200] * (MIN_PAST - 1)])
    needs, kind = MemoryNeeds(database), kind_of("fill", new_job.model.kind)
    needs.refresh()
    assert needs.expected_mb(kind, MIB) == expected_from_bytes(kind, MIB)


def test_past_jobs_are_read_once_a_minute(database: Database, new_job: NewJob) -> None:
    clock = Clock()
    needs, kind = MemoryNeeds(database, clock), kind_of("fill", new_job.model.kind)
    needs.refresh()
    finish(database, new_job, [200] * MIN_PAST)
    clock.now += 59
    needs.refresh()
    assert needs.expected_mb(kind, MIB) != 200
    clock.now += 2
    needs.refresh()
    assert needs.expected_mb(kind, MIB) == 200


@given(size_bytes=st.integers(1, 1 << 32), more=st.integers(1, 1 << 32))
def test_without_past_jobs_a_larger_file_is_expected_to_need_more(size_bytes: int, more: int) -> None:
    kinds = (BY_GEOMETRY, "fill self", "denoise self", "fill self_network", "fill auto best")
    needs = [expected_from_bytes(kind, size_bytes) for kind in kinds]
    assert needs[0] < needs[1] <= needs[2]
    assert needs[1] < needs[3]
    assert all(expected_from_bytes(kind, size_bytes + more) >= need for kind, need in zip(kinds, needs, strict=True))
