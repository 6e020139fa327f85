"""One conditional update moves a job from state to state, and logs it in the same transaction."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, CursorResult, update
from sqlalchemy.orm import Session

from jobkit.database.tables import JobRow
from jobkit.jobs.events import append_event
from jobkit.webhooks.outbox import write_messages
from quadpatch_client.schema import TRANSITIONS, EventType, JobState


@dataclass(frozen=True)
class Transition:
    """A step of a job from one state to another.

    Attributes
    ----------
    source, target : JobState
        The step; only those of `TRANSITIONS` exist.
    event : str
        Type of the event that logs it.
    values : mapping
        Columns to write besides state, revision and times.
    data : mapping
        Facts for the event.
    """

    source: JobState
    target: JobState
    event: EventType
    values: Mapping[str, Any] = field(default_factory=dict)
    data: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.target not in TRANSITIONS[self.source]:
            raise ValueError(f"a job never goes from {self.source} to {self.target}")


def make_transition(
    session: Session, job_id: str, transition: Transition, at: datetime, *fences: ColumnElement[bool]
) -> bool:
    """Move a job if it is in the source state of the transition and within the fences; return whether it was."""
    values: dict[str, Any] = {"state": transition.target.value, "revision": JobRow.revision + 1, "updated_at": at}
    if transition.source is JobState.QUEUED:
        values |= {"memory_wait_since": None, "memory_wait_at": None}
    if transition.source in (JobState.RUNNING, JobState.CANCELING) and transition.target != JobState.CANCELING:
        values |= {"lease_until": None, "worker": None}
    if transition.target is JobState.QUEUED:
        values |= {"queued_at": at}
    if transition.target is JobState.CANCELING:
        values |= {"cancel_requested_at": at}
    if transition.target.is_terminal:
        values |= {"finished_at": at, "stage": None}
    if not update_job(
        session, job_id, {**values, **transition.values}, JobRow.state == transition.source.value, *fences
    ):
        return False
    append_event(session, job_id, transition.event, at, {"state": transition.target.value, **transition.data})
    write_messages(session, job_id, transition.event, at)
    return True


def update_job(session: Session, job_id: str, values: Mapping[str, Any], *fences: ColumnElement[bool]) -> bool:
    """Write columns of a job if all fences hold; return whether they did."""
    result = session.execute(
        update(JobRow).where(JobRow.id == job_id, *fences).values(**values).execution_options(synchronize_session=False)
    )
    return isinstance(result, CursorResult) and result.rowcount == 1
