import asyncio
from collections.abc import Collection

import pytest

from jobkit.errors import DatabaseUnavailableError
from service.waiting import Waiters, preferred_wait_s
from tests.service.rounds import most_in_a_round
from tests.waiting import GUARD_S


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


@pytest.mark.parametrize(("header", "seconds"), [(None, 10), ("respond-async", 10), ("wait=0", 0), ("wait=3", 3)])
def test_who_prefers_nothing_waits_as_the_route_says(header: str | None, seconds: float) -> None:
    assert preferred_wait_s(header, 10.0) == seconds


def test_all_that_wait_share_one_look_and_each_is_woken_by_its_own_end() -> None:
    looks: list[list[str]] = []

    def unfinished(subjects: Collection[str]) -> set[str]:
        looks.append(sorted(subjects))
        return {"b"} if len(looks) < 3 else set()

    async def run() -> tuple[bool, ...]:
        waiters = Waiters(unfinished, 1000)
        results = await asyncio.gather(*(waiters.wait(subject, GUARD_S) for subject in ["a", "b"] * 500))
        assert len(waiters) == 0
        return tuple(results)

    assert all(asyncio.run(run()))
    assert looks[0] == ["a", "b"]
    assert looks[-1] == ["b"]
    assert len(looks) == 3


def test_waiting_ends_when_the_time_is_over_or_all_are_let_go() -> None:
    async def run() -> None:
        waiters = Waiters(lambda subjects: subjects, 10)
        assert await waiters.wait("a", 0.05)
        waiting = asyncio.create_task(waiters.wait("a", GUARD_S))
        while not len(waiters):
            await asyncio.sleep(0)
        waiters.close()
        assert await waiting
        assert len(waiters) == 0
        assert await waiters.wait("a", GUARD_S) is False

    asyncio.run(run())


def test_those_that_are_too_many_are_answered_at_once() -> None:
    async def run() -> None:
        waiters = Waiters(lambda subjects: subjects, 1)
        first = asyncio.create_task(waiters.wait("a", GUARD_S))
        while not len(waiters):
            await asyncio.sleep(0)
        assert await waiters.wait("b", GUARD_S) is False
        waiters.close()
        assert await first is True

    asyncio.run(run())


def test_a_look_that_fails_lets_all_look_for_themselves() -> None:
    def fail(subjects: Collection[str]) -> set[str]:
        raise DatabaseUnavailableError("away")

    assert asyncio.run(Waiters(fail, 1).wait("a", GUARD_S))


def test_those_whose_wait_ends_at_once_go_on_one_after_the_other() -> None:
    async def run() -> int:
        waiters = Waiters(lambda subjects: set(), 1000)
        return await most_in_a_round(lambda: waiters.wait("a", GUARD_S), 500)

    assert asyncio.run(run()) == 1
