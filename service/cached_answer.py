"""An answer that is the same for all requests, computed once and cached for a time."""

import asyncio
import time
from collections.abc import Callable
from typing import Any

import anyio.to_thread

READINESS_CACHE_S = 1.0


class CachedAnswer:
    """One answer; requests that arrive while it is computed wait for it.

    Parameters
    ----------
    seconds : float
        How long it is cached; an error is cached as long.
    clock : callable
        Monotonic seconds.
    """

    def __init__(self, seconds: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._seconds = seconds
        self._clock = clock
        self._task: asyncio.Task[Any] | None = None
        self._done_at: float | None = None

    async def get(self, work: Callable[[], Any]) -> Any:
        """Return what `work` returns or raise what it raises, now or a moment ago; it runs in a thread."""
        is_old = self._done_at is not None and self._clock() - self._done_at >= self._seconds
        if self._task is None or is_old:
            self._done_at = None
            self._task = asyncio.create_task(self._work(work))
        # A client that disconnects must not cancel the answer of the others.
        return await asyncio.shield(self._task)

    async def _work(self, work: Callable[[], Any]) -> Any:
        try:
            return await anyio.to_thread.run_sync(work)
        finally:
            self._done_at = self._clock()
