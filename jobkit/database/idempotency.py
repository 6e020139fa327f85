"""Keys that clients send so that a repeated request makes nothing twice.

One key of one client names one request, whatever it is about. The key of a job goes with the job; others are forgotten
after `KEEP_FOR`.

Tested in `tests/attacks/test_h_idempotency.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import TypeVar

from sqlalchemy import CursorResult, delete
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import IdempotencyRow
from jobkit.errors import IdempotencyError, RowConflictError

KEEP_FOR = timedelta(days=7)

T = TypeVar("T")


@dataclass(frozen=True)
class Idempotency:
    """A key that a client sent so that a repeated request starts nothing twice.

    Attributes
    ----------
    principal : str
        Whose key it is: two clients may use the same one.
    key : str
    request_sha256 : str
        Of the request, to tell a repetition from a mix-up.
    """

    principal: str
    key: str
    request_sha256: str


def earlier_row(session: Session, idempotency: Idempotency) -> IdempotencyRow | None:
    """Return the row of the key, None where it is new; raise IdempotencyError where it named another request."""
    row = session.get(IdempotencyRow, (idempotency.principal, idempotency.key))
    if row is not None and row.request_sha256 != idempotency.request_sha256:
        raise IdempotencyError(f"the idempotency key {idempotency.key!r} came before with another request")
    return row


def remember(
    session: Session, idempotency: Idempotency | None, *, job_id: str | None = None, made: str | None = None
) -> None:
    """Record what the request with the key made, in the transaction that makes it.

    Parameters
    ----------
    session : Session
    idempotency : Idempotency, optional
        None: nothing is written.
    job_id : str, optional
        The job that was made.
    made : str, optional
        What names the thing otherwise.
    """
    if idempotency is not None:
        session.add(
            IdempotencyRow(
                principal=idempotency.principal,
                key=idempotency.key,
                request_sha256=idempotency.request_sha256,
                job_id=job_id,
                made=made,
                created_at=utc_now(),
            )
        )


def is_repeated(database: Database, idempotency: Idempotency | None) -> bool:
    """Tell whether the key came before with the same request; raise IdempotencyError where it named another one."""
    if idempotency is None:
        return False
    with database.read() as session:
        return earlier_row(session, idempotency) is not None


def refuse_conflict(database: Database, idempotency: Idempotency | None) -> None:
    """Raise IdempotencyError where the key came before with another request."""
    is_repeated(database, idempotency)


def make_once(
    database: Database,
    idempotency: Idempotency | None,
    make: Callable[[Session], tuple[T, str]],
    show: Callable[[Session, str], T],
) -> tuple[T, bool]:
    """Make something, or show what the same request has made before.

    Parameters
    ----------
    database : Database
    idempotency : Idempotency, optional
        None: it is made in any case.
    make : callable
        Makes it in a session; returns it, and what `show` knows it by.
    show : callable

    Returns
    -------
    thing, bool
        And whether it is new.

    Raises
    ------
    IdempotencyError
        If the key came before with another request.
    """
    try:
        return _make_once(database, idempotency, make, show)
    except RowConflictError:
        # Two requests with one key at the same moment: the other one was first, so what it made is the answer.
        return _make_once(database, idempotency, make, show)


def note_request(database: Database, idempotency: Idempotency | None, made: str) -> bool:
    """Write down a request that made what the same one makes again; return whether its key is new.

    Raises
    ------
    IdempotencyError
        If the key came before with another request.
    """
    return idempotency is None or make_once(database, idempotency, lambda _: (made, made), lambda _, made: made)[1]


def forget_made(session: Session, made: str) -> None:
    """Forget the keys of what is deleted in this transaction."""
    session.execute(delete(IdempotencyRow).where(IdempotencyRow.made == made))


def forget_keys(database: Database, now: datetime) -> int:
    """Forget keys older than `KEEP_FOR` that no job takes with it; return how many."""
    old = (IdempotencyRow.job_id.is_(None)) & (IdempotencyRow.created_at < now - KEEP_FOR)
    with database.write() as session:
        result = session.execute(delete(IdempotencyRow).where(old))
        return result.rowcount if isinstance(result, CursorResult) else 0


def _make_once(
    database: Database,
    idempotency: Idempotency | None,
    make: Callable[[Session], tuple[T, str]],
    show: Callable[[Session, str], T],
) -> tuple[T, bool]:
    with database.write() as session:
        key_row = None if idempotency is None else earlier_row(session, idempotency)
        if key_row is not None:
            return show(session, key_row.made or ""), False
        # Before anything else: where requests with one key make different things, each of which locks rows of the
        # tenant, all of them wait for the key first, and none for the other's lock.
        remember(session, idempotency, made="")
        session.flush()
        thing, made = make(session)
        if idempotency is not None:
            session.get_one(IdempotencyRow, (idempotency.principal, idempotency.key)).made = made
        session.flush()
        return thing, True
