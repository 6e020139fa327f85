"""`repair` and the other tasks: a mesh file in, a mesh file out."""

import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast, get_args

from quadpatch_client.closeups import check_closeups_folder
from quadpatch_client.errors import (
    ClientError,
    JobFailedError,
    RefusedError,
    UnreachableError,
    UsageError,
    WaitTimeoutError,
)
from quadpatch_client.interruption import HeldInterrupt
from quadpatch_client.options import HoleChoice, MethodChoice
from quadpatch_client.outputs import check_place, is_same_file, is_stream, shown
from quadpatch_client.screen import Screen
from quadpatch_client.wording import suggestion
from quadpatch_rules.option_words import OutputFormat

if TYPE_CHECKING:
    from quadpatch_client.schema import Job
    from quadpatch_client.sdk import Client

# A mesh that can't be read fails here; its analysis may still be waiting for a worker.
_FIRST_STAGE = "read"
_ANALYSIS_S = 60.0
_SPOKEN = {"html_report": "HTML report", "pdf_report": "PDF"}


@dataclass(frozen=True)
class Task:
    """What one command is to do: `repair`, or that of another task.

    Attributes
    ----------
    source, output : Path
    holes : HoleChoice
    method : MethodChoice
    rest : dict
        Further fields of the job spec.
    report, preview : Path, optional
        Where to put the report and the picture.
    closeups : Path, optional
        Folder for a picture of each chosen hole.
    html, pdf : Path, optional
        Where to put the report as a page, and that page printed.
    timeout_s : float, optional
        How long to wait for the job.
    may_overwrite : bool
        Whether the repaired mesh may take the place of the scan.
    again : bool
        Whether a new job is started although the same one is on its way or has a result.
    reference : Path, optional
        A clean scan to learn from, which is uploaded like the source.
    """

    source: Path
    output: Path
    holes: HoleChoice = field(default_factory=HoleChoice)
    method: MethodChoice = field(default_factory=MethodChoice)
    rest: dict[str, Any] = field(default_factory=dict)
    report: Path | None = None
    preview: Path | None = None
    closeups: Path | None = None
    html: Path | None = None
    pdf: Path | None = None
    timeout_s: float | None = None
    may_overwrite: bool = False
    again: bool = False
    reference: Path | None = None


@dataclass(frozen=True)
class Files:
    """Where the files of a finished job go; `name` is that of the mesh, for people."""

    name: str
    output: Path
    report: Path | None = None
    preview: Path | None = None
    closeups: Path | None = None
    html: Path | None = None
    pdf: Path | None = None

    def check(self, *others: Path) -> None:
        """Raise UsageError where one can't be written, or would overwrite another one or one of the others."""
        check_place(self.output)
        check_apart([*others, self.output], [self.report, self.preview, self.html, self.pdf])
        if self.closeups is not None:
            files = [self.output, self.report, self.preview, self.html, self.pdf, *others]
            check_closeups_folder(self.closeups, [path for path in files if path is not None])


def repair(client: "Client", screen: Screen, task: Task) -> "Job":
    """Upload, start, wait, fetch; a job is canceled when the wait for it ends early.

    Raises
    ------
    ClientError
        Of every kind that the SDK knows.
    KeyboardInterrupt
        After the job has been canceled.
    """
    from quadpatch_client.spec import make_spec  # noqa: PLC0415  loads the wire schema, which --help does without
    from quadpatch_client.transfers import label_of, sent_name  # noqa: PLC0415  loads HTTP

    # A wrong option or path should show before a large file has been sent and an hour been spent on it.
    make_spec("0" * 64, task.holes, task.method, **_rest(task, "0" * 64))
    check_outputs(task)
    if task.pdf is not None:
        check_renderer(client)
    mesh_id = _upload(client, screen, task.source)
    rest = _rest(task, "" if task.reference is None else _upload(client, screen, task.reference))
    named = {"mesh_name": sent_name(task.source) or None, **rest, "label": rest.get("label") or label_of(task.source)}
    spec = make_spec(mesh_id, task.holes, task.method, **named)
    with HeldInterrupt(screen.complain) as interrupt:
        with _model_suggested(client, task.method.model):
            job = client.create_job(spec, runs_anew=True) if task.again else client.create_job_once(spec)
        job = _wait(client, screen, job, task.timeout_s, interrupt)
    fetch(client, screen, _files(task), job)
    return job


@contextmanager
def _model_suggested(client: "Client", model: str | None) -> Iterator[None]:
    """Say, where the service knows no such model, which one may be meant."""
    try:
        yield
    except RefusedError as error:
        if error.problem.code != "model_not_found" or model is None:
            raise
        known = client.models()
        names = [*(m.name for m in known.models), *(a.alias for a in known.aliases), "self", "smooth"]
        hint = "; say --method smooth" if model == "smooth" else suggestion(model.partition("@")[0], names)
        raise RefusedError(error.problem.model_copy(update={"detail": error.problem.detail + hint})) from error


def _upload(client: "Client", screen: Screen, path: Path) -> str:
    with screen.transfer("uploading") as progress:
        mesh = client.upload(path, progress)
    screen.say(f"{path.name}: {_size(mesh.size_bytes)} uploaded")
    return mesh.id


def _rest(task: Task, reference_id: str) -> dict[str, Any]:
    """Return the further fields of the job spec, with the id that the reference has got."""
    if task.reference is None:
        return task.rest
    return {**task.rest, "denoise": {**task.rest.get("denoise", {}), "reference": reference_id}}


def check_renderer(client: "Client") -> None:
    """Raise UsageError where the service prints no PDFs: that should show before a large file has been sent."""
    if not client.limits().pdf_reports:
        raise UsageError("the service prints no PDFs; leave out --pdf, take --html, and print the page in a browser")


def check_outputs(task: Task) -> None:
    """Raise UsageError where an output has no folder, is one, or would overwrite another one or the scan."""
    check_place(task.output)
    if is_same_file(task.output, task.source) and not task.may_overwrite:
        raise UsageError(f"{task.output} is the scan itself: name another file, or say --overwrite")
    if task.reference is not None and is_same_file(task.output, task.reference):
        raise UsageError(f"{task.output} is the reference itself: name another file")
    _files(task).check(*[path for path in (task.source, task.reference) if path is not None])


def _files(task: Task) -> Files:
    return Files(task.source.name, task.output, task.report, task.preview, task.closeups, task.html, task.pdf)


def check_apart(taken: list[Path], others: list[Path | None]) -> None:
    """Raise UsageError where one of the other outputs can't be written, or is one that is taken."""
    seen = list(taken)
    for path in others:
        if path is None:
            continue
        check_place(path)
        if any(is_same_file(path, other) for other in seen):
            raise UsageError(f"{path} is named twice: mesh, report and preview need files of their own")
        seen.append(path)


def format_of(output: Path) -> OutputFormat | None:
    """Return the format that the suffix of an output asks for; None, that of the scan, for a stream.

    Raises
    ------
    UsageError
        If the suffix asks for none.
    """
    if is_stream(output):
        return None
    suffix = output.suffix.lower().lstrip(".")
    if suffix not in get_args(OutputFormat):
        raise UsageError(
            f"{output} does not end in one of {', '.join(get_args(OutputFormat))}; rename it or give --format"
        )
    return cast(OutputFormat, suffix)


def _wait(client: "Client", screen: Screen, job: "Job", timeout_s: float | None, interrupt: HeldInterrupt) -> "Job":
    from quadpatch_client.schema import JobState  # noqa: PLC0415  see repair

    screen.say(f"job {job.id} " + ("accepted" if job.state is JobState.QUEUED else "is there already"))
    try:
        with _canceled_on_the_way_out(client, screen, job), screen.repair() as on_change:
            interrupt.release()
            return client.wait(job.id, on_change, timeout_s)
    except JobFailedError as error:
        _raise_for_mesh(client, error)
        raise
    except UnreachableError:
        screen.complain(f"job {job.id} goes on without this command; `fetch {job.id} -o FILE` gets what it makes")
        raise


def _raise_for_mesh(client: "Client", failed: JobFailedError) -> None:
    """Raise MeshRejectedError where the mesh is at fault.

    A bad mesh ends a job that was there before the analysis, and refuses one that comes after it: for scripts it has
    to be one and the same.
    """
    if failed.job.error is None or failed.job.error.stage not in (None, _FIRST_STAGE):
        return
    try:
        client.wait_for_mesh(failed.job.mesh_id, _ANALYSIS_S)
    except (WaitTimeoutError, RefusedError):
        return  # the job has said why


@contextmanager
def _canceled_on_the_way_out(client: "Client", screen: Screen, job: "Job") -> Iterator[None]:
    try:
        yield
    except (KeyboardInterrupt, WaitTimeoutError):
        try:
            canceled = client.cancel(job.id)
        except ClientError as error:
            screen.complain(f"job {job.id} could not be canceled and may still be running: {error}")
        else:
            screen.say(f"job {job.id}: {canceled.state.value}")
        raise


def fetch(client: "Client", screen: Screen, files: Files, job: "Job") -> None:
    """Fetch the mesh first: it is there whatever happens to the files that come with it."""
    from quadpatch_client.summary import paragraph  # noqa: PLC0415  see repair

    with screen.transfer("downloading") as progress:
        client.download(job, "result", files.output, progress)
    written = [files.output]
    if files.report is not None:
        client.download(job, "report", files.report)
        written.append(files.report)
    if files.preview is not None and _is_fetched(client, screen, job, "preview", files.preview):
        written.append(files.preview)
    if files.html is not None and _is_fetched(client, screen, job, "html_report", files.html):
        written.append(files.html)
    if files.pdf is not None and _is_fetched(client, screen, job, "pdf_report", files.pdf):
        written.append(files.pdf)
    if files.closeups is not None:
        written += _fetch_closeups(client, screen, job, files.closeups)
    with tempfile.TemporaryDirectory() as folder:
        # What went into a stream can't be read again.
        is_kept = files.report is not None and not is_stream(files.report)
        report = files.report if files.report is not None and is_kept else Path(folder) / "report.json"
        if is_kept or _is_fetched(client, screen, job, "report", report):
            screen.tell(paragraph(files.name, job, json.loads(report.read_text(encoding="utf-8"))))
    for path in written:
        screen.say(f"wrote {shown(path)}", style="green")


def _is_fetched(
    client: "Client",
    screen: Screen,
    job: "Job",
    role: Literal["report", "preview", "html_report", "pdf_report"],
    path: Path,
) -> bool:
    """Fetch a file that is optional: without it the repair has succeeded all the same."""
    try:
        client.download(job, role, path)
    except (ClientError, OSError) as error:
        screen.complain(f"there is no {_SPOKEN.get(role, role)}: {error}")
        return False
    return True


def _fetch_closeups(client: "Client", screen: Screen, job: "Job", folder: Path) -> list[Path]:
    """Fetch close-ups, which are optional too; return what was written."""
    try:
        return client.download_closeups(job, folder)
    except (ClientError, OSError) as error:
        screen.complain(f"there are no close-ups: {error}")
        return []


def _size(n_bytes: int) -> str:
    return f"{n_bytes / 1e6:.1f} MB" if n_bytes >= 1e5 else f"{n_bytes / 1e3:.1f} kB"
