"""`repair`: a mesh file in, a mesh file out."""

import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, cast, get_args

from client.errors import ClientError, UsageError, WaitTimeoutError
from client.options import HoleChoice, MethodChoice, make_spec
from client.screen import Screen
from client.sdk import Client
from client.summary import paragraph
from client.transfers import sent_name
from jobkit.schema import Job, JobSpec, OutputFormat


@dataclass(frozen=True)
class Task:
    """What one `repair` is to do.

    Attributes
    ----------
    source, output : Path
    holes : HoleChoice
    method : MethodChoice
    rest : dict
        Further fields of the job spec.
    report, preview : Path, optional
        Where to put the report and the picture.
    timeout_s : float, optional
        How long to wait for the job.
    may_overwrite : bool
        Whether the repaired mesh may take the place of the scan.
    """

    source: Path
    output: Path
    holes: HoleChoice
    method: MethodChoice
    rest: dict[str, Any] = field(default_factory=dict)
    report: Path | None = None
    preview: Path | None = None
    timeout_s: float | None = None
    may_overwrite: bool = False


def repair(client: Client, screen: Screen, task: Task) -> Job:
    """Upload, start, wait, fetch; a job that nobody waits for any more is canceled.

    Raises
    ------
    ClientError
        Of every kind that the SDK knows.
    KeyboardInterrupt
        After the job has been canceled.
    """
    # A wrong option or path should show before a large file has been sent and an hour been spent on it.
    make_spec("0" * 64, task.holes, task.method, **task.rest)
    check_outputs(task)
    with screen.transfer("uploading") as progress:
        mesh = client.upload(task.source, progress)
    screen.say(f"{task.source.name}: {_size(mesh.size_bytes)} uploaded")
    spec = make_spec(mesh.id, task.holes, task.method, mesh_name=sent_name(task.source) or None, **task.rest)
    job = _run(client, screen, spec, task.timeout_s)
    _fetch(client, screen, task, job)
    return job


def check_outputs(task: Task) -> None:
    """Raise UsageError where an output has no folder, is one, or would overwrite another one or the scan."""
    _check_place(task.output)
    if is_same_file(task.output, task.source) and not task.may_overwrite:
        raise UsageError(f"{task.output} is the scan itself: name another file, or say --overwrite")
    taken = [task.source, task.output]
    for path in (task.report, task.preview):
        if path is None:
            continue
        _check_place(path)
        if any(is_same_file(path, other) for other in taken):
            raise UsageError(f"{path} is named twice: mesh, report and preview need files of their own")
        taken.append(path)


def _check_place(path: Path) -> None:
    if path.is_dir():
        raise UsageError(f"{path} is a folder, not a file to write")
    if not path.parent.is_dir():
        raise UsageError(f"{path} can't be written: there is no folder {path.parent}")


def is_same_file(one: Path, other: Path) -> bool:
    """Tell whether two paths lead to one file: by another spelling, a symbolic link or a hard link."""
    try:
        return one.samefile(other)
    except OSError:
        # One of them is not there yet.
        return one.resolve() == other.resolve()


def format_of(output: Path) -> OutputFormat:
    """Return the format that the suffix of an output asks for; raise UsageError where it asks for none."""
    suffix = output.suffix.lower().lstrip(".")
    if suffix not in get_args(OutputFormat):
        raise UsageError(
            f"{output} does not end in one of {', '.join(get_args(OutputFormat))}; rename it or give --format"
        )
    return cast(OutputFormat, suffix)


def _run(client: Client, screen: Screen, spec: JobSpec, timeout_s: float | None) -> Job:
    job = client.create_job(spec)
    screen.say(f"job {job.id} accepted")
    with _canceled_on_the_way_out(client, screen, job), screen.repair() as on_change:
        return client.wait(job.id, on_change, timeout_s)


@contextmanager
def _canceled_on_the_way_out(client: Client, screen: Screen, job: Job) -> Iterator[None]:
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


def _fetch(client: Client, screen: Screen, task: Task, job: Job) -> None:
    """Fetch the mesh first: it is there whatever happens to the files that come with it."""
    with screen.transfer("downloading") as progress:
        client.download(job, "result", task.output, progress)
    written = [task.output]
    if task.report is not None:
        client.download(job, "report", task.report)
        written.append(task.report)
    if task.preview is not None and _is_fetched(client, screen, job, "preview", task.preview):
        written.append(task.preview)
    with tempfile.TemporaryDirectory() as folder:
        report = task.report or Path(folder) / "report.json"
        if task.report is not None or _is_fetched(client, screen, job, "report", report):
            screen.tell(paragraph(task.source.name, job, json.loads(report.read_text(encoding="utf-8"))))
    for path in written:
        screen.say(f"wrote {path}", style="green")


def _is_fetched(client: Client, screen: Screen, job: Job, role: Literal["report", "preview"], path: Path) -> bool:
    """Fetch a file that is optional: without it the repair has succeeded all the same."""
    try:
        client.download(job, role, path)
    except (ClientError, OSError) as error:
        screen.complain(f"there is no {role}: {error}")
        return False
    return True


def _size(n_bytes: int) -> str:
    return f"{n_bytes / 1e6:.1f} MB" if n_bytes >= 1e5 else f"{n_bytes / 1e3:.1f} kB"
