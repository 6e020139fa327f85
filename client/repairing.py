"""`repair`: a mesh file in, a mesh file out."""

import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast, get_args

from client.errors import ClientError, UsageError, WaitTimeoutError
from client.options import HoleChoice, MethodChoice, make_spec
from client.screen import Screen
from client.sdk import Client
from client.summary import paragraph
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
    """

    source: Path
    output: Path
    holes: HoleChoice
    method: MethodChoice
    rest: dict[str, Any] = field(default_factory=dict)
    report: Path | None = None
    preview: Path | None = None
    timeout_s: float | None = None


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
    job = _run(client, screen, make_spec(mesh.id, task.holes, task.method, **task.rest), task.timeout_s)
    _fetch(client, screen, task, job)
    return job


def check_outputs(task: Task) -> None:
    """Raise UsageError where an output has no folder, is one, or would overwrite another one or the scan."""
    taken: set[Path] = set()
    for path in (task.output, task.report, task.preview):
        if path is None:
            continue
        if path.is_dir():
            raise UsageError(f"{path} is a folder, not a file to write")
        if not path.parent.is_dir():
            raise UsageError(f"{path} can't be written: there is no folder {path.parent}")
        if path.resolve() in taken:
            raise UsageError(f"{path} is named twice: mesh, report and preview need files of their own")
        # The repaired mesh may take the place of the scan; report and preview may not.
        taken |= {path.resolve(), task.source.resolve()}


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
    with tempfile.TemporaryDirectory() as folder:
        report = task.report or Path(folder) / "report.json"
        client.download(job, "report", report)
        with screen.transfer("downloading") as progress:
            client.download(job, "result", task.output, progress)
        if task.preview is not None:
            client.download(job, "preview", task.preview)
        screen.tell(paragraph(task.source.name, job, json.loads(report.read_text(encoding="utf-8"))))
    for path in (task.output, task.report, task.preview):
        if path is not None:
            screen.say(f"wrote {path}", style="green")


def _size(n_bytes: int) -> str:
    return f"{n_bytes / 1e6:.1f} MB" if n_bytes >= 1e5 else f"{n_bytes / 1e3:.1f} kB"
