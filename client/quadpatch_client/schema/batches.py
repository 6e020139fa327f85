"""Batches of jobs, and their events, as clients see them.

Tested in `tests/service/routes/test_batches.py`.
"""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from quadpatch_client.schema.base import TEXT_PATTERN, BatchId, MeshId, Moment, Request, Response, SentMoment
from quadpatch_client.schema.spec import Format, JobSpec, Metadata, RepairSpec, Text
from quadpatch_client.schema.states import JobState, MeshState
from quadpatch_client.schema.webhook_url import WebhookUrl

MOST_JOBS = 10_000
BatchState = Literal["running", "canceling", "ended"]
BatchEventType = Literal["started", "progress", "cancel_requested", "ended"]
Count = Annotated[int, Field(ge=0)]


class MeshFilter(Request):
    """Which meshes, as `GET /v1/meshes` looks for them."""

    state: list[Annotated[MeshState, Field(strict=False)]] = Field(
        default_factory=lambda: [MeshState.READY, MeshState.ANALYSING],
        min_length=1,
        max_length=3,
        description="Any of these states; those that were not rejected unless given.",
        examples=[["ready"]],
    )
    filename: str | None = Field(
        default=None,
        max_length=255,
        pattern=TEXT_PATTERN,
        description="Name of the file. `*` stands for any characters; case does not matter.",
        examples=["face0*.ply"],
    )
    format: Format | None = Field(default=None, description="Files of this format.", examples=["ply"])
    created_since: SentMoment | None = Field(default=None, description="Made at this moment or later, RFC 3339.")
    created_before: SentMoment | None = Field(default=None, description="Made before this moment, RFC 3339.")


class NewBatch(Request):
    """Jobs to be started together. Of `mesh_ids`, `filter` and `jobs` it has one."""

    mesh_ids: list[MeshId] | None = Field(
        default=None, min_length=1, max_length=MOST_JOBS, description="A job on each of these meshes, in this order."
    )
    filter: MeshFilter | None = Field(
        default=None, description="A job on each mesh that is there now and fits, the latest first."
    )
    jobs: list[JobSpec] | None = Field(
        default=None, min_length=1, max_length=MOST_JOBS, description="Jobs with a spec each, in this order."
    )
    spec: RepairSpec = Field(
        default_factory=RepairSpec,
        description="What is done with the meshes of `mesh_ids` or `filter`. Here and in `jobs` the priority is `bulk` "
        "unless given.",
    )
    label: Text | None = Field(default=None, description="A name for people.", examples=["night shift, hall 3"])
    metadata: Metadata = Field(default_factory=dict, description="Up to 16 facts of the sender's own.")
    callback_url: WebhookUrl | None = Field(
        default=None,
        description="Where to send the message `batch.ended`, as `callback_url` of a job.",
        examples=["https://mes.example.com/hooks/night-shift"],
    )

    @model_validator(mode="after")
    def _says_once_which_jobs(self) -> Self:
        if sum(given is not None for given in (self.mesh_ids, self.filter, self.jobs)) != 1:
            raise ValueError("name one of mesh_ids, filter and jobs")
        if self.jobs is not None and "spec" in self.model_fields_set:
            raise ValueError("jobs have a spec each: drop spec")
        if self.mesh_ids is not None and len(set(self.mesh_ids)) < len(self.mesh_ids):
            raise ValueError("mesh_ids names a mesh twice")
        return self


class BatchLinks(Response):
    """Paths on this service; null where there is nothing to fetch or do."""

    self: str = Field(description="This batch.")
    jobs: str = Field(description="Its jobs.")
    events: str = Field(description="Its event log.")
    figures: str = Field(description="A table of its jobs, CSV.")
    rerun: str = Field(description="POST here to run again what failed.")
    cancel: str | None = Field(default=None, description="POST here to cancel all that has not ended.")
    results: str | None = Field(default=None, description="All results, a ZIP file.")


class Batch(Response):
    """Jobs that were started together."""

    id: BatchId
    state: BatchState = Field(description="`ended` once all of its jobs have.", examples=["running"])
    n_jobs: int = Field(ge=1, description="Jobs that it was started with.", examples=[500])
    counts: dict[JobState, Count] = Field(
        description="Its jobs by state; without those that were deleted.",
        examples=[{"queued": 312, "running": 4, "succeeded": 184}],
    )
    eta_s: float | None = Field(
        default=None,
        ge=0,
        description="Estimated seconds to the end; null where too little is known.",
        examples=[5400.0],
    )
    label: str | None = Field(default=None, description="A name for people.", examples=["night shift, hall 3"])
    metadata: dict[str, str] = Field(default_factory=dict, description="Facts of the sender's own.")
    callback_url: WebhookUrl | None = Field(default=None, description="Where the message of its end is sent.")
    rerun_of: BatchId | None = Field(default=None, description="The batch whose failed jobs this one repeats.")
    created_at: Moment = Field(description="When it was accepted, RFC 3339.")
    finished_at: Moment | None = Field(default=None, description="When it ended, RFC 3339.")
    expires_at: Moment | None = Field(
        default=None,
        description="When it is removed, unless one of its jobs is kept, RFC 3339; null: not ended, or kept.",
    )
    revision: int = Field(ge=1, description="The number of its latest event.", examples=[7])
    links: BatchLinks = Field(description="Paths on this service.")


class BatchPage(Response):
    """One page of batches, newest first."""

    items: list[Batch] = Field(description="Newest first.")
    next_cursor: str | None = Field(
        default=None, description="Pass as `cursor` to go on; null on the last page.", examples=["bat_01jd…"]
    )


class BatchEvent(Response):
    """One change of a batch; changes within a second are one."""

    sequence: int = Field(ge=1, description="Counts up from 1 within a batch.", examples=[3])
    type: BatchEventType = Field(description="What happened.", examples=["progress"])
    at: Moment = Field(description="When, RFC 3339.")
    data: dict[str, Any] = Field(
        default_factory=dict,
        description="`counts`: its jobs by state.",
        examples=[{"counts": {"queued": 312, "running": 4, "succeeded": 184}}],
    )


class BatchEventPage(Response):
    """One page of a batch's events, oldest first."""

    items: list[BatchEvent] = Field(description="Oldest first.")
    next_after: int | None = Field(default=None, description="Pass as `after` to go on; null on the last page.")
