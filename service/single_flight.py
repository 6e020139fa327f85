"""Work that several requests may ask for at the same time, and that is done once.

Tested in `tests/service/test_single_flight.py`.
"""

import asyncio
import logging
from collections.abc import Callable
from typing import Any

import anyio
import anyio.to_thread

_log = logging.getLogger("service")
# Pieces of work at the same time, in each process: each reads and writes a whole file.
_MOST = 4


class SingleFlight:
    """Runs functions in threads, one at a time for each name."""

    def __init__(self) -> None:
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._limiter: anyio.CapacityLimiter | None = None

    async def run(self, name: str, work: Callable[[], Any], wait_s: float) -> None:
        """Do a piece of work, or join one that has begun; wait for its end, but no longer than `wait_s` seconds.

        It goes on where the request that asked for it is broken off. What it raises is raised here.
        """
        task = self._tasks.get(name)
        if task is None:
            task = self._tasks[name] = asyncio.create_task(self._do(name, work), name=name)
            task.add_done_callback(_note_failure)
        await asyncio.wait({task}, timeout=wait_s)
        if task.done():
            task.result()

    async def _do(self, name: str, work: Callable[[], Any]) -> None:
        if self._limiter is None:
            self._limiter = anyio.CapacityLimiter(_MOST)
        try:
            await anyio.to_thread.run_sync(work, limiter=self._limiter)
        finally:
            del self._tasks[name]


def _note_failure(task: asyncio.Task[None]) -> None:
    """Log what went wrong: maybe no request waits for it any more."""
    error = None if task.cancelled() else task.exception()
    if error is not None:
        _log.warning("%s failed: %s", task.get_name(), error)
