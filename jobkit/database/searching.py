"""Conditions for searches: texts with wildcards, moments, pages of rows by age.

Tested in `tests/service/routes/test_finding.py`.
"""

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import ColumnElement, and_, or_
from sqlalchemy.orm import InstrumentedAttribute

CURSOR_PATTERN = r"^[0-9]{1,17}_[0-9a-f]{64}$"


@dataclass(frozen=True)
class Period:
    """From a moment on, and before another one; None: open at that end."""

    since: datetime | None = None
    before: datetime | None = None

    def condition(
        self, column: InstrumentedAttribute[datetime] | InstrumentedAttribute[datetime | None]
    ) -> ColumnElement[bool] | None:
        """Return the condition that a column lies in it; None where it holds all moments."""
        bounds = [] if self.since is None else [column >= self.since]
        bounds += [] if self.before is None else [column < self.before]
        return and_(*bounds) if bounds else None


ALWAYS = Period()


def matches(column: ColumnElement[Any] | InstrumentedAttribute[Any], pattern: str) -> ColumnElement[bool]:
    """Return the condition that a text is like a pattern, whatever the case; `*` in it stands for any characters."""
    escaped = re.sub(r"([\\%_])", r"\\\1", pattern).replace("*", "%")
    return column.ilike(escaped, escape="\\")


def cursor_of(created_at: datetime, row_id: str) -> str:
    """Name the place of a row in a list by age."""
    return f"{_microseconds(created_at)}_{row_id}"


def older_than(
    created_at: InstrumentedAttribute[datetime], row_id: InstrumentedAttribute[str], cursor: str
) -> ColumnElement[bool]:
    """Return the condition that a row comes after the place that a cursor names, newest first."""
    number, _, last_id = cursor.partition("_")
    seconds, microseconds = divmod(int(number), 1_000_000)
    moment = datetime.fromtimestamp(min(seconds, 253_402_300_799), UTC).replace(microsecond=microseconds)
    return or_(created_at < moment, (created_at == moment) & (row_id < last_id))


def _microseconds(moment: datetime) -> int:
    return int(moment.timestamp()) * 1_000_000 + moment.microsecond
