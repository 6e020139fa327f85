from datetime import UTC, datetime, timedelta, timezone

import pytest

from quadpatch_client.errors import UsageError
from quadpatch_client.moments import moment_of

NOW = datetime(2026, 11, 30, 12, 0, tzinfo=UTC)


@pytest.mark.parametrize(
    ("text", "moment"),
    [
        ("90m", NOW - timedelta(minutes=90)),
        ("12h", NOW - timedelta(hours=12)),
        ("7d", NOW - timedelta(days=7)),
        ("2026-11-29", datetime(2026, 11, 29, tzinfo=UTC)),
        ("2026-11-29T08:00Z", datetime(2026, 11, 29, 8, tzinfo=UTC)),
        ("2026-11-29T08:00+01:00", datetime(2026, 11, 29, 8, tzinfo=timezone(timedelta(hours=1)))),
    ],
)
def test_ages_and_moments_are_read(text: str, moment: datetime) -> None:
    assert moment_of(text, NOW) == moment


@pytest.mark.parametrize("text", ["yesterday", "12", "12x", "999999999999d", "2026-13-01"])
def test_what_is_no_moment_is_told_with_what_to_say(text: str) -> None:
    with pytest.raises(UsageError, match="say an age, such as 12h"):
        moment_of(text, NOW)
