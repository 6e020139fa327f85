"""Query parameters of lists: which rows are looked for.

Tested in `tests/service/routes/test_finding.py`.
"""

from typing import Annotated

from fastapi import Depends, Query
from pydantic import Field

from jobkit.database.searching import Period
from jobkit.jobs.search import JobSearch
from jobkit.meshes import MeshSearch
from quadpatch_client.schema import Format, JobState, MeshState
from quadpatch_client.schema.base import TEXT_PATTERN, SentMoment
from quadpatch_rules.ids import BATCH_ID_PATTERN, SHA256_PATTERN
from quadpatch_rules.tasks import Task

MOST_ON_A_PAGE = 500
Limit = Annotated[int, Query(ge=1, le=MOST_ON_A_PAGE, description="Most items on the page.")]
_WILD = "`*` stands for any characters; case does not matter."
Filename = Annotated[
    str | None,
    Query(max_length=255, pattern=TEXT_PATTERN, description=f"Name of the file. {_WILD}", examples=["face0*.ply"]),
]
Since = Annotated[SentMoment | None, Query(description="Only those made at this moment or later, RFC 3339.")]
Before = Annotated[SentMoment | None, Query(description="Only those made before this moment, RFC 3339.")]


_FACT = r"^[^:\x00-\x1f\x7f]{1,64}:[^\x00-\x1f\x7f]{0,255}$"
Fact = Annotated[str, Field(pattern=_FACT)]


def _job_search(  # noqa: PLR0913, PLR0917  each is a parameter of the query
    state: Annotated[list[JobState] | None, Query(description="Only jobs in this state; may be repeated.")] = None,
    task: Annotated[Task | None, Query(description="Only jobs that do this.")] = None,
    mesh_id: Annotated[
        str | None, Query(pattern=SHA256_PATTERN, description="Only jobs on this mesh, or that learn from it.")
    ] = None,
    batch_id: Annotated[str | None, Query(pattern=BATCH_ID_PATTERN, description="Only jobs of this batch.")] = None,
    filename: Filename = None,
    label: Annotated[
        str | None, Query(max_length=255, pattern=TEXT_PATTERN, description=f"Label of the job. {_WILD}")
    ] = None,
    metadata: Annotated[
        list[Fact] | None,
        Query(
            max_length=16,
            description="`name:value`, a fact of the sender's own; may be repeated.",
            examples=[["order:A-17"]],
        ),
    ] = None,
    created_since: Since = None,
    created_before: Before = None,
    finished_since: Annotated[SentMoment | None, Query(description="Only those that ended then or later.")] = None,
    finished_before: Annotated[SentMoment | None, Query(description="Only those that ended before.")] = None,
    oldest_first: Annotated[bool, Query(description="The other way round than newest first.")] = False,
) -> JobSearch:
    return JobSearch(
        states=tuple(state or ()),
        task=task,
        mesh_id=mesh_id,
        batch_id=batch_id,
        filename=filename,
        label=label,
        metadata=dict(text.split(":", 1) for text in metadata or ()),
        created=Period(created_since, created_before),
        finished=Period(finished_since, finished_before),
        oldest_first=oldest_first,
    )


def _mesh_search(
    state: Annotated[list[MeshState] | None, Query(description="Only meshes in this state; may be repeated.")] = None,
    filename: Filename = None,
    format: Annotated[Format | None, Query(description="Only files of this format.")] = None,  # noqa: A002  its name
    created_since: Since = None,
    created_before: Before = None,
) -> MeshSearch:
    return MeshSearch(tuple(state or ()), filename, format, Period(created_since, created_before))


JobSearchDep = Annotated[JobSearch, Depends(_job_search)]
MeshSearchDep = Annotated[MeshSearch, Depends(_mesh_search)]
