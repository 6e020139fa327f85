"""Runs of candidates on either database.

Also tests `jobkit.shadows.choice`, `jobkit.shadows.shadows` and `jobkit.database.shadow_tables`.
"""

from collections.abc import Callable
from contextlib import closing
from datetime import timedelta
from pathlib import Path

import pytest
from sqlalchemy import update

from jobkit.access.tenants import Tenants
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.shadow_tables import ShadowRunRow
from jobkit.database.tenancy import mesh_id_of
from jobkit.errors import ModelKindError, ModelNotFoundError, ShadowNotFoundError, StaleAttemptError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.timeouts import TimeLimits
from jobkit.meshes import Meshes
from jobkit.models.lifetime import delete_version
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.models.resolution import resolve_method
from jobkit.queue import TaskQueue, shadow_entry
from jobkit.requeue import reconcile
from jobkit.retention import delete_job
from jobkit.settings import Settings
from jobkit.shadows.choice import is_chosen
from jobkit.shadows.runs import LONGEST_WAIT, MAX_ATTEMPTS, Comparison, ShadowRuns, take_back_runs
from jobkit.shadows.shadows import Shadows
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import (
    HoleCounts,
    Job,
    JobResult,
    JobSpec,
    MeshProblem,
    NewShadow,
    ShadowRun,
    TenantChanges,
)
from quadpatch_rules.ids import new_job_id

ROOT = Path(__file__).resolve().parents[3]
TENANT = "plant-north"
RESULT = JobResult(format="ply", holes=HoleCounts(found=2, filled=1, skipped=1))
DICTIONARY = {"method": "dictionary", "model": "ours"}
Bytes = Callable[[int], bytes]


class Bench:
    """A tenant with the alias `ours` on a dictionary, a candidate, and hands that do what a worker does."""

    def __init__(self, database: Database, store: ObjectStore, dictionary_bytes: Bytes) -> None:
        self.all, self.store, self.database = database, store, database.of(TENANT)
        self.jobs, self.attempts = Jobs(self.database), Attempts(self.database)
        self.registry = Registry(self.database, store)
        self.shadows, self.runs = Shadows(self.database, self.registry), ShadowRuns(database)
        for seed in (1, 2):
            with store.writer(MODEL_PREFIX) as writer:
                writer.write(dictionary_bytes(seed))
                stored = writer.commit()
            self.registry.publish("walls", stored, is_proven=True)
        self.registry.set_alias("ours", "walls@1")
        with store.writer("meshes") as writer:
            writer.write(b"ply 1")
            mesh = Meshes(self.database).add(writer.commit(), "scan.ply", "ply")[0]
        self.mesh_id = mesh.id
        analysis = Meshes(database).start_analysis(mesh_id_of(TENANT, mesh.id), "w", 30)
        # An upload that is still to be analysed would come first.
        Meshes(database).reject(analysis, MeshProblem(code="analysis_failed", message="not needed here"))

    def wait(self, **method: str) -> Job:
        """Make a job that waits."""
        spec = JobSpec.model_validate({"mesh_id": self.mesh_id, "method": method or DICTIONARY})
        return self.jobs.create(NewJob(spec, resolve_method(self.registry, spec.method), 3))[0]

    def finish(self, **method: str) -> Job:
        """Make a job that has its result, and choose as a worker does."""
        job = self.wait(**method)
        self.attempts.publish(self.attempts.start(job.id, "w", 30).attempt, RESULT)
        return self.jobs.get(job.id)

    def add(self, job: Job) -> bool:
        return self.runs.add(self.registry, job, TENANT)

    def shown(self) -> list[ShadowRun]:
        return self.shadows.runs("ours", 100).items


@pytest.fixture
def bench(any_database: Database, store: ObjectStore, dictionary_bytes: Bytes) -> Bench:
    bench = Bench(any_database, store, dictionary_bytes)
    bench.shadows.put("ours", NewShadow(candidate="walls@2", share=1.0))
    return bench


def test_the_choice_follows_from_the_job_alone_and_a_larger_share_holds_a_smaller_one() -> None:
    ids = [new_job_id() for _ in range(4000)]
    chosen = {share: {i for i in ids if is_chosen("ours", i, share)} for share in (0.0, 0.1, 0.3, 1.0)}
    assert chosen[0.0] == set()
    assert chosen[1.0] == set(ids)
    assert chosen[0.1] < chosen[0.3]
    # Six standard deviations of a binomial.
    assert abs(len(chosen[0.1]) - 400) < 6 * (4000 * 0.1 * 0.9) ** 0.5
    assert is_chosen("ours", "job_01jd7z3v5qk8m2x4c6b8n0a9de", 0.5) is True
    assert is_chosen("default", "job_01jd7z3v5qk8m2x4c6b8n0a9de", 0.5) is False


def test_a_job_with_its_result_gets_a_run_that_is_compared(bench: Bench) -> None:
    job = bench.finish()
    assert bench.add(job)
    run = bench.runs.start(job.id, "w", 30)
    assert (run.candidate, run.tenant, run.attempt, run.is_last) == ("walls@2", TENANT, 1, False)
    assert bench.shadows.get("ours").waiting == 1
    bench.runs.measure(run, Comparison(5, 0.8))
    (shown,) = bench.shown()
    assert (shown.state, shown.baseline, shown.holes, shown.ratio) == ("measured", "walls@1", 5, 0.8)
    figures = bench.shadows.get("ours").figures
    assert (figures.baseline, figures.jobs, figures.better, figures.holes) == ("walls@1", 1, 1, 5)
    with pytest.raises(StaleAttemptError):
        bench.runs.start(job.id, "w", 30)


def test_other_jobs_get_none(bench: Bench) -> None:
    assert not bench.add(bench.finish(method="smooth"))
    assert not bench.add(bench.finish(method="dictionary", model="walls@1"))
    assert not bench.add(bench.wait())
    bench.registry.set_alias("ours", "walls@2")
    assert not bench.add(bench.finish()), "the candidate is not compared with itself"
    bench.registry.set_alias("ours", "walls@1")
    bench.shadows.put("ours", NewShadow(candidate="walls@2", share=0.0))
    assert not bench.add(bench.finish())
    bench.shadows.put("ours", NewShadow(candidate="walls@2", share=1.0))
    job = bench.wait()
    nothing_filled = JobResult(format="ply", holes=HoleCounts(found=2, skipped=1, refused=1))
    bench.attempts.publish(bench.attempts.start(job.id, "w", 30).attempt, nothing_filled)
    assert not bench.add(bench.jobs.get(job.id))
    assert bench.shown() == []


def test_a_shadow_of_auto_takes_models_of_either_kind(bench: Bench) -> None:
    shadow = bench.shadows.put("auto", NewShadow(candidate="walls", share=1.0))
    assert shadow.candidate == "walls@2"
    assert bench.add(bench.finish(method="auto"))
    (run,) = bench.shadows.runs("auto", 10).items
    assert (run.baseline, run.candidate) == ("auto", "walls@2")


def test_a_run_waits_while_anything_else_does_and_gives_way_to_it(bench: Bench) -> None:
    first = bench.finish()
    bench.add(first)
    assert not bench.runs.gives_way()
    second = bench.wait()
    with pytest.raises(StaleAttemptError, match="others wait"):
        bench.runs.start(first.id, "w", 30)
    assert bench.runs.gives_way()
    attempt = bench.attempts.start(second.id, "w", 30).attempt
    run = bench.runs.start(first.id, "w", 30)
    bench.attempts.publish(attempt, RESULT)
    for _ in range(5):
        bench.runs.hand_back(run)
        run = bench.runs.start(first.id, "w", 30)
        assert not run.is_last, "to give way costs no attempt"


def test_a_run_does_not_wait_for_jobs_of_a_tenant_that_runs_what_it_may(bench: Bench) -> None:
    job = bench.finish()
    bench.add(job)
    Tenants(bench.all).change(TENANT, TenantChanges(jobs_at_once=1))
    bench.attempts.start(bench.wait().id, "w", 30)
    bench.wait()
    assert not bench.runs.gives_way()
    assert bench.runs.start(job.id, "w", 30).job_id == job.id


def test_a_lost_worker_costs_an_attempt_and_its_late_figures_are_refused(bench: Bench) -> None:
    job = bench.finish()
    bench.add(job)
    for number in range(1, MAX_ATTEMPTS + 1):
        run = bench.runs.start(job.id, "w", 30)
        assert (run.attempt, run.is_last) == (number, number == MAX_ATTEMPTS)
        with bench.all.write() as session:
            take_back_runs(session, utc_now())
        bench.runs.renew(run, 30)
        with bench.all.write() as session:
            take_back_runs(session, utc_now() + timedelta(seconds=60))
        with pytest.raises(StaleAttemptError):
            bench.runs.measure(run, Comparison(1, 1.0))
    (shown,) = bench.shown()
    assert (shown.state, shown.code) == ("dropped", "worker_lost")
    assert bench.shadows.get("ours").dropped == 1


def test_what_waits_for_a_day_is_dropped(bench: Bench) -> None:
    bench.add(bench.finish())
    with bench.all.write() as session:
        take_back_runs(session, utc_now() + LONGEST_WAIT)
    (shown,) = bench.shown()
    assert (shown.state, shown.code) == ("dropped", "busy")


def test_a_deleted_job_takes_what_is_still_to_come_along_and_leaves_figures(bench: Bench) -> None:
    measured, waiting = bench.finish(), bench.finish()
    for job in (measured, waiting):
        bench.add(job)
    bench.runs.measure(bench.runs.start(measured.id, "w", 30), Comparison(2, 0.9))
    run = bench.runs.start(waiting.id, "w", 30)
    for job in (measured, waiting):
        delete_job(bench.database, bench.store, job.id)
    with pytest.raises(StaleAttemptError):
        bench.runs.measure(run, Comparison(1, 1.0))
    assert [shown.job_id for shown in bench.shown()] == [measured.id]
    assert bench.shadows.get("ours").figures.jobs == 1


def test_a_deleted_candidate_ends_it_and_leaves_figures(bench: Bench) -> None:
    job = bench.finish()
    bench.add(job)
    bench.runs.measure(bench.runs.start(job.id, "w", 30), Comparison(2, 0.9))
    delete_version(bench.database, "walls", 2)
    assert not bench.add(bench.finish())
    shadow = bench.shadows.get("ours")
    assert (shadow.state, shadow.figures.jobs) == ("candidate_missing", 1)


def test_another_candidate_begins_anew_and_another_share_goes_on(bench: Bench) -> None:
    job = bench.finish()
    bench.add(job)
    run = bench.runs.start(job.id, "w", 30)
    since = bench.shadows.get("ours").created_at
    assert bench.shadows.put("ours", NewShadow(candidate="walls@2", share=0.5)).created_at == since
    bench.runs.measure(run, Comparison(2, 0.9))
    assert bench.shadows.get("ours").figures.jobs == 1
    bench.registry.set_alias("ours", "walls@2")
    again = bench.shadows.put("ours", NewShadow(candidate="walls@1", share=1.0))
    assert (again.candidate, again.share, again.figures.jobs) == ("walls@1", 1.0, 0)
    assert bench.add(bench.finish())


def test_figures_are_of_what_the_name_meant_last(bench: Bench, dictionary_bytes: Bytes) -> None:
    for ratio in (0.5, 0.7):
        job = bench.finish()
        bench.add(job)
        bench.runs.measure(bench.runs.start(job.id, "w", 30), Comparison(1, ratio))
    with bench.store.writer(MODEL_PREFIX) as writer:
        writer.write(dictionary_bytes(3))
        bench.registry.publish("walls", writer.commit(), is_proven=True)
    bench.registry.set_alias("ours", "walls@3")
    job = bench.finish()
    bench.add(job)
    bench.runs.measure(bench.runs.start(job.id, "w", 30), Comparison(1, 1.5))
    figures = bench.shadows.get("ours").figures
    assert (figures.baseline, figures.jobs, figures.ratio) == ("walls@3", 1, 1.5)
    assert len(bench.shown()) == 3


def test_what_is_cleared_is_gone(bench: Bench) -> None:
    job = bench.finish()
    bench.add(job)
    run = bench.runs.start(job.id, "w", 30)
    bench.shadows.clear("ours")
    with pytest.raises(StaleAttemptError):
        bench.runs.renew(run, 30)
    with pytest.raises(ShadowNotFoundError):
        bench.shadows.get("ours")
    assert not bench.add(bench.finish())


@pytest.mark.parametrize(
    ("name", "candidate", "error"),
    [
        ("ours", "nowhere@1", ModelNotFoundError),
        ("nowhere", "walls@2", ModelNotFoundError),
        ("default-network", "walls@2", ModelKindError),
    ],
)
def test_what_can_not_take_the_place_is_refused(
    bench: Bench, name: str, candidate: str, error: type[Exception]
) -> None:
    operator = Registry(bench.all, bench.store)
    operator.publish_file("nets", ROOT / "quadpatch/shipped_models/general-residual@1.onnx")
    operator.set_alias("default-network", "nets@1")
    with pytest.raises(error):
        bench.shadows.put(name, NewShadow(candidate=candidate))


def test_another_tenant_sees_nothing_of_it(bench: Bench) -> None:
    job = bench.finish()
    bench.add(job)
    other = Shadows(bench.all.of("plant-south"), Registry(bench.all.of("plant-south"), bench.store))
    assert other.list_all().items == []
    with pytest.raises(ShadowNotFoundError):
        other.runs("ours", 10)


def test_the_dispatcher_puts_one_run_into_the_queue_when_nothing_waits(bench: Bench, settings: Settings) -> None:
    limits = TimeLimits(1e6, 1e6, 4096)
    with closing(TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)) as queue:
        jobs = [bench.finish() for _ in range(2)]
        for job in jobs:
            bench.add(job)
        waiting = bench.wait()
        assert reconcile(bench.all, queue, limits).enqueued_shadows == 0
        bench.attempts.start(waiting.id, "w", 600)
        assert reconcile(bench.all, queue, limits).enqueued_shadows == 1
        first = jobs[0].id
        assert shadow_entry(first, 1) in queue.entries()
        assert reconcile(bench.all, queue, limits).enqueued_shadows == 0
        bench.runs.start(first, "w", 30)
        with bench.all.write() as session:
            session.execute(update(ShadowRunRow).values(enqueued_at=None))
        assert reconcile(bench.all, queue, limits).enqueued_shadows == 0, "one runs at a time"
