"""Jobs, their events and results as clients see them.

Tested in `tests/service/routes/test_jobs.py`.
"""

from typing import Annotated, Literal

from pydantic import ConfigDict, Field
from typing_extensions import TypedDict

from quadpatch_client.schema.acceptance import Accepted
from quadpatch_client.schema.base import BatchId, JobId, MeshId, Moment, Response, Sha256
from quadpatch_client.schema.codes import FailureCode, WarningDetails
from quadpatch_client.schema.learning import TrainingResult
from quadpatch_client.schema.meshes import Hole
from quadpatch_client.schema.models import ResolvedModel
from quadpatch_client.schema.spec import JobSpec, Limits
from quadpatch_client.schema.states import JobState
from quadpatch_rules.hole_selection import HoleAction
from quadpatch_rules.option_words import OutputFormat
from quadpatch_rules.tasks import FILL, Task

# What a job hands back: a mesh in a format of its own choice, an encoded surface, or a model.
ResultFormat = OutputFormat | Literal["qpz", "safetensors", "onnx"]
FileRole = Literal["result", "report", "preview", "closeups", "html_report", "pdf_report"]


class JobError(Response):
    """Why a job, or an attempt, failed."""

    code: FailureCode
    message: str = Field(description="A sentence for people.", examples=["the work took longer than 120 s"])
    stage: str | None = Field(default=None, description="Stage of the method that failed.", examples=["inpaint"])
    retryable: bool = Field(default=False, description="Whether the same job may succeed another time.")


class HoleCounts(Response):
    """Verdicts over all holes."""

    found: int = Field(default=0, ge=0, description="Boundary loops found.", examples=[39])
    filled: int = Field(default=0, ge=0, description="Filled with the model.", examples=[36])
    filled_smooth: int = Field(default=0, ge=0, description="Filled without it: the smooth fall-back.", examples=[2])
    skipped: int = Field(default=0, ge=0, description="Left open by rule.", examples=[1])
    refused: int = Field(default=0, ge=0, description="Left open because they can't be filled well.", examples=[0])


class ResultFile(Response):
    """One file of a result."""

    role: FileRole = Field(description="What it is.", examples=["result"])
    name: str = Field(pattern=r"^[A-Za-z0-9._-]{1,100}$", description="Name in the store.", examples=["repaired.ply"])
    media_type: str = Field(description="Media type.", examples=["application/octet-stream"])
    size_bytes: int = Field(ge=0, description="Size, in bytes.", examples=[3_300_000])
    sha256: Sha256


class JobResult(Response):
    """Facts of a finished job. Lengths are in mesh units; what a task does not count is null."""

    format: ResultFormat = Field(
        description="Format of what came back; `qpz` from `encode`, `safetensors` or `onnx` from `train`.",
        examples=["ply"],
    )
    holes: HoleCounts = Field(default_factory=HoleCounts, description="Verdicts over all holes.")
    new_vertices: int = Field(default=0, ge=0, description="Vertices that were added.", examples=[2110])
    new_triangles: int = Field(default=0, ge=0, description="Triangles that were added.", examples=[4800])
    restored_vertices: int | None = Field(
        default=None, ge=0, description="Of `restore`: missing vertices that got a position.", examples=[1200]
    )
    moved_vertices: int | None = Field(
        default=None, ge=0, description="Of `denoise`: vertices that were moved.", examples=[85_000]
    )
    shift_95: float | None = Field(
        default=None,
        ge=0,
        description="Of `denoise`: 95 of 100 moved vertices were moved no farther than this, in mesh units.",
        examples=[0.03],
    )
    max_error: float | None = Field(
        default=None,
        ge=0,
        description="How far the decoded surface lies from the scan at most, in mesh units: as measured by `encode`, "
        "as promised in the file that `decode` read.",
        examples=[0.0098],
    )
    acceptance: Accepted | None = Field(default=None, description="What came of the spec's `acceptance`.")
    training: TrainingResult | None = Field(default=None, description="Of `train`: what was learned.")
    seconds: float = Field(default=0.0, ge=0, description="Wall-clock seconds of the job.", examples=[14.2])
    peak_memory_mb: int | None = Field(
        default=None,
        ge=0,
        description="Most memory that its engine had at once, in MiB; null of jobs by earlier versions.",
        examples=[312],
    )
    version: str | None = Field(
        default=None,
        description="Version of the software that made it; null of jobs by earlier ones.",
        examples=["0.2.0"],
    )
    warnings: list[str] = Field(default_factory=list, description="Sentences for people.")
    warning_details: WarningDetails = Field(default_factory=list)
    files: list[ResultFile] = Field(default_factory=list, description="What can be fetched.")

    def file(self, role: str) -> ResultFile | None:
        """Return the file of that role, None where there is none."""
        return next((file for file in self.files if file.role == role), None)


class JobLinks(Response):
    """Paths on this service; null where there is nothing to fetch or do."""

    self: str = Field(description="This job.")
    events: str = Field(description="Its event log.")
    mesh: str = Field(description="The mesh it works on.")
    rerun: str = Field(description="POST here to run the same spec again.")
    cancel: str | None = Field(default=None, description="POST here to cancel.")
    result: str | None = Field(default=None, description="The repaired mesh, or what else the task makes.")
    report: str | None = Field(default=None, description="The JSON report.")
    preview: str | None = Field(default=None, description="The before/after picture.")
    closeups: str | None = Field(default=None, description="Pictures of the chosen holes, a ZIP file.")
    html_report: str | None = Field(default=None, description="The report as a page for people.")
    pdf_report: str | None = Field(default=None, description="That page as a PDF.")


class Job(Response):
    """A job, from the promise to the result."""

    id: JobId
    state: JobState = Field(description="Where it stands.", examples=["running"])
    attempt: int = Field(ge=0, description="Attempts started so far.", examples=[1])
    max_attempts: int = Field(ge=1, description="Attempts before the job is given up.", examples=[3])
    stage: str | None = Field(default=None, description="Stage of the method at work.", examples=["inpaint"])
    percent: float = Field(ge=0, le=100, description="Share of the whole job that is done.", examples=[62.5])
    queue_position: int | None = Field(
        default=None, ge=1, description="Its place among the jobs that wait, from 1; null once it runs.", examples=[3]
    )
    waits_for: Literal["memory"] | None = Field(
        default=None,
        description="`memory`: it did not fit into the memory of a machine, and starts once it does; else null.",
    )
    eta_s: float | None = Field(
        default=None,
        ge=0,
        description="Estimated seconds to the end, waiting included, learned from past jobs of this size; null where "
        "too little is known.",
        examples=[42.0],
    )
    created_at: Moment = Field(description="When it was accepted, RFC 3339.")
    started_at: Moment | None = Field(default=None, description="When its latest attempt started, RFC 3339.")
    finished_at: Moment | None = Field(default=None, description="When it ended, RFC 3339.")
    mesh_id: MeshId
    mesh_name: str | None = Field(
        default=None,
        description="Name of the file that it works on, after which its result is named; null: the sender gave none.",
        examples=["face000.ply"],
    )
    model: ResolvedModel = Field(description="The model version it is pinned to.")
    spec: JobSpec = Field(description="What it was asked to do, with defaults written out.")
    error: JobError | None = Field(default=None, description="Set once the state is `failed`.")
    result: JobResult | None = Field(default=None, description="Set once it succeeded.")
    rerun_of: JobId | None = Field(default=None, description="The job that this one repeats.")
    batch_id: BatchId | None = Field(default=None, description="The batch that it belongs to.")
    cached_from: JobId | None = Field(
        default=None, description="The job that made the result, where this one took it over; it may be deleted by now."
    )
    pinned: bool = Field(default=False, description="Whether it is kept whatever the retention.")
    expires_at: Moment | None = Field(
        default=None, description="When it is removed with all it left, RFC 3339; null: not ended, or kept."
    )
    revision: int = Field(ge=1, description="Raised by every change; the number of its latest event.", examples=[7])
    links: JobLinks = Field(description="Paths on this service.")


EventType = Literal["queued", "started", "progress", "requeued", "cancel_requested", "canceled", "succeeded", "failed"]


class EventFacts(TypedDict, total=False):
    """Facts of a change; which are there goes by its type, and others may come."""

    __pydantic_config__ = ConfigDict(extra="allow")  # type: ignore[misc]

    state: Annotated[JobState, Field(description="State of the job from then on.", examples=["running"])]
    task: Annotated[Task, Field(description="Of the first `queued`: what the job is to do.", examples=["fill"])]
    stage: Annotated[str, Field(description="Of `progress`: stage at work.", examples=["inpaint"])]
    percent: Annotated[float, Field(description="Of `progress`: share of the job that is done.", examples=[62.5])]
    waits_for: Annotated[Literal["memory"], Field(description="Of a later `queued`: what the job waits for.")]
    memory_mb: Annotated[int, Field(description="Of the same: how much it needs, in MiB.", examples=[900])]
    cached_from: Annotated[str, Field(description="Of `succeeded`: the job whose result was taken over.")]
    error: Annotated[JobError, Field(description="Of `failed` and `requeued`: why.")]
    forgiven: Annotated[bool, Field(description="Of `requeued`: the attempt does not count.", examples=[True])]
    delay_s: Annotated[float, Field(description="Of `requeued`: seconds before the next attempt.", examples=[5.0])]


class Event(Response):
    """One change of a job."""

    sequence: int = Field(ge=1, description="Counts up from 1 within a job.", examples=[3])
    type: EventType = Field(description="What happened.", examples=["progress"])
    at: Moment = Field(description="When, RFC 3339.")
    attempt: int = Field(ge=0, description="The attempt it belongs to.", examples=[1])
    data: EventFacts = Field(
        default_factory=EventFacts, description="Facts of the change.", examples=[{"stage": "inpaint", "percent": 62.5}]
    )


class JobPage(Response):
    """One page of jobs, newest first."""

    items: list[Job] = Field(description="Newest first.")
    next_cursor: str | None = Field(
        default=None, description="Pass as `cursor` to go on; null on the last page.", examples=["job_01jd…"]
    )


class EventPage(Response):
    """One page of a job's events, oldest first."""

    items: list[Event] = Field(description="Oldest first.")
    next_after: int | None = Field(default=None, description="Pass as `after` to go on; null on the last page.")


class PlannedHole(Hole):
    """A hole, and what the job would do with it."""

    selected: bool = Field(description="Whether the job would fill it.")
    reason: str | None = Field(default=None, description="Why it would stay open.", examples=["too_wide"])
    action: HoleAction | None = Field(
        default=None, description="How it would be closed; null: it stays open.", examples=["model"]
    )
    joined_to: int | None = Field(
        default=None,
        description="Id of the hole that it lies in as the border of an island: the ring between the two is filled.",
        examples=[0],
    )
    bridged_to: int | None = Field(
        default=None, description="Id of the loop that the job would join it to by a bridge.", examples=[17]
    )


class PlannedBridge(Response):
    """Two loops that a bridge would join, proposed or asked for."""

    holes: list[int] = Field(min_length=2, max_length=2, description="Their ids.", examples=[[3, 17]])
    selected: bool = Field(description="Whether the job would join them: whether it is asked to, and both rims allow.")
    is_proposed: bool = Field(description="Whether the analysis found that they face each other.")
    shape: Literal["ring", "strip"] | None = Field(
        default=None, description="As in the mesh's facts; null where it was not proposed."
    )
    gap: float | None = Field(
        default=None, ge=0, description="Mean distance between the rims, in mesh units; null like `shape`."
    )
    share: float | None = Field(
        default=None,
        ge=0,
        le=1,
        description="Of the rim that faces the other one, where it is smaller; null like that.",
    )


class Plan(Response):
    """What a job would do; nothing was started."""

    mesh_id: MeshId
    task: Task = Field(default=FILL, description="The task that it would do.", examples=["fill"])
    summary: str = Field(default="", description="What it would do, for people.", examples=["fill 38 of 39 holes"])
    model: ResolvedModel = Field(description="The model version it would be pinned to.")
    holes: list[PlannedHole] = Field(
        description="All holes of the mesh, widest first; empty where the task is not `fill`."
    )
    bridges: list[PlannedBridge] = Field(
        default_factory=list,
        description="Pairs of loops that face each other, and those that the job is asked to join. A proposal is not "
        "carried out unless `holes.bridges` names it.",
    )
    is_exact: bool = Field(
        default=True,
        description="False with a `weld_tolerance` other than `auto`: the job finds the holes anew, and these are not "
        "quite the ones that it will find.",
    )
    selected: int = Field(ge=0, description="How many would be filled.", examples=[38])
    limits: Limits = Field(description="The ceilings that would hold.")
