"""The end of an attempt when the database fails, or another process ends it first.

Also tests `worker.outcomes`.
"""

import io
import json
import zipfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest
from sqlalchemy import select, update
from sqlalchemy.orm import Session

from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow
from jobkit.errors import DatabaseUnavailableError, StaleAttemptError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import MAX_ANALYSES, Meshes
from jobkit.queue import TaskQueue
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore, result_key
from jobkit.storage.open import open_store
from quadpatch_client.schema import Job, JobSpec, JobState, MeshState, ResolvedModel
from tests.integration.conftest import ply_bytes, punched_relief
from tests.quadpatch.html_report.pages import Page
from tests.worker.test_pdf import CHROMIUM, needs_chromium
from worker.context import Context, use_context
from worker.engine.client import ForkServer
from worker.jobs import inspect_mesh, run_job
from worker.repairs import _heartbeat_calls


class Forgetful(Database):
    """A database that commits, and is gone before it has said so: once, when `forgets` says so."""

    def __init__(self, url: str, forgets: Callable[[Session], bool]) -> None:
        super().__init__(url)
        self._forgets = forgets
        self.has_forgotten = False

    @contextmanager
    def write(self) -> Iterator[Session]:
        with super().write() as session:
            yield session
        with self.read() as session:
            is_due = not self.has_forgotten and self._forgets(session)
        if is_due:
            self.has_forgotten = True
            raise DatabaseUnavailableError("the connection was lost")


class Refusing(Database):
    """A database that is away for the first so many writes."""

    def __init__(self, url: str) -> None:
        super().__init__(url)
        self.refusals = 0

    @contextmanager
    def write(self) -> Iterator[Session]:
        if self.refusals:
            self.refusals -= 1
            raise DatabaseUnavailableError("the database does not answer")
        with super().write() as session:
            yield session


@contextmanager
def working(
    settings: Settings, database: Database, store: ObjectStore, engine: str = "worker.engine.main"
) -> Iterator[Context]:
    queue = TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, settings.job_time_limit_s)
    with closing(queue), closing(database), ForkServer(1, engine) as fork_server:
        context = Context("w-1", settings, database, store, queue, fork_server, 1)
        context.work_folder.mkdir(parents=True)
        with use_context(context):
            yield context


def new_job(context: Context, *, preview: bool = False, closeups: bool = False, html_report: bool = False) -> Job:
    with context.store.writer("meshes") as writer:
        writer.write(ply_bytes(*punched_relief(20, 1)))
        stored = writer.commit()
    mesh = Meshes(context.database).add(stored, "scan.ply", "ply")[0]
    output = {"preview": preview, "closeups": closeups, "html_report": html_report}
    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": {"method": "smooth"}, "output": output})
    new = NewJob(spec, ResolvedModel(requested="smooth", kind="none"), 3, asked_by="station 4")
    return Jobs(context.database).create(new)[0]


def has_result(session: Session) -> bool:
    return any(JobState(state).has_result for state in session.scalars(select(JobRow.state)))


def test_a_result_whose_publication_was_not_confirmed_keeps_its_files(
    settings: Settings, database: Database, store: ObjectStore
) -> None:
    forgetful = Forgetful(settings.effective_database_url, has_result)
    with working(settings, forgetful, store) as context:
        job = new_job(context)
        run_job(job.id)
        ended = context.jobs.get(job.id)
    assert forgetful.has_forgotten
    assert ended.state.has_result
    assert ended.result is not None
    kept = {listed.key for listed in store.keys("results")}
    assert kept == {result_key(job.id, 1, file.name) for file in ended.result.files}


def test_a_job_that_asks_for_close_ups_has_one_of_each_chosen_hole(settings: Settings, store: ObjectStore) -> None:
    with working(settings, Database(settings.effective_database_url), store) as context:
        job = new_job(context, closeups=True)
        run_job(job.id)
        ended = context.jobs.get(job.id)
    assert ended.state is JobState.SUCCEEDED
    assert ended.result is not None
    assert [file.role for file in ended.result.files] == ["result", "report", "closeups"]
    assert ended.links.closeups == f"/v1/jobs/{job.id}/closeups.zip"
    packed = b"".join(store.read(result_key(job.id, 1, "closeups.zip")))
    report = json.loads(b"".join(store.read(result_key(job.id, 1, "report.json"))))
    filled = [f"hole_{hole['id']}.png" for hole in report["holes"] if hole["verdict"].startswith("filled")]
    assert zipfile.ZipFile(io.BytesIO(packed)).namelist() == filled
    assert report["stages"][-1]["name"] == "closeups"


def test_a_job_that_asks_for_a_page_has_one_that_names_job_and_files(settings: Settings, store: ObjectStore) -> None:
    with working(settings, Database(settings.effective_database_url), store) as context:
        job = new_job(context, html_report=True)
        run_job(job.id)
        ended = context.jobs.get(job.id)
        mesh = context.meshes.get(job.mesh_id)
    assert ended.state is JobState.SUCCEEDED
    assert ended.result is not None
    assert [file.role for file in ended.result.files] == ["result", "report", "html_report"]
    assert ended.links.html_report == f"/v1/jobs/{job.id}/report.html"
    page = Page(b"".join(store.read(result_key(job.id, 1, "report.html"))).decode())
    report = json.loads(b"".join(store.read(result_key(job.id, 1, "report.json"))))
    facts, repaired = report["provenance"], ended.result.file("result")
    assert repaired is not None
    assert (facts["source"]["sha256"], facts["output"]["sha256"]) == (mesh.id, repaired.sha256)
    assert (facts["request"]["job_id"], facts["request"]["asked_by"]) == (job.id, "station 4")
    assert json.loads(page.by_id("report-json").text) == {**report, "stages": report["stages"][:-1]}
    assert len(page.all("img")) > 1
    assert report["stages"][-1]["name"] == "html_report"


@needs_chromium
def test_a_worker_with_a_renderer_leaves_the_page_as_a_pdf_too(settings: Settings, store: ObjectStore) -> None:
    settings = settings.model_copy(update={"pdf_renderer": CHROMIUM})
    with working(settings, Database(settings.effective_database_url), store) as context:
        job, plain = new_job(context, html_report=True), new_job(context)
        for job_id in (job.id, plain.id):
            run_job(job_id)
        ended, without = context.jobs.get(job.id), context.jobs.get(plain.id)
    assert ended.result is not None
    assert [file.role for file in ended.result.files] == ["result", "report", "html_report", "pdf_report"]
    assert ended.result.files[-1].media_type == "application/pdf"
    assert ended.result.warnings == []
    assert ended.links.pdf_report == f"/v1/jobs/{job.id}/report.pdf"
    assert b"".join(store.read(result_key(job.id, 1, "report.pdf"))).startswith(b"%PDF-")
    assert without.links.pdf_report is None


def test_the_second_repair_of_a_mesh_takes_what_the_first_one_found_out_by_calibration(
    settings: Settings, store: ObjectStore, caplog: pytest.LogCaptureFixture
) -> None:
    with working(settings, Database(settings.effective_database_url), store) as context:
        reports, meshes = [], []
        for step in range(4):
            job = new_job(context)
            run_job(job.id)
            assert context.jobs.get(job.id).state is JobState.SUCCEEDED
            reports.append(json.loads(b"".join(store.read(result_key(job.id, 1, "report.json")))))
            meshes.append(b"".join(store.read(result_key(job.id, 1, "repaired.ply"))))
            kept = context.meshes.calibrations(job.mesh_id)
            assert kept is not None
            if step == 1:  # a row that says something else
                context.meshes.keep_calibrations(job.mesh_id, kept.replace('"belief": ', '"belief": -'))
    assert [report["calibration"].pop("reused") for report in reports] == [False, True, False, True]
    assert "a kept calibration is left out" in caplog.text
    assert len(set(meshes)) == 1
    assert all(report["holes"] == reports[0]["holes"] for report in reports)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"preview": True}, "there is no picture"),
        ({"closeups": True}, "there are no close-ups"),
        ({"html_report": True}, "there is no HTML report"),
    ],
)
def test_a_job_whose_engine_is_killed_while_it_draws_has_its_mesh_and_a_warning(
    settings: Settings, store: ObjectStore, monkeypatch: pytest.MonkeyPatch, asked: dict[str, bool], words: str
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent))
    database = Database(settings.effective_database_url)
    with working(settings, database, store, "engine_killed_while_drawing") as context:
        job = new_job(context, **asked)
        run_job(job.id)
        ended = context.jobs.get(job.id)
    assert ended.state is JobState.SUCCEEDED_WITH_WARNINGS
    assert ended.attempt == 1
    assert ended.result is not None
    assert ended.result.warnings == [f"{words}: the engine was ended by SIGSEGV"]
    assert [file.role for file in ended.result.files] == ["result", "report"]
    report = json.loads(b"".join(store.read(result_key(job.id, 1, "report.json"))))
    assert report["warnings"] == ended.result.warnings


def test_a_mesh_is_not_rejected_for_a_store_that_is_away(settings: Settings, tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    database = Database(settings.effective_database_url)
    with working(settings, database, open_store(f"file://{disk}")) as context:
        mesh_id = new_job(context).mesh_id
        disk.rename(tmp_path / "unmounted")
        for _ in range(MAX_ANALYSES + 1):
            inspect_mesh(mesh_id)
            with database.write() as session:
                session.execute(update(MeshRow).values(lease_until=None))
        assert context.meshes.get(mesh_id).state is MeshState.ANALYSING
        (tmp_path / "unmounted").rename(disk)
        inspect_mesh(mesh_id)
        assert context.meshes.get(mesh_id).state is MeshState.READY


def test_a_task_waits_for_a_database_that_is_away(settings: Settings, store: ObjectStore) -> None:
    refusing = Refusing(settings.effective_database_url)
    with working(settings, refusing, store) as context:
        job = new_job(context)
        refusing.refusals = 2
        run_job(job.id)
        assert context.jobs.get(job.id).state.has_result
    assert refusing.refusals == 0


def test_an_attempt_that_another_process_ended_is_noticed_before_its_next_heartbeat(
    settings: Settings, database: Database, store: ObjectStore
) -> None:
    with working(settings, Database(settings.effective_database_url), store) as context:
        job = new_job(context)
        started = Attempts(database).start(job.id, "w-1", 30)
        heartbeat_calls = _heartbeat_calls(context, started)
        assert not heartbeat_calls.is_cancel_requested()
        context.jobs.request_cancel(job.id)
        assert heartbeat_calls.is_cancel_requested()
        Attempts(database).acknowledge_cancel(started.attempt)
        with pytest.raises(StaleAttemptError):
            heartbeat_calls.is_cancel_requested()
