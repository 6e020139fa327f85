from collections import Counter
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow
from jobkit.errors import StaleAttemptError
from jobkit.jobs.admission import Admission, AdmissionRules
from jobkit.jobs.attempts import Attempts, StartedAttempt
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.memory_needs import MemoryNeeds
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.reservations import Machine, MachineMemory
from jobkit.jobs.turns import last_turns, next_in_turn, order_of_turns
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import JobSpec, Priority, ResolvedModel
from tests.jobkit.fixtures import upload

NOW = datetime(2026, 11, 30, tzinfo=UTC)


class Job(NamedTuple):
    id: int
    tenant: str
    priority: int


@pytest.fixture
def make(database: Database, store: ObjectStore) -> Callable[..., str]:
    def run(tenant: str, priority: Priority = "normal") -> str:
        owned = database.of(tenant)
        spec = JobSpec(mesh_id=upload(owned, store, b"ply").id, priority=priority)
        return Jobs(owned).create(NewJob(spec, ResolvedModel(requested="auto", kind="auto"), max_attempts=3))[0].id

    return run


def start(database: Database, named: str) -> StartedAttempt:
    machine = Machine("m", lambda: MachineMemory(1 << 20, 1 << 20))
    admission = Admission(database, MemoryNeeds(database), "w", machine, AdmissionRules(4096, 60.0))
    return Attempts(database).start_next(named, "w", 60.0, admission)


def test_a_batch_of_one_tenant_delays_the_job_of_another_by_what_runs_and_no_more(
    database: Database, make: Callable[..., str]
) -> None:
    batch = [make("large") for _ in range(20)]
    assert start(database, batch[0]).attempt.job_id == batch[0]
    single = make("small")
    # The entry of the queue is that of the batch.
    assert start(database, batch[1]).attempt.job_id == single
    assert start(database, batch[2]).attempt.job_id == batch[1]
    # The entry of what was started out of turn is a turn as well.
    assert start(database, single).attempt.job_id == batch[2]


def test_priorities_go_before_turns(database: Database, make: Callable[..., str]) -> None:
    bulk, normal, urgent = make("a", "bulk"), make("b"), make("a", "interactive")
    assert [start(database, bulk).attempt.job_id for _ in range(3)] == [urgent, normal, bulk]
    with pytest.raises(StaleAttemptError):
        start(database, bulk)


def test_a_job_that_waits_for_memory_or_came_back_is_the_one_that_its_entry_names(
    database: Database, make: Callable[..., str]
) -> None:
    waiting, back, other = make("a"), make("a"), make("b", "interactive")
    with database.write() as session:
        for job_id, values in ((waiting, {"memory_wait_since": NOW, "needed_memory_mb": 1}), (back, {"attempt": 1})):
            row = session.get(JobRow, job_id)
            assert row is not None
            for name, value in values.items():
                setattr(row, name, value)
        assert next_in_turn(session, shared_now(session)) == other
    assert [start(database, job_id).attempt.job_id for job_id in (waiting, back)] == [waiting, back]


def test_the_order_that_is_shown_is_the_order_in_which_jobs_start(database: Database, make: Callable[..., str]) -> None:
    kinds: list[tuple[str, Priority]] = [
        ("a", "bulk"),
        ("a", "normal"),
        ("b", "normal"),
        ("a", "normal"),
        ("b", "bulk"),
    ]
    ids = [make(tenant, priority) for tenant, priority in kinds * 2]
    with database.read() as session:
        rows = list(session.query(JobRow).order_by(JobRow.id))
        shown = [row.id for row in order_of_turns(rows, last_turns(session))]
    assert [start(database, job_id).attempt.job_id for job_id in ids] == shown


@given(st.lists(st.tuples(st.sampled_from("abc"), st.integers(0, 2)), max_size=30), st.sets(st.sampled_from("abc")))
def test_turns_are_fair(kinds: list[tuple[str, int]], served: set[str]) -> None:
    jobs = [Job(number, tenant, rank) for number, (tenant, rank) in enumerate(kinds)]
    turns = {tenant: NOW + timedelta(seconds=place) for place, tenant in enumerate(sorted(served))}
    ordered = order_of_turns(jobs, turns)
    assert sorted(ordered) == sorted(jobs)
    assert [job.priority for job in ordered] == sorted(job.priority for job in jobs)
    for rank in range(3):
        left = Counter(job.tenant for job in jobs if job.priority == rank)
        mine = [job for job in ordered if job.priority == rank]
        for tenant in left:
            numbers = [job.id for job in mine if job.tenant == tenant]
            assert numbers == sorted(numbers)
        for one, next_one in pairwise(mine):
            left[one.tenant] -= 1
            # No tenant has two turns in a row while others wait.
            assert one.tenant != next_one.tenant or sum(count > 0 for count in left.values()) == 1
