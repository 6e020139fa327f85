from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dispatcher.backoff import DELAYS_S, JITTER, next_delay_s, read_retry_after

NOW = datetime(2026, 11, 22, 9, 15, 2, tzinfo=UTC)
chances = st.floats(0, 1, exclude_max=True)
asked = st.none() | st.floats(0, 1e9)


@given(chance=chances)
def test_pauses_grow_and_never_overlap(chance: float) -> None:
    delays = [next_delay_s(n, chance) for n in range(1, len(DELAYS_S) + 1)]
    longest = [(1 + JITTER) * delay for delay in DELAYS_S]
    for delay, least, most in zip(delays, DELAYS_S, longest, strict=True):
        assert delay is not None
        assert least <= delay <= most
    assert all(most < least for most, least in zip(longest, DELAYS_S[1:], strict=False))


@given(n_tries=st.integers(1, 100), chance=chances, retry_after_s=asked)
def test_there_is_one_try_more_than_pauses_whatever_the_receiver_asks_for(
    n_tries: int, chance: float, retry_after_s: float | None
) -> None:
    assert (next_delay_s(n_tries, chance, retry_after_s) is None) == (n_tries > len(DELAYS_S))


@given(n_tries=st.integers(1, len(DELAYS_S)), chance=chances, retry_after_s=st.floats(0, 1e9))
def test_a_receiver_gets_the_pause_that_it_asks_for_up_to_the_longest(
    n_tries: int, chance: float, retry_after_s: float
) -> None:
    delay, without = next_delay_s(n_tries, chance, retry_after_s), next_delay_s(n_tries, chance)
    assert delay is not None
    assert without is not None
    assert delay >= max(without, min(retry_after_s, DELAYS_S[-1]))
    assert delay <= (1 + JITTER) * DELAYS_S[-1]


def test_all_tries_take_most_of_a_day() -> None:
    total = timedelta(seconds=sum(DELAYS_S))
    assert timedelta(hours=22) < total < timedelta(hours=24)


@pytest.mark.parametrize(
    ("value", "seconds"),
    [
        (None, None),
        ("0", 0.0),
        (" 120 ", 120.0),
        ("Sun, 22 Nov 2026 09:16:02 GMT", 60.0),
        ("Sun, 22 Nov 2026 09:00:00 GMT", 0.0),
        ("Sun, 22 Nov 2026 09:16:02", None),
        ("-5", None),
        ("1.5", None),
        ("soon", None),
        ("²", None),
        ("9" * 5000, 999_999_999.0),
    ],
)
def test_retry_after_is_seconds_or_a_date(value: str | None, seconds: float | None) -> None:
    assert read_retry_after(value, NOW) == seconds


@given(st.text())
def test_no_retry_after_breaks_a_delivery(value: str) -> None:
    seconds = read_retry_after(value, NOW)
    assert seconds is None or seconds >= 0
