"""Requests that wait: `Prefer: wait=N` (RFC 7240), in seconds, at most as long as the service allows.

One query every tenth of a second serves all of them.
"""

import asyncio
import contextlib
import logging
import re
from collections.abc import Callable, Collection
from typing import Annotated

import anyio.to_thread
from fastapi import Header, Response

from jobkit.errors import DatabaseError, JobkitError
from service.pacing import Pacer

POLL_S = 0.1
_logger = logging.getLogger("service")
_WAIT = re.compile(r"(?:^|[,;\s])wait\s*=\s*\"?(\d{1,6})\"?(?=$|[,;\s])", re.IGNORECASE)

PreferHeader = Annotated[
    str | None,
    Header(
        alias="Prefer",
        description="`wait=N`: let the answer wait up to N seconds for the end (RFC 7240). Other preferences are "
        "ignored.",
        examples=["wait=10"],
    ),
]


def preferred_wait_s(prefer: str | None, default: float = 0.0) -> float:
    """Return the seconds that a Prefer header asks to wait; `default` where it does not ask."""
    match = _WAIT.search(prefer or "")
    return float(match[1]) if match else default


def note_applied(response: Response, prefer: str | None) -> None:
    """Say in the response that the preference was honoured."""
    match = _WAIT.search(prefer or "")
    if match:
        response.headers["Preference-Applied"] = f"wait={match[1]}"


class Waiters:
    """Requests that wait for the end of jobs, meshes or proofs, by one query for all.

    Parameters
    ----------
    unfinished : callable
        Returns those of some ids that have not ended. One call for all that are waited for, in a thread.
    most : int
        Requests that wait at the same time.
    """

    def __init__(self, unfinished: Callable[[Collection[str]], Collection[str]], most: int) -> None:
        self._unfinished = unfinished
        self._most = most
        self._n_waiting = 0
        self._futures: dict[str, set[asyncio.Future[None]]] = {}
        self._poll_task: asyncio.Task[None] | None = None
        self._pacer = Pacer()

    def __len__(self) -> int:
        """Count the requests that wait."""
        return self._n_waiting

    async def wait(self, subject: str, wait_s: float) -> bool:
        """Wait at most `wait_s` for the end of `subject`; return False, at once, where too many wait already."""
        if self._n_waiting >= self._most:
            return False
        future = asyncio.get_running_loop().create_future()
        self._n_waiting += 1
        self._futures.setdefault(subject, set()).add(future)
        if self._poll_task is None or self._poll_task.done():
            self._poll_task = asyncio.create_task(self._poll())
        with contextlib.suppress(TimeoutError):
            try:
                async with asyncio.timeout(wait_s):
                    await future
            finally:
                self._remove(subject, future)
        await self._pacer.wait_turn()  # the waits of a thousand requests may end at once
        return True

    def close(self) -> None:
        """End all waits, and refuse new ones."""
        self._most = 0
        self._finish(list(self._futures))

    async def _poll(self) -> None:
        while self._futures:
            subjects = list(self._futures)
            try:
                unfinished = await anyio.to_thread.run_sync(self._unfinished, subjects)
            except (JobkitError, DatabaseError) as error:
                _logger.warning("requests that wait can't look: %r", error.__cause__ or error)
                unfinished = ()  # each of them reads its subject and meets the error itself
            self._finish([subject for subject in subjects if subject not in unfinished])
            await asyncio.sleep(POLL_S)

    def _finish(self, subjects: list[str]) -> None:
        for subject in subjects:
            for future in self._futures.get(subject, ()):
                if not future.done():
                    future.set_result(None)

    def _remove(self, subject: str, future: asyncio.Future[None]) -> None:
        self._n_waiting -= 1
        remaining = self._futures[subject]
        remaining.discard(future)
        if not remaining:
            del self._futures[subject]
