"""The time, always in UTC."""

from datetime import UTC, datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session


def utc_now() -> datetime:
    """Return the present moment with its zone."""
    return datetime.now(UTC)


def shared_now(session: Session) -> datetime:
    """Return the present moment as all hosts see it: by the clock of the database server, where there is one.

    Leases are compared across hosts; one whose clock is wrong must not lose its own or take another's.
    """
    if session.get_bind().dialect.name == "sqlite":
        return utc_now()
    now: datetime = session.execute(select(func.clock_timestamp())).scalar_one()
    return now.astimezone(UTC)
