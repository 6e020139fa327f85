"""The time, always in UTC."""

from datetime import UTC, datetime


def utc_now() -> datetime:
    """Return the present moment with its zone."""
    return datetime.now(UTC)
