"""Which waiting job starts next: by priority, and among those of one priority each tenant in turn.

An entry of the queue gives a worker a turn, and the database says whose it is: the tenant that has waited longest since
its last turn gets it, for its oldest job. So a batch of thousands delays another tenant's job by the jobs in progress
and no more.

Tested in `tests/jobkit/jobs/test_turns.py`.
"""

import heapq
from collections import defaultdict, deque
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from typing import Literal, Protocol, TypeVar

from sqlalchemy import ColumnElement, func, or_, select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from jobkit.database.quotas import free_places
from jobkit.database.tables import JobRow, TurnRow
from quadpatch_client.schema import JobState, Priority
from quadpatch_rules.tasks import TRAIN

# Kind of the model that a training of a network is pinned to.
NETWORK_KIND: Literal["self_network"] = "self_network"
# By their rank; rows hold that number.
PRIORITIES: tuple[Priority, ...] = ("interactive", "normal", "bulk")
_LONG_AGO = datetime.min.replace(tzinfo=UTC)
_NEVER = (0, _LONG_AGO)
# Trainings of networks: a repair that fits one says itself that it can't.
NEEDS_NETWORKS = (JobRow.task == TRAIN) & (JobRow.model["kind"].as_string() == NETWORK_KIND)


class Waiting(Protocol):
    """A job that waits, as `order_of_turns` reads it."""

    @property
    def tenant(self) -> str:
        """Whose it is."""

    @property
    def priority(self) -> int:
        """Rank of its priority."""


Job = TypeVar("Job", bound=Waiting)


def rank_of(priority: Priority) -> int:
    """Return the number of a priority, 0 for the most urgent."""
    return PRIORITIES.index(priority)


def next_in_turn(session: Session, now: datetime, *, fits_networks: bool = True) -> str | None:
    """Return the job whose turn it is, of those that may start and don't wait for memory; None where there is none.

    A tenant that runs as many jobs as it may has no turn, and a training of a network none with a worker that can't fit
    one.
    """
    is_waiting = is_startable(now) & JobRow.tenant.not_in(busy_tenants(session))
    if not fits_networks:
        is_waiting &= ~NEEDS_NETWORKS
    urgent = select(func.min(JobRow.priority)).where(is_waiting).scalar_subquery()
    first = select(JobRow.tenant, func.min(JobRow.id).label("id")).where(is_waiting, JobRow.priority == urgent)
    rows = session.execute(first.group_by(JobRow.tenant)).all()
    turns = last_turns(session) if len(rows) > 1 else {}
    return min(rows, key=lambda row: (turns.get(row.tenant, _LONG_AGO), row.id)).id if rows else None


def is_startable(now: datetime) -> ColumnElement[bool]:
    """Return the condition on jobs that may start now and don't wait for memory."""
    is_due = or_(JobRow.not_before.is_(None), JobRow.not_before <= now)
    return (JobRow.state == JobState.QUEUED.value) & is_due & JobRow.memory_wait_since.is_(None)


def busy_tenants(session: Session) -> list[str]:
    """Return the tenants that run as many jobs as they may."""
    return [tenant for tenant, n_free in free_places(session).items() if not n_free]


def note_turn(session: Session, tenant: str, now: datetime) -> None:
    """Write that a tenant has had a turn."""
    insert = sqlite.insert if session.get_bind().dialect.name == "sqlite" else postgresql.insert
    statement = insert(TurnRow).values(tenant=tenant, at=now)
    # The first two turns of a tenant may come at once.
    session.execute(statement.on_conflict_do_update(index_elements=["tenant"], set_={"at": now}))


def last_turns(session: Session) -> dict[str, datetime]:
    """Return when each tenant had its last turn."""
    return {row.tenant: row.at for row in session.scalars(select(TurnRow))}


def order_of_turns(jobs: Iterable[Job], turns: Mapping[str, datetime]) -> list[Job]:
    """Put jobs that wait into the order of their turns.

    Parameters
    ----------
    jobs : iterable
        The oldest first.
    turns : mapping
        When each tenant had its last turn.
    """
    by_rank: dict[int, dict[str, deque[tuple[int, Job]]]] = defaultdict(lambda: defaultdict(deque))
    for place, job in enumerate(jobs):
        by_rank[job.priority][job.tenant].append((place, job))
    # A turn that is still to come is later than all that were, and they come one after the other.
    latest = {tenant: (0, at) for tenant, at in turns.items()}
    ordered: list[Job] = []
    for rank in sorted(by_rank):
        queues = by_rank[rank]
        heap = [(latest.get(tenant, _NEVER), queue[0][0], tenant) for tenant, queue in queues.items()]
        heapq.heapify(heap)
        while heap:
            _, _, tenant = heapq.heappop(heap)
            ordered.append(queues[tenant].popleft()[1])
            latest[tenant] = (len(ordered), _LONG_AGO)
            if queues[tenant]:
                heapq.heappush(heap, (latest[tenant], queues[tenant][0][0], tenant))
    return ordered
