"""Requests that wait: `Prefer: wait=N` (RFC 7240), in seconds, at most as long as the service allows.

A look at the database every tenth of a second serves all of them, however many there are.
"""

import asyncio
import contextlib
import logging
import re
from collections.abc import Callable, Collection
from typing import Annotated

import anyio.to_thread
from fastapi import Header, Response
from sqlalchemy.exc import SQLAlchemyError

from jobkit.errors import JobkitError
from service.turns import Turns

LOOK_S = 0.1
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


def preferred_wait_s(prefer: str | None, otherwise: float = 0.0) -> float:
    """Return the seconds that a Prefer header asks to wait; `otherwise` where it does not ask."""
    match = _WAIT.search(prefer or "")
    return float(match[1]) if match else otherwise


def note_applied(response: Response, prefer: str | None) -> None:
    """Say in the response that the preference was honoured."""
    match = _WAIT.search(prefer or "")
    if match:
        response.headers["Preference-Applied"] = f"wait={match[1]}"


class Waiters:
    """Requests that wait for the end of something, all of them by one look.

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
        self._waiting: dict[str, set[asyncio.Future[None]]] = {}
        self._looking: asyncio.Task[None] | None = None
        self._turns = Turns()

    def __len__(self) -> int:
        """Count the requests that wait."""
        return self._n_waiting

    async def wait(self, subject: str, wait_s: float) -> bool:
        """Wait at most `wait_s` for the end of `subject`; return False, at once, where too many wait already."""
        if self._n_waiting >= self._most:
            return False
        woken = asyncio.get_running_loop().create_future()
        self._n_waiting += 1
        self._waiting.setdefault(subject, set()).add(woken)
        if self._looking is None or self._looking.done():
            self._looking = asyncio.create_task(self._look())
        with contextlib.suppress(TimeoutError):
            try:
                async with asyncio.timeout(wait_s):
                    await woken
            finally:
                self._leave(subject, woken)
        await self._turns.take()  # the time of a thousand may be up at once
        return True

    def close(self) -> None:
        """Let all go on that wait, and let no others wait."""
        self._most = 0
        self._wake(list(self._waiting))

    async def _look(self) -> None:
        while self._waiting:
            subjects = list(self._waiting)
            try:
                unfinished = await anyio.to_thread.run_sync(self._unfinished, subjects)
            except (JobkitError, SQLAlchemyError) as error:
                _logger.warning("requests that wait can't look: %r", error.__cause__ or error)
                unfinished = ()  # each of them looks once more, and says what is wrong
            self._wake([subject for subject in subjects if subject not in unfinished])
            await asyncio.sleep(LOOK_S)

    def _wake(self, subjects: list[str]) -> None:
        for subject in subjects:
            for woken in self._waiting.get(subject, ()):
                if not woken.done():
                    woken.set_result(None)

    def _leave(self, subject: str, woken: asyncio.Future[None]) -> None:
        self._n_waiting -= 1
        left = self._waiting[subject]
        left.discard(woken)
        if not left:
            del self._waiting[subject]
