"""The audit trail: what requests changed is noted as they are answered, and written a moment later.

Entries are written together, four times a second: a transaction of its own for each request would double the cost of
accepting a job. A process that is killed loses those of its last quarter of a second; its log has them.

Tested in `tests/service/routes/test_keys.py`.
"""

import asyncio
import contextlib
import logging
from collections import deque
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from http import HTTPStatus

import anyio.to_thread
from cachetools import TTLCache
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from jobkit.access.audit import AuditLog, Deed
from jobkit.access.keys import Holder
from jobkit.errors import DatabaseError, DatabaseUnavailableError
from service.auth import ANONYMOUS

_WRITE_EVERY_S = 0.25
# In an outage of the database the oldest entries go first; the log has them.
_MOST_WAITING = 100_000
_MOST_AT_ONCE = 500
_READING = frozenset({"GET", "HEAD", "OPTIONS"})
_REFUSALS = (401, 403)
# Of requests without a key: one for each address within so many seconds, and of so many addresses.
_STRANGER_S, _MOST_STRANGERS = 60.0, 1000

_logger = logging.getLogger("service.audit")


class AuditTrail:
    """Entries of one process on their way into the log."""

    def __init__(self, log: AuditLog) -> None:
        self._log = log
        self._waiting: deque[Deed] = deque(maxlen=_MOST_WAITING)
        self._strangers: TTLCache[str | None, bool] = TTLCache(_MOST_STRANGERS, _STRANGER_S)

    def note(self, deed: Deed) -> None:
        """Take an entry. Of requests without a key it takes one a minute for each address: else they fill the disk."""
        if deed.principal == ANONYMOUS.key_id:
            if deed.address in self._strangers or len(self._strangers) >= _MOST_STRANGERS:
                return
            self._strangers[deed.address] = True
        self._waiting.append(deed)

    @asynccontextmanager
    async def running(self) -> AsyncIterator[None]:
        """Write entries for the length of a with block, and those that are left at its end."""
        ended = asyncio.Event()
        task = asyncio.create_task(self._write_until(ended))
        try:
            yield
        finally:
            # Not canceled: a write that is under way in its thread would go on, and its entries be written twice.
            ended.set()
            await task
            await self.flush()

    async def flush(self) -> None:
        """Write what waits; an outage of the database leaves it waiting."""
        while self._waiting:
            batch = [self._waiting[i] for i in range(min(len(self._waiting), _MOST_AT_ONCE))]
            try:
                await anyio.to_thread.run_sync(self._log.add, batch)
            except (DatabaseUnavailableError, DatabaseError) as error:
                _logger.warning("%d entries of the audit log wait: %r", len(self._waiting), error.__cause__ or error)
                return
            for _ in range(min(len(batch), len(self._waiting))):
                self._waiting.popleft()

    async def _write_until(self, ended: asyncio.Event) -> None:
        while not ended.is_set():
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(ended.wait(), _WRITE_EVERY_S)
            await self.flush()


class AuditMiddleware:
    """Notes each request that changes something, and each that is refused for want of a key or a right."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, and note how it was answered."""
        if scope["type"] != "http" or not scope["path"].startswith("/v1/"):
            await self._app(scope, receive, send)
            return
        status = 500

        async def send_and_look(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        try:
            await self._app(scope, receive, send_and_look)
        finally:
            # What was too much changed nothing, and one who asks too often must not fill the log.
            if status != HTTPStatus.TOO_MANY_REQUESTS and (scope["method"] not in _READING or status in _REFUSALS):
                _note(Request(scope), status)


def _note(request: Request, status: int) -> None:
    # A request without a valid key has none.
    principal: Holder = getattr(request.state, "principal", ANONYMOUS)
    route = request.scope.get("route")
    services = request.app.state.services
    services.audit.note(
        Deed(
            at=datetime.now(UTC),
            tenant=principal.tenant,
            principal=principal.key_id,
            name=principal.name,
            operation=getattr(route, "operation_id", None) or getattr(route, "name", None) or request.method.lower(),
            path=request.scope["path"].encode("ascii", "replace").decode()[:512],
            status=status,
            address=request.client.host[:64] if request.client else None,
            request_id=getattr(request.state, "request_id", None),
        )
    )
