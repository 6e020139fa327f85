"""Rows as clients see them, where one that can't be read does not hide the others.

A row may come from a newer version, or from a fault that is corrected by now. A request for its id fails; a list, a
stream, or a shared query leaves it out.
"""

import logging
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

Row = TypeVar("Row")
Shown = TypeVar("Shown")

_log = logging.getLogger("quadpatch.rows")


def readable(rows: Iterable[Row], show: Callable[[Row], Shown]) -> Iterator[Shown]:
    """Yield what `show` makes of each row; a row of which it can make nothing is logged and left out."""
    for row in rows:
        try:
            yield show(row)
        except ValueError as error:  # pydantic's, and those of enumerations
            _log.error("a row can't be read and is left out: %s, %r", _name(row), error)


def _name(row: object) -> str:
    names = ("id", "name", "alias", "job_id", "sequence", "version")
    return f"{type(row).__name__} " + " ".join(str(getattr(row, name)) for name in names if hasattr(row, name))
