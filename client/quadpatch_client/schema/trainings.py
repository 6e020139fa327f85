"""Trainings as clients start and see them. A training is a job of the task `train`, and has the job's id.

Tested in `tests/service/routes/test_trainings.py`.
"""

from typing import Annotated, Self

from pydantic import Field, model_validator

from quadpatch_client.schema.base import (
    TEXT_PATTERN,
    AliasName,
    JobId,
    MeshId,
    ModelName,
    Moment,
    Request,
    Response,
    SentMoment,
)
from quadpatch_client.schema.codes import WarningDetails
from quadpatch_client.schema.jobs import Job, JobError
from quadpatch_client.schema.learning import (
    MOST_MESHES,
    MakeDefault,
    NetworkTrainingOptions,
    TrainedKind,
    TrainingOptions,
    TrainingResult,
    TrainingSpec,
)
from quadpatch_client.schema.methods import DEFAULT_MODEL, DEFAULT_NETWORK
from quadpatch_client.schema.spec import Format, JobSpec, Limits, Metadata, Priority, Seed, Text
from quadpatch_client.schema.states import JobState
from quadpatch_rules.tasks import TRAIN

MeshIds = Annotated[list[MeshId], Field(min_length=1, max_length=MOST_MESHES)]


class TrainingFilter(Request):
    """Which meshes: those that meet all conditions, the newest first. Only meshes whose analysis has ended count."""

    filename: str | None = Field(
        default=None,
        max_length=255,
        pattern=TEXT_PATTERN,
        description="Name of the file. `*` stands for any characters; case does not matter.",
        examples=["wall-*.ply"],
    )
    format: Format | None = Field(default=None, description="Only files of this format.", examples=["ply"])
    created_since: SentMoment | None = Field(
        default=None, description="Only those uploaded at this moment or later, RFC 3339."
    )
    created_before: SentMoment | None = Field(default=None, description="Only those uploaded before, RFC 3339.")
    most: int = Field(default=MOST_MESHES, ge=1, le=MOST_MESHES, description="At most so many meshes.", examples=[50])


class NewTraining(Request):
    """What is to be learned from which meshes: a list of them, or a filter."""

    model: ModelName
    kind: TrainedKind = Field(
        default="dictionary",
        description="`dictionary`, or `network`: it needs workers with torch, which `GET /v1/limits` tells "
        "(`trainings`).",
        examples=["network"],
    )
    meshes: MeshIds | None = Field(default=None, description="Ids of uploaded meshes.")
    filter: TrainingFilter | None = Field(
        default=None, description="In place of a list: the meshes that it finds when the training is accepted."
    )
    options: TrainingOptions = Field(
        default_factory=TrainingOptions, description="How a dictionary is learned; refused with the kind `network`."
    )
    network: NetworkTrainingOptions = Field(
        default_factory=NetworkTrainingOptions,
        description="How a network is fitted; refused with the kind `dictionary`.",
    )
    make_default: MakeDefault = Field(
        default="never",
        description="`if_better`: point the alias to the new version if held-out meshes say that it is better than the "
        "plain fill.",
        examples=["if_better"],
    )
    alias: AliasName | None = Field(
        default=None,
        description="The alias that `make_default` moves; null: `default`, and `default-network` for networks.",
        examples=["default"],
    )
    limits: Limits = Field(default_factory=Limits, description="Ceilings of one attempt.")
    seed: Seed = Field(default=0, description="Starts every random choice; it chooses the held-out meshes.")
    priority: Priority = Field(default="normal", description="As of a job.", examples=["bulk"])
    label: Text | None = Field(default=None, description="A name for people.", examples=["castings of May"])
    metadata: Metadata = Field(
        default_factory=dict, max_length=16, description="Up to 16 facts of the sender's own, handed back unread."
    )

    @model_validator(mode="after")
    def _names_meshes_once(self) -> Self:
        if (self.meshes is None) is (self.filter is None):
            raise ValueError("give meshes or a filter, one of the two")
        if self.meshes is not None and len(set(self.meshes)) < len(self.meshes):
            raise ValueError("meshes names a mesh twice")
        other = "options" if self.kind == "network" else "network"
        if other in self.model_fields_set:
            raise ValueError(f"{other} does not go with the kind {self.kind}")
        return self

    def job_spec(self, mesh_ids: list[str], first: str) -> JobSpec:
        """Return the spec of the job that trains; `first` is the mesh whose size counts for it."""
        copied = ("limits", "seed", "priority", "label", "metadata")
        train = TrainingSpec(
            model=self.model,
            kind=self.kind,
            meshes=mesh_ids,
            options=self.options,
            network=self.network,
            make_default=self.make_default,
            alias=self.alias or (DEFAULT_NETWORK if self.kind == "network" else DEFAULT_MODEL),
        )
        return JobSpec(mesh_id=first, task=TRAIN, train=train, **{name: getattr(self, name) for name in copied})


class TrainingLinks(Response):
    """Paths on this service; null where there is nothing to fetch or do."""

    self: str = Field(description="This training.")
    job: str = Field(description="The job that it is.")
    events: str = Field(description="Its event log.")
    cancel: str | None = Field(default=None, description="POST here to cancel.")
    report: str | None = Field(default=None, description="The JSON report.")
    model: str | None = Field(default=None, description="The model version that it made.")


class Training(Response):
    """A training, from the promise to the model version."""

    id: JobId
    state: JobState = Field(description="Where it stands.", examples=["running"])
    attempt: int = Field(ge=0, description="Attempts started so far.", examples=[1])
    max_attempts: int = Field(ge=1, description="Attempts before it is given up.", examples=[3])
    stage: str | None = Field(default=None, description="`read`, `learn`, `judge` or `write`.", examples=["learn"])
    percent: float = Field(ge=0, le=100, description="Share that is done.", examples=[62.5])
    queue_position: int | None = Field(default=None, ge=1, description="Its place among the jobs that wait.")
    eta_s: float | None = Field(default=None, ge=0, description="Estimated seconds to the end, null where unknown.")
    created_at: Moment = Field(description="When it was accepted, RFC 3339.")
    started_at: Moment | None = Field(default=None, description="When its latest attempt started, RFC 3339.")
    finished_at: Moment | None = Field(default=None, description="When it ended, RFC 3339.")
    train: TrainingSpec = Field(description="What it was asked to learn, with the meshes that were found.")
    label: str | None = Field(default=None, description="A name for people.")
    error: JobError | None = Field(default=None, description="Set once the state is `failed`.")
    warnings: list[str] = Field(default_factory=list, description="Sentences for people.")
    warning_details: WarningDetails = Field(default_factory=list)
    result: TrainingResult | None = Field(default=None, description="Set once it succeeded.")
    links: TrainingLinks = Field(description="Paths on this service.")

    @classmethod
    def of(cls, job: Job) -> Self:
        """Show a job of the task `train` as a training."""
        result = None if job.result is None else job.result.training
        path = f"/v1/trainings/{job.id}"
        names = cls.model_fields.keys() & Job.model_fields.keys() - {"links", "result"}
        return cls.model_validate(
            {
                **{name: getattr(job, name) for name in names},
                "train": job.spec.train,
                "label": job.spec.label,
                "warnings": [] if job.result is None else job.result.warnings,
                "warning_details": [] if job.result is None else job.result.warning_details,
                "result": result,
                "links": TrainingLinks(
                    self=path,
                    job=job.links.self,
                    events=f"{path}/events",
                    cancel=None if job.state.is_terminal else f"{path}/cancel",
                    report=job.links.report,
                    model=None if result is None else f"/v1/models/{result.model}/versions/{result.version}",
                ),
            }
        )


class TrainingPage(Response):
    """One page of trainings, newest first."""

    items: list[Training] = Field(description="Newest first.")
    next_cursor: str | None = Field(default=None, description="Pass as `cursor` to go on; null on the last page.")
