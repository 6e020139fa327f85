"""A worker runs candidates on jobs that have their results, and nothing of it reaches the jobs."""

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from datetime import timedelta

import pytest
from sqlalchemy import select

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.shadow_tables import ShadowRunRow
from jobkit.database.tables import ReservationRow
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.models.lifetime import delete_version
from jobkit.models.registry import MODEL_PREFIX
from jobkit.models.resolution import resolve_method
from jobkit.settings import Settings
from jobkit.shadows.shadows import Shadows
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import Job, JobSpec, JobState, MeshProblem, NewShadow
from tests.integration.conftest import ply_bytes, punched_relief
from tests.worker.test_repairs import working
from worker.context import Context
from worker.jobs import run_job, run_shadow
from worker.shadows import measure, note_shadow

Bytes = Callable[[int], bytes]


@pytest.fixture
def context(settings: Settings, database: Database, store: ObjectStore, dictionary_bytes: Bytes) -> Iterator[Context]:
    """A worker, and a candidate beside what the alias `ours` means."""
    with working(settings, database, store) as context:
        for seed in (1, 2):
            with store.writer(MODEL_PREFIX) as writer:
                writer.write(dictionary_bytes(seed))
                context.registry.publish("walls", writer.commit(), is_proven=True)
        context.registry.set_alias("ours", "walls@1")
        Shadows(database, context.registry).put("ours", NewShadow(candidate="walls@2", share=1.0))
        yield context


def new_job(context: Context, data: bytes | None = None, model: str = "ours") -> Job:
    with context.store.writer("meshes") as writer:
        writer.write(data or ply_bytes(*punched_relief(24)))
        mesh = Meshes(context.database).add(writer.commit(), "scan.ply", "ply")[0]
    if mesh.state == "analysing":
        # An upload that is still to be analysed would come first.
        analysis = context.meshes.start_analysis(mesh.id, "w", 30)
        context.meshes.reject(analysis, MeshProblem(code="analysis_failed", message="not needed here"))
    method = {"method": "dictionary", "model": model}
    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": method, "output": {"preview": False}})
    return Jobs(context.database).create(NewJob(spec, resolve_method(context.registry, spec.method), 3))[0]


def row_of(context: Context, job: Job) -> ShadowRunRow:
    with context.database.read() as session:
        return session.scalars(select(ShadowRunRow).where(ShadowRunRow.job_id == job.id)).one()


def test_a_job_is_what_it_is_without_its_shadow(context: Context) -> None:
    job = new_job(context)
    run_job(job.id)
    done = context.jobs.get(job.id)
    assert done.state is JobState.SUCCEEDED
    assert row_of(context, job).state == "waiting"
    run_shadow(job.id)
    # The relief has no room for calibration holes, so there is nothing to compare.
    row = row_of(context, job)
    assert (row.state, row.code, row.ratio) == ("dropped", "not_calibrated", None)
    assert context.jobs.get(job.id) == done
    assert [event.type for event in context.jobs.events(job.id).items if event.type != "progress"][-1] == "succeeded"
    assert list(context.work_folder.iterdir()) == []
    with context.database.read() as session:
        assert session.scalars(select(ReservationRow)).all() == []


def test_a_low_disk_drops_the_run(context: Context) -> None:
    job = new_job(context)
    run_job(job.id)
    full = replace(context, settings=context.settings.model_copy(update={"disk_reserve_mb": 1 << 40}))
    measure(full, full.shadow_runs.start(job.id, "w", 30))
    row = row_of(context, job)
    assert (row.state, row.code) == ("dropped", "disk_low")


def test_a_machine_without_memory_to_spare_does_it_later(context: Context) -> None:
    job = new_job(context)
    run_job(job.id)
    machine = context.admission._machine.name
    with context.database.write() as session:
        until = utc_now() + timedelta(seconds=600)
        session.add(
            ReservationRow(worker="w-2", machine=machine, is_job=True, reserved_mb=1 << 30, used_mb=0, until=until)
        )
    run_shadow(job.id)
    row = row_of(context, job)
    assert (row.state, row.attempt, row.forgiven) == ("waiting", 1, 1)
    assert row.not_before is not None
    assert row.not_before > utc_now()


def test_a_run_gives_way_to_a_job_that_waits(context: Context) -> None:
    job = new_job(context, ply_bytes(*punched_relief(160)))
    run_job(job.id)
    run = context.shadow_runs.start(job.id, "w", 30)
    other = new_job(context, model="walls@1")
    measure(context, run)
    row = row_of(context, job)
    assert (row.state, row.attempt, row.forgiven) == ("waiting", 1, 1)
    run_shadow(job.id)
    assert row_of(context, job).attempt == 1, "it is not taken while a job waits"
    run_job(other.id)
    assert context.jobs.get(other.id).state is JobState.SUCCEEDED


def test_a_candidate_that_was_deleted_meanwhile_is_said(context: Context) -> None:
    job = new_job(context)
    run_job(job.id)
    delete_version(context.database, "walls", 2)
    run_shadow(job.id)
    row = row_of(context, job)
    assert (row.state, row.code) == ("dropped", "candidate_missing")


def test_an_outage_of_the_database_while_it_is_chosen_fails_nothing(
    context: Context, settings: Settings, caplog: pytest.LogCaptureFixture
) -> None:
    job = new_job(context)
    with closing(Database("postgresql+psycopg://nobody@127.0.0.1:1/none")) as away:
        note_shadow(replace(context, database=away), job.id, "default")
    assert "no candidate runs" in caplog.text
