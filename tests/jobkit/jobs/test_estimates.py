import math
from dataclasses import replace
from datetime import timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import update

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.estimates import Estimates, remaining_queued_s, remaining_running_s
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.past_jobs import MIN_PAST, Rates, Sample
from jobkit.jobs.search import JobSearch
from quadpatch_client.schema import AutoMethod, Job, JobError, JobResult, JobState, ResolvedModel
from quadpatch_rules.option_words import Effort

MIB = 1 << 20
AUTO = ResolvedModel(requested="auto", kind="auto")
seconds = st.floats(0.1, 1e4)


def completed(estimates: Estimates, job: Job) -> Job:
    estimates.refresh()
    return estimates.complete(job)


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@given(rate=st.floats(0.01, 100.0), sizes=st.lists(st.integers(MIB, 2 * MIB - 1), min_size=MIN_PAST), size=st.just(MIB))
def test_jobs_of_one_pace_foretell_their_like_exactly(rate: float, sizes: list[int], size: int) -> None:
    rates = Rates(Sample("self", past, rate * past) for past in sizes)
    assert rates.amount("self", size) == pytest.approx(rate * size)


def test_one_odd_job_among_many_changes_little() -> None:
    past = [Sample("self", MIB, 10.0)] * 8 + [Sample("self", MIB, 5000.0)]
    assert Rates(past).amount("self", MIB) == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("kind", "size", "n_past"), [("none", MIB, 9), ("self", 8 * MIB, 9), ("self", MIB // 8, 9), ("self", MIB, 2)]
)
def test_other_kinds_other_sizes_and_too_few_jobs_foretell_nothing(kind: str, size: int, n_past: int) -> None:
    assert Rates([Sample("self", MIB, 10.0)] * n_past).amount(kind, size) is None


@given(whole=seconds, done_share=st.floats(0.0, 0.999), worked=seconds)
def test_a_job_that_was_just_heard_of_has_left_what_it_has_not_done(
    whole: float, done_share: float, worked: float
) -> None:
    assert remaining_running_s(whole, done_share, worked, 0.0) == pytest.approx((1.0 - done_share) * whole)


def test_a_job_that_takes_longer_than_others_goes_by_its_own_pace() -> None:
    assert remaining_running_s(10.0, 0.5, 60.0, 20.0) == pytest.approx(60.0)
    assert remaining_running_s(10.0, 0.0, 60.0, 60.0) is None
    assert remaining_running_s(None, 0.5, 60.0, 0.0) is None


@given(jobs=st.lists(seconds, min_size=1, max_size=20), n_workers=st.integers(1, 5))
def test_a_queue_never_ends_before_its_work_is_shared_and_never_after_one_worker_had_done_it(
    jobs: list[float], n_workers: int
) -> None:
    ends = [end for end in remaining_queued_s([0.0] * n_workers, [(job, 0.0) for job in jobs]) if end is not None]
    assert len(ends) == len(jobs)
    assert max(ends) >= max(sum(jobs) / n_workers, *jobs) * (1 - 1e-9)
    assert max(ends) <= sum(jobs) * (1 + 1e-9)
    assert all(end >= job for end, job in zip(ends, jobs, strict=True))


def test_an_unknown_job_holds_its_worker_for_ever_and_the_others_go_on() -> None:
    jobs = [(None, 0.0), (10.0, 0.0), (10.0, 0.0)]
    assert remaining_queued_s([0.0, 5.0], jobs) == [None, 15.0, 25.0]
    assert remaining_queued_s([0.0], jobs) == [None, None, None]
    assert remaining_queued_s([], jobs) == [None, None, None]
    assert remaining_queued_s([math.inf], [(1.0, 0.0)]) == [None]


def test_a_job_that_has_to_wait_starts_no_sooner() -> None:
    assert remaining_queued_s([0.0], [(10.0, 30.0)]) == [40.0]


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def estimates(database: Database, clock: Clock) -> Estimates:
    return Estimates(database, clock)


@pytest.fixture
def past(database: Database, new_job: NewJob) -> None:
    """As many jobs as it takes to learn from; each took 100 s."""
    with database.write() as session:
        session.execute(update(MeshRow).values(size_bytes=MIB))
    for _ in range(MIN_PAST):
        job = Jobs(database).create(new_job)[0]
        attempt = Attempts(database).start(job.id, "test", 60).attempt
        Attempts(database).publish(attempt, JobResult(format="ply"))
        with database.write() as session:
            ended = utc_now()
            times = {"started_at": ended - timedelta(seconds=100), "finished_at": ended}
            session.execute(update(JobRow).where(JobRow.id == job.id).values(**times))


def test_waiting_jobs_stand_in_the_order_in_which_they_came(
    database: Database, new_job: NewJob, estimates: Estimates
) -> None:
    jobs = [Jobs(database).create(new_job)[0] for _ in range(3)]
    assert [completed(estimates, job).queue_position for job in jobs] == [1, 2, 3]


def test_a_job_that_comes_back_stands_at_the_end(
    database: Database, new_job: NewJob, estimates: Estimates, clock: Clock
) -> None:
    first, second = (Jobs(database).create(new_job)[0] for _ in range(2))
    attempts = Attempts(database)
    attempt = attempts.start(first.id, "test", 60).attempt
    assert completed(estimates, second).queue_position == 1
    attempts.requeue(attempt, JobError(code="worker_lost", message="gone"))
    clock.now += 10
    estimates.refresh()
    assert [estimates.position(job.id, JobState.QUEUED) for job in (second, first)] == [1, 2]


def test_without_past_jobs_nothing_is_foretold(job: Job, database: Database, estimates: Estimates) -> None:
    Attempts(database).start(job.id, "test", 60)
    assert completed(estimates, Jobs(database).get(job.id)).eta_s is None


@pytest.mark.usefixtures("past")
def test_a_running_job_and_those_behind_it_are_foretold_from_past_ones(
    database: Database, new_job: NewJob, estimates: Estimates, clock: Clock
) -> None:
    jobs = Jobs(database)
    running, second, third = (jobs.create(new_job)[0] for _ in range(3))
    assert completed(estimates, second).eta_s is None  # no worker has a lease
    attempt = Attempts(database).start(running.id, "test", 60).attempt
    Attempts(database).report_progress(attempt, "fill", 40.0)
    clock.now += 10
    remaining_s = [completed(estimates, jobs.get(job.id)).eta_s for job in (running, second, third)]
    assert remaining_s == pytest.approx([60.0, 160.0, 260.0], abs=5.0)
    clock.now += 0.5
    assert completed(estimates, jobs.get(running.id)).eta_s == pytest.approx(
        remaining_s[0] - 0.5 if remaining_s[0] else None
    )


@pytest.mark.usefixtures("past")
def test_jobs_of_one_task_foretell_nothing_about_another(
    database: Database, new_job: NewJob, estimates: Estimates
) -> None:
    other_spec = new_job.spec.model_copy(update={"task": "denoise"})
    jobs = [Jobs(database).create(replace(new_job, spec=spec))[0] for spec in (new_job.spec, other_spec)]
    for job in jobs:
        Attempts(database).start(job.id, "test", 60)
    fill, denoise = (completed(estimates, Jobs(database).get(job.id)).eta_s for job in jobs)
    assert fill == pytest.approx(100.0, abs=5.0)
    assert denoise is None


@pytest.mark.usefixtures("past")
def test_jobs_of_one_effort_foretell_nothing_about_another(
    database: Database, new_job: NewJob, estimates: Estimates
) -> None:
    efforts: tuple[Effort, ...] = ("standard", "best", "standard")
    with database.write() as session:
        past_spec = new_job.spec.model_copy(update={"method": AutoMethod(method="auto")})
        session.execute(update(JobRow).values(spec=past_spec.model_dump(mode="json"), model=AUTO.model_dump()))
    specs = [past_spec.model_copy(update={"method": AutoMethod(method="auto", effort=effort)}) for effort in efforts]
    jobs = [Jobs(database).create(replace(new_job, spec=spec, model=AUTO))[0] for spec in specs]
    for job in jobs:
        Attempts(database).start(job.id, "test", 60)
    standard, best, again = (completed(estimates, Jobs(database).get(job.id)).eta_s for job in jobs)
    assert [standard, again] == pytest.approx([100.0, 100.0], abs=5.0)
    assert best is None


@pytest.mark.usefixtures("past")
def test_a_worker_whose_lease_ran_out_takes_no_more_jobs(
    database: Database, new_job: NewJob, estimates: Estimates
) -> None:
    lost, queued_jobs = (Jobs(database).create(new_job)[0] for _ in range(2))
    Attempts(database).start(lost.id, "test", -1.0)
    assert completed(estimates, Jobs(database).get(queued_jobs.id)).eta_s is None


@pytest.mark.usefixtures("past")
def test_a_job_that_has_ended_or_is_about_to_has_no_estimate(
    database: Database, job: Job, estimates: Estimates
) -> None:
    Attempts(database).start(job.id, "test", 60)
    canceling = completed(estimates, Jobs(database).request_cancel(job.id))
    assert (canceling.eta_s, canceling.queue_position) == (None, None)
    ended = Jobs(database).page(1, search=JobSearch([JobState.SUCCEEDED])).items[0]
    assert completed(estimates, ended) == ended


def test_many_who_ask_at_once_share_one_look(database: Database, job: Job, new_job: NewJob, clock: Clock) -> None:
    estimates = Estimates(database, clock)
    assert completed(estimates, job).queue_position == 1
    later = [Jobs(database).create(new_job)[0] for _ in range(2)]
    assert [completed(estimates, job).queue_position for job in later] == [2, 2]
    clock.now += 10
    assert [completed(estimates, job).queue_position for job in later] == [2, 3]
