"""Shadows: a candidate runs beside what jobs ask for, on a share of them, and its results are compared, not delivered.

Tested in `tests/service/routes/test_shadows.py`.
"""

from typing import Annotated, Literal

from pydantic import Field

from quadpatch_client.schema.base import NAME_PATTERN, JobId, ModelReference, Moment, Request, Response
from quadpatch_client.schema.codes import open_enum

ShadowName = Annotated[
    str,
    Field(
        pattern=NAME_PATTERN,
        description="What specs of jobs name: an alias, a model, or `auto` for the method that chooses by itself.",
        examples=["default"],
    ),
]
Share = Annotated[
    float, Field(ge=0, le=1, description="Share of the jobs; 0 runs it on none any more.", examples=[0.1])
]
CandidateReference = Annotated[str, Field(description="The candidate, `name@version`.", examples=["castings@3"])]
ShadowState = Literal["running", "complete", "candidate_missing"]
ShadowRunState = Literal["waiting", "running", "measured", "failed", "dropped"]
RUN_CODES = ("busy", "disk_low", "candidate_missing", "job_missing", "mesh_missing", "not_calibrated", "worker_lost")


class NewShadow(Request):
    """Which candidate is to run, and on how many jobs."""

    candidate: ModelReference
    share: Share = 0.1


class ShadowFigures(Response):
    """What the runs say of the candidate, all together; of jobs whose result was made by one and the same model."""

    baseline: str | None = Field(
        default=None,
        description="What the results were made by that it is compared with, `name@version` or `auto`: the latest, "
        "where an alias was moved meanwhile; null: nothing is measured yet.",
        examples=["general-dictionary@1"],
    )
    jobs: int = Field(ge=0, description="Jobs that are measured.", examples=[40])
    better: int = Field(ge=0, description="Jobs whose holes it would fill better, by more than 1 %.", examples=[31])
    worse: int = Field(ge=0, description="Jobs whose holes it would fill worse, by more than 1 %.", examples=[6])
    holes: int = Field(ge=0, description="Holes of these jobs.", examples=[512])
    ratio: float | None = Field(
        default=None,
        ge=0,
        description="Expected error of the candidate divided by that of the delivered result, by calibration: the "
        "geometric mean of all jobs; below 1 the candidate is better.",
        examples=[0.87],
    )
    standard_error: float | None = Field(
        default=None, ge=0, description="Of the ratio, from how jobs differ; null for fewer than two.", examples=[0.03]
    )
    verdict: str = Field(
        description="A sentence for people.", examples=["better on 31 of 40 jobs: may be made default"]
    )
    may_be_default: bool = Field(
        description="Whether it is better by more than two standard errors, on ten jobs at least."
    )


class ShadowLinks(Response):
    """Paths on this service."""

    self: str = Field(description="This shadow.", examples=["/v1/shadows/default"])
    runs: str = Field(description="Its runs, job by job.", examples=["/v1/shadows/default/runs"])


class Shadow(Response):
    """A candidate that runs beside what jobs ask for by a name."""

    name: ShadowName
    candidate: CandidateReference
    share: Share
    state: ShadowState = Field(
        description="`complete`: 1000 jobs are measured, and no others will be; `candidate_missing`: the version was "
        "deleted, and nothing runs any more.",
        examples=["running"],
    )
    waiting: int = Field(ge=0, description="Runs that wait for a worker that is free, or are at work.", examples=[1])
    failed: int = Field(ge=0, description="Runs in which the candidate made no result.", examples=[0])
    dropped: int = Field(ge=0, description="Runs that were given up: the service was busy, the disk low.", examples=[2])
    figures: ShadowFigures = Field(description="What the runs say.")
    created_at: Moment = Field(description="When this candidate was set, RFC 3339.")
    links: ShadowLinks = Field(description="Paths on this service.")


class ShadowList(Response):
    """All shadows, by name."""

    items: list[Shadow] = Field(description="By name.")


class ShadowRun(Response):
    """The candidate on the mesh of one job."""

    job_id: JobId
    candidate: CandidateReference
    baseline: str = Field(
        description="What the job's own result was made by: `name@version`, or `auto`.",
        examples=["general-dictionary@1"],
    )
    state: ShadowRunState = Field(
        description="`measured`: `ratio` says how it compares; `failed`: the candidate made no result; `dropped`: it "
        "was given up.",
        examples=["measured"],
    )
    holes: int | None = Field(default=None, ge=0, description="Holes that were compared.", examples=[12])
    ratio: float | None = Field(
        default=None,
        ge=0,
        description="Expected error of the candidate divided by that of the delivered result: the geometric mean of "
        "its holes.",
        examples=[0.81],
    )
    code: str | None = Field(
        default=None,
        description="Why it was dropped or failed.",
        json_schema_extra=open_enum(RUN_CODES),
        examples=["busy"],
    )
    message: str | None = Field(default=None, description="The same for people.")
    created_at: Moment = Field(description="When the job had its result, RFC 3339.")
    finished_at: Moment | None = Field(default=None, description="When the run ended, RFC 3339.")


class ShadowRunPage(Response):
    """One page of runs, those of the newest jobs first."""

    items: list[ShadowRun] = Field(description="Runs, those of the newest jobs first.")
    next_cursor: JobId | None = Field(default=None, description="Pass as `cursor` to go on; null on the last page.")
