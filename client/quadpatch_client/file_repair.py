"""One file of a folder through the service: from the file to what comes back, and a row that says what came of it.

Tested in `tests/integration/test_batch.py`.
"""

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from quadpatch_client.conditions import Condition, first_fault, quantities_of
from quadpatch_client.errors import ClientError
from quadpatch_client.journal import State
from quadpatch_client.options import HoleChoice, MethodChoice

if TYPE_CHECKING:
    from quadpatch_client.schema import FileRole, Job
    from quadpatch_client.sdk import Client


@dataclass(frozen=True)
class JobOptions:
    """What is asked for every file of a folder.

    Attributes
    ----------
    holes : HoleChoice
    method : MethodChoice
    rest : dict
        Further fields of the job spec.
    conditions : tuple of Condition
        Which files are repaired; others are skipped.
    """

    holes: HoleChoice = field(default_factory=HoleChoice)
    method: MethodChoice = field(default_factory=MethodChoice)
    rest: dict[str, Any] = field(default_factory=dict)
    conditions: tuple[Condition, ...] = ()

    def digest(self) -> str:
        """Return a short text that is the same for the same options."""
        return hashlib.sha256(json.dumps(asdict(self), sort_keys=True).encode()).hexdigest()[:16]


@dataclass(frozen=True)
class FilePlan:
    """A file, and where what is made of it goes.

    Attributes
    ----------
    name : str
        Path in its folder, with `/`.
    source, output, report : Path
    html, preview : Path, optional
    """

    name: str
    source: Path
    output: Path
    report: Path
    html: Path | None = None
    preview: Path | None = None

    def outputs(self) -> list[Path]:
        """Return all that is made; the mesh last: where it is, everything is."""
        return [path for path in (self.report, self.html, self.preview, self.output) if path is not None]


@dataclass(frozen=True)
class Row:
    """What came of a file, as journal and screen have it.

    Attributes
    ----------
    file : str
        Path in its folder, with `/`.
    state : str
    found, filled, filled_smooth, skipped, refused, new_triangles, seconds
        As the job's result counts them.
    job : str or None
        Its id.
    reason : str
        What to look at, or why there is no result.
    figures : dict
        What the table says of its job, by column; empty where no job has a result, or an earlier version wrote it.
    """

    file: str
    state: State
    found: int | None = None
    filled: int | None = None
    filled_smooth: int | None = None
    skipped: int | None = None
    refused: int | None = None
    new_triangles: int | None = None
    seconds: float | None = None
    job: str | None = None
    reason: str = ""
    figures: dict[str, Any] = field(default_factory=dict)

    def facts(self) -> dict[str, Any]:
        """Return it as the journal keeps it."""
        return {name: value for name, value in asdict(self).items() if name not in ("file", "state")}


def repair_file(client: "Client", plan: FilePlan, options: JobOptions, on_job: Callable[[str], None]) -> Row:
    """Repair one file; the same file with the same options finds its job again.

    Parameters
    ----------
    client : Client
    plan : FilePlan
    options : JobOptions
    on_job : callable
        Gets the id of the job before it is waited for.

    Raises
    ------
    ClientError
    """
    from quadpatch_client.spec import make_spec  # noqa: PLC0415  loads the wire schema, which --help does without
    from quadpatch_client.transfers import label_of, sent_name  # noqa: PLC0415  loads HTTP

    size_mb = plan.source.stat().st_size / 1e6
    fault = first_fault(options.conditions, {"name": plan.source.name, "size_mb": size_mb})
    if fault:
        return Row(plan.name, "skipped", reason=fault)
    mesh = client.upload(plan.source)
    if not all(condition.is_of_the_file for condition in options.conditions):
        facts = client.wait_for_mesh(mesh.id).facts
        fault = None if facts is None else first_fault(options.conditions, quantities_of(facts))
        if fault:
            return Row(plan.name, "skipped", reason=fault)
    label = options.rest.get("label") or label_of(plan.source)
    rest = {**options.rest, "label": label, "mesh_name": sent_name(plan.source) or None}
    job = client.create_job_once(make_spec(mesh.id, options.holes, options.method, **rest))
    on_job(job.id)
    job = client.wait(job.id)
    reasons = [*(job.result.warnings if job.result else ()), *_fetch(client, job, plan)]
    return row_of(plan, job, "; ".join(reasons))


def row_of(plan: FilePlan, job: "Job", reason: str = "") -> Row:
    """Return the row of a file whose job has a result; a reason is what to look at in it."""
    from quadpatch_client.schema import figures_of  # noqa: PLC0415  see repair_file

    file = plan.name
    if job.result is None:
        return Row(file, "failed", job=job.id, reason=reason)
    counts = job.result.holes
    return Row(
        file,
        "done_with_warnings" if reason else "done",
        counts.found,
        counts.filled,
        counts.filled_smooth,
        counts.skipped,
        counts.refused,
        job.result.new_triangles,
        job.result.seconds,
        job.id,
        reason,
        figures_of(job, PurePosixPath(file).with_name(plan.output.name).as_posix()),
    )


def _fetch(client: "Client", job: "Job", plan: FilePlan) -> Sequence[str]:
    """Fetch what was made, the mesh last; return in words what of the rest could not be fetched."""
    missing = []
    roles: tuple[tuple[FileRole, Path | None], ...] = (
        ("report", plan.report),
        ("html_report", plan.html),
        ("preview", plan.preview),
    )
    for role, path in roles:
        if path is not None and (job.result is None or job.result.file(role) is None):
            missing.append(f"there is no {role.replace('_', ' ')}")
        elif path is not None:
            client.download(job, role, path)
    client.download(job, "result", plan.output)
    return missing


def failure(file: str, error: ClientError | OSError) -> Row:
    """Return the row of a file that could not be repaired."""
    from quadpatch_client.schema import figures_of  # noqa: PLC0415  see repair_file

    job = getattr(error, "job", None)
    if job is None:
        return Row(file, "failed", reason=str(error))
    return Row(file, "failed", job=job.id, reason=str(error), figures=figures_of(job, None))
