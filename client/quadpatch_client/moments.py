"""Moments as people type them.

Tested in `tests/quadpatch_client/test_moments.py`.
"""

import re
from datetime import UTC, datetime, timedelta

from quadpatch_client.errors import UsageError

_AGE = re.compile(r"(\d+)([mhd])")
_UNITS = {"m": "minutes", "h": "hours", "d": "days"}


def moment_of(text: str, now: datetime | None = None) -> datetime:
    """Read an age, such as `12h`, or a moment, such as `2026-11-30` or `2026-11-30T08:00+01:00`; without a zone, UTC.

    Raises
    ------
    UsageError
    """
    age = _AGE.fullmatch(text)
    try:
        if age is not None:
            return (now or datetime.now(UTC)) - timedelta(**{_UNITS[age[2]]: int(age[1])})
        moment = datetime.fromisoformat(text)
    except (ValueError, OverflowError) as error:
        raise UsageError(f"{text!r} is no moment: say an age, such as 12h or 7d, or 2026-11-30T08:00Z") from error
    return moment if moment.tzinfo is not None else moment.replace(tzinfo=UTC)
