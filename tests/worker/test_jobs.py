"""A whole repair in this process, with a real engine: what its log, its trace and the sums of stages say of it.

Also tests `worker.memory`.
"""

import logging
import socket
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from datetime import timedelta

import pytest
from opentelemetry.sdk.trace import TracerProvider
from opentelemetry.sdk.trace.export import SimpleSpanProcessor
from opentelemetry.sdk.trace.export.in_memory_span_exporter import InMemorySpanExporter
from sqlalchemy import delete, select, update

from jobkit.access.tenants import Tenants
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, ReservationRow, StageRow
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.logs import _add_subject
from jobkit.meshes import Meshes
from jobkit.queue import TaskQueue, job_entry
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.telemetry import Telemetry
from quadpatch_client.schema import Job, JobError, JobSpec, JobState, ResolvedModel, TenantChanges
from tests.integration.conftest import ply_bytes, punched_relief
from worker.context import Context, use_context
from worker.engine.client import ForkServer
from worker.jobs import run_job
from worker.memory import memory_given_back, reserve_memory, submit_fitting
from worker.places import place_given_back

TRACE = "0af7651916cd43dd8448eb211c80319c"
SENT = f"00-{TRACE}-b7ad6b7169203331-01"


@pytest.fixture
def exporter() -> InMemorySpanExporter:
    return InMemorySpanExporter()


@pytest.fixture
def context(
    settings: Settings, database: Database, store: ObjectStore, exporter: InMemorySpanExporter
) -> Iterator[Context]:
    provider = TracerProvider()
    provider.add_span_processor(SimpleSpanProcessor(exporter))
    queue = TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, settings.job_time_limit_s)
    with closing(queue), ForkServer(1) as fork_server:
        context = Context("w-1", settings, database, store, queue, fork_server, 1, telemetry=Telemetry(provider))
        context.work_folder.mkdir(parents=True)
        with use_context(context):
            yield context


def new_job(context: Context, data: bytes) -> Job:
    with context.store.writer("meshes") as writer:
        writer.write(data)
        stored = writer.commit()
    mesh = Meshes(context.database).add(stored, "scan.ply", "ply")[0]
    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": {"method": "smooth"}, "output": {"preview": False}})
    new = NewJob(spec, ResolvedModel(requested="smooth", kind="none"), 3, request_id="station-4.17", traceparent=SENT)
    return Jobs(context.database).create(new)[0]


def test_a_repair_goes_on_with_the_trace_of_its_request_and_has_a_span_for_each_stage(
    context: Context, exporter: InMemorySpanExporter
) -> None:
    job = new_job(context, ply_bytes(*punched_relief(24)))
    run_job(job.id)
    assert context.jobs.get(job.id).state is JobState.SUCCEEDED
    spans = {span.name: span for span in exporter.get_finished_spans()}
    attempt = spans.pop("attempt")
    assert attempt.parent is not None
    assert f"{attempt.parent.trace_id:032x}-{attempt.parent.span_id:016x}" == SENT[3:-3]
    assert attempt.attributes == {
        "quadpatch.job_id": job.id,
        "quadpatch.attempt": 1,
        "quadpatch.task": "fill",
        "quadpatch.state": "succeeded",
    }
    assert {"stage fill", "stage judge", "stage write"} <= spans.keys()
    assert all(span.parent is not None and span.parent.span_id == attempt.context.span_id for span in spans.values())
    with context.database.read() as session:
        summed = {
            row.stage: row.seconds for row in session.scalars(select(StageRow).where(StageRow.method == "smooth"))
        }
    assert {f"stage {stage}" for stage in summed} >= spans.keys() - {"stage preview"}
    assert attempt.start_time is not None
    assert attempt.end_time is not None
    assert sum(summed.values()) < (attempt.end_time - attempt.start_time) / 1e9


def test_every_line_about_a_job_names_it_its_attempt_and_its_request(
    context: Context, exporter: InMemorySpanExporter, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.handler.addFilter(_add_subject)
    job = new_job(context, b"no mesh at all")
    with caplog.at_level(logging.INFO):
        run_job(job.id)
    assert context.jobs.get(job.id).state is JobState.FAILED
    subjects = [record.subject for record in caplog.records if record.name.startswith("quadpatch.worker")]  # type: ignore[attr-defined]
    assert len(subjects) >= 2
    assert all(subject == {"job_id": job.id, "attempt": 1, "request_id": "station-4.17"} for subject in subjects)
    (attempt,) = [span for span in exporter.get_finished_spans() if span.name == "attempt"]
    assert not attempt.status.is_ok
    assert attempt.attributes is not None
    assert attempt.attributes["quadpatch.state"] == "failed"


def reservations(context: Context) -> list[ReservationRow]:
    with context.database.read() as session:
        return list(session.scalars(select(ReservationRow)))


@pytest.mark.parametrize("is_mesh", [True, False])
def test_a_job_gives_back_its_memory_however_it_ends(context: Context, is_mesh: bool) -> None:
    job = new_job(context, ply_bytes(*punched_relief(24)) if is_mesh else b"no mesh at all")
    run_job(job.id)
    ended = context.jobs.get(job.id)
    assert ended.state is (JobState.SUCCEEDED if is_mesh else JobState.FAILED)
    assert (ended.result is not None and 50 < (ended.result.peak_memory_mb or 0) < 1024) is is_mesh
    assert reservations(context) == []


def test_the_end_of_a_task_submits_the_jobs_that_waited_for_its_memory(context: Context) -> None:
    mesh_bytes = ply_bytes(*punched_relief(24))
    first, second = new_job(context, mesh_bytes), new_job(context, mesh_bytes)
    machine = socket.gethostname()
    with context.database.write() as session:
        all_mb = 1 << 30
        until = utc_now() + timedelta(seconds=600)
        row = ReservationRow(worker="w-2", machine=machine, is_job=True, reserved_mb=all_mb, used_mb=0, until=until)
        session.add(row)
    for job in (first, second):
        run_job(job.id)
        assert context.jobs.get(job.id).waits_for == "memory"
    assert context.queue.entries() == set()
    with context.database.write() as session:
        session.execute(delete(ReservationRow))
        session.execute(update(JobRow).values(not_before=utc_now()))
    run_job(second.id)
    assert context.jobs.get(second.id).state is JobState.SUCCEEDED
    assert context.queue.entries() == {job_entry(first.id, 1)}
    submit_fitting(context)
    assert context.queue.depth() == 1


def test_the_end_of_a_job_submits_the_next_one_of_a_tenant_that_ran_what_it_may(context: Context) -> None:
    Tenants(context.database).change("default", TenantChanges(jobs_at_once=1))
    mesh_bytes = ply_bytes(*punched_relief(24))
    first, second, third = (new_job(context, mesh_bytes) for _ in range(3))
    attempt = context.attempts.start(first.id, "w-2", 600).attempt
    # The entries of both start nothing meanwhile, and are gone then.
    for job in (second, third):
        run_job(job.id)
        assert context.jobs.get(job.id).attempt == 0
    assert context.queue.entries() == set()
    with place_given_back(context, "default"):
        pass
    assert context.queue.entries() == set()
    context.attempts.fail(attempt, JobError(code="engine_crashed", message="it died", retryable=True))
    run_job(second.id)
    assert context.jobs.get(second.id).state is JobState.SUCCEEDED
    assert context.queue.entries() == {job_entry(third.id, 1)}
    with place_given_back(context, "default"):
        pass
    assert context.queue.depth() == 1


def test_an_outage_of_the_queue_keeps_no_task_from_ending(context: Context, caplog: pytest.LogCaptureFixture) -> None:
    job = new_job(context, ply_bytes(*punched_relief(24)))
    with context.database.write() as session:
        times = {"memory_wait_since": utc_now(), "not_before": utc_now(), "needed_memory_mb": 1}
        session.execute(update(JobRow).where(JobRow.id == job.id).values(times))
    with (
        closing(TaskQueue("redis://127.0.0.1:1/0", "none", 60)) as away,
        memory_given_back(replace(context, queue=away)),
    ):
        reserve_memory(context, 300)
        assert [row.reserved_mb for row in reservations(context)] == [300]
    assert reservations(context) == []
    assert "submitted later" in caplog.text
