"""A whole repair in this process, with a real engine: what its log, its trace and the sums of stages say of it."""

import logging
from collections.abc import Iterator
from contextlib import closing

import pytest
from opentelemetry.sdk.trace import TracerProvider
from opentelemetry.sdk.trace.export import SimpleSpanProcessor
from opentelemetry.sdk.trace.export.in_memory_span_exporter import InMemorySpanExporter
from sqlalchemy import select

from jobkit.database.session import Database
from jobkit.database.tables import StageRow
from jobkit.jobs.jobs import Jobs, NewJob
from jobkit.logs import _add_subject
from jobkit.meshes import Meshes
from jobkit.queue import TaskQueue
from jobkit.schema import Job, JobSpec, JobState, ResolvedModel
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.telemetry import Telemetry
from tests.integration.conftest import ply_bytes, punched_relief
from worker.context import Context, use_context
from worker.engine.client import ForkServer
from worker.jobs import run_job

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
