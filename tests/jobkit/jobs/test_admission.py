"""Also tests `jobkit.jobs.reservations`."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import select, update

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MachineRow, MeshRow, ReservationRow
from jobkit.errors import MemoryFullError, StaleAttemptError
from jobkit.jobs.admission import Admission, AdmissionRules, Grant, decide
from jobkit.jobs.attempts import Attempts, StartedAttempt
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.memory_needs import MemoryNeeds
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.reservations import Machine, MachineMemory, Reservation, Room
from quadpatch_client.schema import JobState, Limits

LIMIT_MB, WAIT_S = 1000, 60.0
amounts = st.integers(0, 2000)


@pytest.fixture
def database(any_database: Database) -> Database:
    return any_database


class Site:
    """A database with machines whose memory the test sets, and jobs of a known need."""

    def __init__(self, database: Database, new_job: NewJob) -> None:
        self.database = database
        self.new_job = new_job
        self.jobs, self.attempts = Jobs(database), Attempts(database)
        self.free_mb = {"m": LIMIT_MB}
        self.limit_mb = {"m": LIMIT_MB}

    def admission(self, worker: str, machine: str = "m") -> Admission:
        def measure() -> MachineMemory:
            return MachineMemory(self.limit_mb[machine], self.free_mb[machine])

        rules = AdmissionRules(attempt_mb=100_000, wait_s=WAIT_S)
        return Admission(self.database, MemoryNeeds(self.database), worker, Machine(machine, measure), rules)

    def job(self, needed_mb: int) -> str:
        """Make a job that is expected to need so much: that is its own limit, and its mesh is huge."""
        spec = self.new_job.spec.model_copy(update={"limits": Limits(memory_mb=needed_mb)})
        return self.jobs.create(replace(self.new_job, spec=spec))[0].id

    def start(self, job_id: str, worker: str, machine: str = "m", lease_s: float = 600.0) -> StartedAttempt:
        return self.attempts.start(job_id, worker, lease_s, self.admission(worker, machine))

    def waits(self, job_id: str, worker: str, machine: str = "m") -> bool:
        """Try to start a job; tell whether it has to wait."""
        try:
            self.start(job_id, worker, machine)
        except MemoryFullError:
            assert self.jobs.get(job_id).waits_for == "memory"
            return True
        assert self.jobs.get(job_id).waits_for is None
        return False

    def pass_time(self, seconds: float) -> None:
        """Let time pass for what waits and for leases."""
        age = timedelta(seconds=seconds)
        with self.database.write() as session:
            for row in session.scalars(select(JobRow).where(JobRow.memory_wait_since.is_not(None))):
                row.memory_wait_since, row.not_before = (row.memory_wait_since or utc_now()) - age, utc_now()
            for reservation in session.scalars(select(ReservationRow)):
                reservation.until -= age


@pytest.fixture
def site(database: Database, new_job: NewJob) -> Site:
    with database.write() as session:
        session.execute(update(MeshRow).values(size_bytes=1 << 33))
    return Site(database, new_job)


@given(
    needed=amounts,
    free=amounts,
    limit=amounts,
    reservations=st.lists(st.builds(Reservation, amounts, amounts, st.booleans()), max_size=4),
)
def test_what_engines_are_still_to_take_is_never_given_away(
    needed: int, free: int, limit: int, reservations: list[Reservation]
) -> None:
    room = Room(MachineMemory(limit, free), tuple(reservations))
    granted = decide(needed, room, 0, may_run_alone=True)
    if granted == Grant():
        assert needed + sum(max(r.reserved_mb - r.used_mb, 0) for r in reservations) <= free
        assert needed + sum(max(r.reserved_mb, r.used_mb) for r in reservations) <= limit
    elif granted is not None:
        assert not any(r.is_job for r in reservations)
        assert needed > room.left_mb


def test_two_jobs_that_do_not_fit_together_run_one_after_the_other(site: Site) -> None:
    first, second = site.job(600), site.job(600)
    site.start(first, "w1")
    assert site.waits(second, "w2")
    site.admission("w1").release()
    site.pass_time(0)
    assert not site.waits(second, "w2")


def test_two_jobs_that_fit_run_at_once(site: Site) -> None:
    assert not site.waits(site.job(500), "w1")
    assert not site.waits(site.job(500), "w2")


def test_a_job_that_does_not_fit_holds_up_no_smaller_one(site: Site) -> None:
    site.start(site.job(600), "w1")
    assert site.waits(site.job(600), "w2")
    assert not site.waits(site.job(300), "w2")


def test_machines_have_memory_of_their_own(site: Site) -> None:
    site.free_mb["n"] = site.limit_mb["n"] = LIMIT_MB
    site.start(site.job(600), "w1")
    assert not site.waits(site.job(600), "w2", "n")


def test_what_an_engine_has_already_is_not_counted_twice(site: Site) -> None:
    site.limit_mb["m"] = 10 * LIMIT_MB
    site.start(site.job(600), "w1")
    site.free_mb["m"] = 500
    assert site.waits(site.job(450), "w2")
    site.admission("w1").renew(600.0, used_mb=550)
    assert not site.waits(site.job(450), "w2")


def test_what_a_killed_worker_reserved_is_given_back_with_its_lease(site: Site) -> None:
    waiting = site.job(600)
    site.start(site.job(600), "w1", lease_s=30.0)
    assert site.waits(waiting, "w2")
    site.pass_time(29)
    assert site.waits(waiting, "w2")
    site.pass_time(2)
    assert not site.waits(waiting, "w2")


def test_a_start_that_fails_reserves_nothing(site: Site) -> None:
    job_id = site.job(600)
    site.jobs.request_cancel(job_id)
    with pytest.raises(StaleAttemptError):
        site.start(job_id, "w1")
    assert not site.waits(site.job(LIMIT_MB), "w2")


def test_of_many_workers_at_once_as_many_start_as_fit(site: Site) -> None:
    jobs = [site.job(300) for _ in range(8)]
    with ThreadPoolExecutor(len(jobs)) as pool:
        waiting = list(pool.map(site.waits, jobs, [f"w{number}" for number in range(len(jobs))]))
    assert waiting.count(False) == LIMIT_MB // 300
    with site.database.read() as session:
        assert session.scalars(select(MachineRow.name)).all() == ["m"]


def test_after_some_waiting_a_job_is_next_on_its_machine(site: Site) -> None:
    large, small = site.job(900), [site.job(256) for _ in range(3)]
    site.start(small[0], "w1")
    assert site.waits(large, "w2")
    site.start(small[1], "w2")
    site.admission("w1").release()
    site.pass_time(WAIT_S + 1)
    # What runs goes on, and what is left stays free for the job that waits.
    assert site.waits(small[2], "w1")
    assert site.waits(large, "w3")
    site.admission("w2").release()
    site.pass_time(WAIT_S + 1)
    assert not site.waits(large, "w1")
    assert site.waits(small[2], "w2")


def test_what_fits_beside_the_job_that_is_next_starts_even_so(site: Site) -> None:
    site.start(site.job(600), "w1")
    assert site.waits(site.job(500), "w2")
    site.pass_time(WAIT_S + 1)
    assert site.waits(site.job(300), "w2")
    site.admission("w1").release()
    assert not site.waits(site.job(300), "w2")
    assert site.waits(site.job(300), "w1")


def test_a_job_that_is_larger_than_the_machine_runs_alone_and_with_a_limit(site: Site) -> None:
    huge, small = site.job(5000), site.job(300)
    site.free_mb["m"] = 800
    site.start(small, "w1")
    assert site.waits(huge, "w2")
    site.admission("w1").release()
    site.pass_time(0)
    assert site.start(huge, "w2").memory_mb == 800
    assert site.waits(site.job(256), "w1")


def test_a_job_that_is_larger_than_its_machine_is_left_to_a_larger_one(site: Site) -> None:
    site.free_mb["n"] = site.limit_mb["n"] = 10 * LIMIT_MB
    site.start(site.job(256), "w9", "n")
    huge = site.job(5000)
    assert site.waits(huge, "w1")
    site.pass_time(WAIT_S + 1)
    # Nothing is held back for it where it can't run.
    assert not site.waits(site.job(900), "w1")
    assert site.start(huge, "w8", "n").memory_mb is None


def test_a_job_for_which_other_programs_leave_no_room_waits_for_them_but_not_for_ever(site: Site) -> None:
    job_id = site.job(900)
    site.free_mb["m"] = 500
    assert site.waits(job_id, "w1")
    site.pass_time(WAIT_S - 5)
    assert site.waits(job_id, "w1")
    site.pass_time(WAIT_S + 1)
    assert site.start(job_id, "w1").memory_mb == 500


def test_waiting_is_one_event_and_keeps_the_place_in_the_queue(site: Site) -> None:
    site.start(site.job(600), "w1")
    job_id = site.job(600)
    before = site.jobs.get(job_id)
    for _ in range(2):
        assert site.waits(job_id, "w2")
        site.pass_time(1)
    after = site.jobs.get(job_id)
    events = site.jobs.events(job_id).items
    assert [event.type for event in events] == ["queued", "queued"]
    assert events[-1].data == {"state": "queued", "waits_for": "memory", "memory_mb": 600}
    assert (after.state, after.revision, after.attempt) == (JobState.QUEUED, before.revision + 1, 0)


def test_a_job_that_waits_can_be_canceled(site: Site) -> None:
    site.start(site.job(600), "w1")
    job_id = site.job(600)
    assert site.waits(job_id, "w2")
    canceled = site.jobs.request_cancel(job_id)
    assert (canceled.state, canceled.waits_for) == (JobState.CANCELED, None)
    assert site.admission("w2").fitting() == []


def test_those_that_fit_are_found_the_oldest_first(site: Site) -> None:
    running = site.admission("w1")
    site.start(site.job(900), "w1")
    waiting = [site.job(needed_mb) for needed_mb in (800, 400, 300, 900)]
    for job_id in waiting:
        assert site.waits(job_id, "w2")
    assert running.fitting() == []
    running.release()
    assert running.fitting() == []  # they have just been refused
    with site.database.write() as session:
        session.execute(update(JobRow).values(not_before=utc_now()))
    assert running.fitting() == [(waiting[0], 0)]
    site.start(site.job(256), "w1")
    with site.database.write() as session:
        session.execute(update(JobRow).values(not_before=utc_now()))
    assert site.admission("w2").fitting() == [(waiting[1], 0), (waiting[2], 0)]


def test_a_task_that_is_not_held_up_takes_its_share_and_holds_up_no_job_for_ever(site: Site) -> None:
    site.admission("w1").reserve(700, 600.0)
    job_id = site.job(400)
    assert site.waits(job_id, "w2")
    site.pass_time(WAIT_S + 1)
    assert site.admission("w2").fitting() == [(job_id, 0)]
    assert site.start(job_id, "w2").memory_mb == LIMIT_MB


def test_machines_that_are_there_no_more_are_forgotten(site: Site, database: Database) -> None:
    site.start(site.job(256), "w1")
    with database.write() as session:
        long_ago = utc_now() - timedelta(days=2)
        session.execute(update(MachineRow).values(seen_at=long_ago))
        session.execute(update(ReservationRow).values(until=long_ago))
    site.free_mb["n"] = site.limit_mb["n"] = LIMIT_MB
    site.start(site.job(256), "w2", "n")
    with database.read() as session:
        assert session.scalars(select(MachineRow.name)).all() == ["n"]
        assert session.scalars(select(ReservationRow.worker)).all() == ["w2"]
