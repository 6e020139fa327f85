import asyncio
import threading
from collections.abc import Callable
from typing import Any

import pytest

from jobkit.errors import StoreUnavailableError
from service.single_flight import SingleFlight
from tests.waiting import GUARD_S


def in_loop(act: Callable[[SingleFlight], Any]) -> Any:
    async def run() -> Any:
        return await act(SingleFlight())

    return asyncio.run(run())


def test_requests_for_the_same_work_share_it() -> None:
    calls, may_end = [], threading.Event()

    def work() -> None:
        calls.append(1)
        may_end.wait(GUARD_S)

    async def act(flight: SingleFlight) -> None:
        waiting = [asyncio.create_task(flight.run("a", work, GUARD_S)) for _ in range(3)]
        while not calls:
            await asyncio.sleep(0.01)
        may_end.set()
        await asyncio.gather(*waiting)
        await flight.run("a", work, GUARD_S)

    in_loop(act)
    assert len(calls) == 2


def test_work_goes_on_after_the_wait_and_where_its_request_is_broken_off() -> None:
    ended, may_end = threading.Event(), threading.Event()

    def work() -> None:
        may_end.wait(GUARD_S)
        ended.set()

    async def act(flight: SingleFlight) -> None:
        await flight.run("a", work, 0.01)
        broken = asyncio.create_task(flight.run("a", work, GUARD_S))
        await asyncio.sleep(0.01)
        broken.cancel()
        assert not ended.is_set()
        may_end.set()
        await flight.run("a", work, GUARD_S)

    in_loop(act)
    assert ended.is_set()


def test_what_goes_wrong_is_told_to_all_that_wait(caplog: pytest.LogCaptureFixture) -> None:
    def work() -> None:
        raise StoreUnavailableError("no store")

    async def act(flight: SingleFlight) -> list[Any]:
        return await asyncio.gather(*[flight.run("a", work, GUARD_S) for _ in range(2)], return_exceptions=True)

    assert [type(error) for error in in_loop(act)] == [StoreUnavailableError] * 2
    assert "a failed: no store" in caplog.text
