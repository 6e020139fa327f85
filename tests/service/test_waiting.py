import anyio
import pytest

from service.waiting import preferred_wait_s, wait_until


@pytest.mark.parametrize(
    ("header", "seconds"),
    [
        (None, 0),
        ("", 0),
        ("wait=10", 10),
        ("respond-async, wait=10", 10),
        ("Wait = 5", 5),
        ('wait="7"', 7),
        ("wait=10; foo", 10),
        ("wait=-1", 0),
        ("wait=1.5", 0),
        ("await=10", 0),
        ("wait=99999999", 0),
    ],
)
def test_only_a_whole_number_of_seconds_is_a_wait(header: str | None, seconds: float) -> None:
    assert preferred_wait_s(header) == seconds


def test_waiting_ends_as_soon_as_it_is_done() -> None:
    sights = iter(range(10))
    assert anyio.run(wait_until, lambda: next(sights), lambda seen: seen == 3, 60.0) == 3


def test_waiting_ends_with_the_last_sight_when_the_time_is_over() -> None:
    sights = iter(range(1000))
    assert anyio.run(wait_until, lambda: next(sights), lambda seen: False, 0.2) >= 1


def test_no_wait_is_one_look() -> None:
    sights = iter(range(10))
    assert anyio.run(wait_until, lambda: next(sights), lambda seen: False, 0.0) == 0
