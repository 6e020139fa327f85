"""Requests that come at the same moment begin one after the other, so that what is short is answered in between.

A thousand requests that arrive together, or whose time to wait ends together, would otherwise be worked on in one
round of the event loop, and all others, `/healthz` first of all, would be answered after them.
"""

import asyncio
from collections import deque

from starlette.types import ASGIApp, Message, Receive, Scope, Send

# Answered from the event loop alone, in less time than it takes to stand in line.
PASSING = frozenset({"/healthz"})


class Turns:
    """A line in which one request goes on in each round of the event loop."""

    def __init__(self) -> None:
        self._line: deque[asyncio.Future[None]] = deque()
        self._is_moving = False

    async def take(self) -> None:
        """Wait for a turn."""
        loop = asyncio.get_running_loop()
        turn = loop.create_future()
        self._line.append(turn)
        if not self._is_moving:
            self._is_moving = True
            loop.call_soon(self._move, loop)
        await turn

    def _move(self, loop: asyncio.AbstractEventLoop) -> None:
        while self._line:
            turn = self._line.popleft()
            if not turn.done():  # its request may have been cancelled
                turn.set_result(None)
                break
        self._is_moving = bool(self._line)
        if self._is_moving:
            loop.call_soon(self._move, loop)


class TurnsMiddleware:
    """Lets each request begin when its turn comes.

    Parameters
    ----------
    app : ASGIApp
    turns : Turns
    """

    def __init__(self, app: ASGIApp, turns: Turns) -> None:
        self._app = app
        self._turns = turns

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on in its turn, and in another one what it is told of a client that left."""

        async def receive_in_turn() -> Message:
            message = await receive()
            if message["type"] == "http.disconnect":
                await self._turns.take()  # hundreds of half-open requests may be timed out at once
            return message

        if scope["type"] != "http" or scope["path"] in PASSING:
            await self._app(scope, receive, send)
            return
        await self._turns.take()
        await self._app(scope, receive_in_turn, send)
