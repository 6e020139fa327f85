"""Pacing of requests: one starts in each round of the event loop, so that short ones are answered in between.

A thousand requests that arrive together, or whose time to wait ends together, would otherwise be worked on in one
round of the event loop, and all others, such as `/healthz`, would be answered after them.
"""

import asyncio
from collections import deque

from starlette.types import ASGIApp, Message, Receive, Scope, Send

# Answered without a thread, in less time than a request waits for its turn.
UNPACED_PATHS = frozenset({"/healthz"})


class Pacer:
    """A queue of requests, one of which goes on in each round of the event loop."""

    def __init__(self) -> None:
        self._queue: deque[asyncio.Future[None]] = deque()
        self._is_scheduled = False

    async def wait_turn(self) -> None:
        """Wait for a turn."""
        loop = asyncio.get_running_loop()
        turn = loop.create_future()
        self._queue.append(turn)
        if not self._is_scheduled:
            self._is_scheduled = True
            loop.call_soon(self._release_next, loop)
        await turn

    def _release_next(self, loop: asyncio.AbstractEventLoop) -> None:
        while self._queue:
            turn = self._queue.popleft()
            if not turn.done():  # its request may have been cancelled
                turn.set_result(None)
                break
        self._is_scheduled = bool(self._queue)
        if self._is_scheduled:
            loop.call_soon(self._release_next, loop)


class PacingMiddleware:
    """Starts each request in its turn.

    Parameters
    ----------
    app : ASGIApp
    pacer : Pacer
    """

    def __init__(self, app: ASGIApp, pacer: Pacer) -> None:
        self._app = app
        self._pacer = pacer

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on in its turn, and the message of a disconnect in another one."""

        async def receive_paced() -> Message:
            message = await receive()
            if message["type"] == "http.disconnect":
                await self._pacer.wait_turn()  # hundreds of half-open requests may be timed out at once
            return message

        if scope["type"] != "http" or scope["path"] in UNPACED_PATHS:
            await self._app(scope, receive, send)
            return
        await self._pacer.wait_turn()
        await self._app(scope, receive_paced, send)
