"""Event streams: server-sent events of jobs and batches, replayed from the event log and followed to the end.

One poller for each process queries the database for all that is watched at once and gives new events to the streams,
so a stream costs a connection and no thread. Each stream holds the number of the last event that it was given, and gets
the following ones in their order. Old and new events take the same way, so none is lost or repeated between replay and
live events.
"""

import asyncio
import logging
import re
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from http import HTTPStatus

import anyio
import anyio.to_thread
from fastapi.sse import KEEPALIVE_COMMENT, EventSourceResponse, format_sse_event
from starlette.types import Receive, Scope, Send

from jobkit.access.stream_leases import RENEW_S, StreamLeases
from jobkit.batches.events import read_new_batch_events
from jobkit.database.session import Database
from jobkit.errors import DatabaseError, DatabaseUnavailableError
from jobkit.jobs.events import NewEvents, read_new_events
from quadpatch_client.schema import BatchEvent, Event
from quadpatch_rules.ids import BATCH_ID_PATTERN
from service.problems import RETRY_AFTER_S, ProblemError

POLL_S = 0.25
# Proxies close connections that stay silent for a minute or half of one.
PING_S = 15.0
# After how long a client reconnects when the stream broke.
_RECONNECT_MS = 1000
_MOST_EVENTS = 1000
# A client that does not read gets nothing new until it has read what is pending.
_MOST_PENDING_BYTES = 1 << 18
# Without it nginx would buffer events.
_HEADERS: Mapping[str, str] = {"X-Accel-Buffering": "no", "Cache-Control": "no-store", "Vary": "Accept"}

_logger = logging.getLogger("service")


class EventStream:
    """The stream of events of one job or batch to one client; `after` is the number of the last one.

    `lease` is what it is counted by for its tenant, None where it is not.
    """

    def __init__(self, subject: str, after: int, ping_s: float, lease: str | None = None) -> None:
        self.subject = subject
        self.lease = lease
        self.after = after
        self._ping_s = ping_s
        self._pending: list[bytes] = []
        self._pending_bytes = 0
        self._has_news = asyncio.Event()
        self._is_over = False

    @property
    def has_room(self) -> bool:
        """Whether the client reads fast enough."""
        return self._pending_bytes < _MOST_PENDING_BYTES

    def hand(self, event: Event | BatchEvent, frame: bytes) -> None:
        """Send an event, unless the client has it already."""
        if event.sequence <= self.after:
            return
        self.after = event.sequence
        self._pending.append(frame)
        self._pending_bytes += len(frame)
        self._has_news.set()

    def end(self) -> None:
        """End the stream once the client has all pending events."""
        self._is_over = True
        self._has_news.set()

    async def chunks(self) -> AsyncIterator[bytes]:
        """Yield events as they come, and a comment after a time without events."""
        yield format_sse_event(comment=f"events of {self.subject}", retry=_RECONNECT_MS)
        while True:
            try:
                async with asyncio.timeout(self._ping_s):
                    await self._has_news.wait()
            except TimeoutError:
                yield KEEPALIVE_COMMENT
                continue
            self._has_news.clear()
            chunk, is_over = b"".join(self._pending), self._is_over
            self._pending.clear()
            self._pending_bytes = 0
            if chunk:
                yield chunk
            if is_over:
                return


class EventStreams:
    """All streams of a process.

    Parameters
    ----------
    database : Database
    most : int
        Streams at the same time.
    ping_s : float
        Seconds of silence until a comment is sent.
    """

    def __init__(self, database: Database, most: int, ping_s: float = PING_S) -> None:
        self._database = database
        self._most = most
        self._ping_s = ping_s
        self._leases = StreamLeases(database)
        self._streams: set[EventStream] = set()
        self._woken = asyncio.Event()
        self._is_closed = False

    def __len__(self) -> int:
        """Count the streams that are open."""
        return len(self._streams)

    async def respond_to(self, tenant: str, subject: str, after: int) -> EventSourceResponse:
        """Answer as `respond` does, and count the stream for its tenant, over all processes.

        Raises
        ------
        StreamQuotaError
            If the tenant has as many as it may.
        ProblemError
            503 if there are too many streams.
        """
        lease = await anyio.to_thread.run_sync(self._leases.take, tenant)
        try:
            return self.respond(subject, after, lease)
        except ProblemError:
            await self.give_back(lease)
            raise

    def respond(self, subject: str, after: int, lease: str | None = None) -> EventSourceResponse:
        """Answer with the events of a job or batch that follow number `after`, until it has ended.

        Raises
        ------
        ProblemError
            503 if there are too many streams.
        """
        if len(self._streams) >= self._most:
            raise ProblemError(
                HTTPStatus.SERVICE_UNAVAILABLE,
                "too_many_streams",
                f"{self._most} event streams are open, which is the limit; poll, or come back later",
                {"Retry-After": RETRY_AFTER_S},
            )
        stream = EventStream(subject, after, self._ping_s, lease)
        self._streams.add(stream)
        self._woken.set()
        if self._is_closed:
            stream.end()
        return _StreamResponse(self, stream)

    def remove(self, stream: EventStream) -> None:
        """Remove a stream whose client has disconnected, or has all events."""
        self._streams.discard(stream)

    async def give_back(self, lease: str | None) -> None:
        """Count a stream for its tenant no more; in an outage of the database it counts until its lease is over."""
        if lease is None:
            return
        # Also where the request is canceled, as it is when its client disconnects.
        with anyio.CancelScope(shield=True):
            try:
                await anyio.to_thread.run_sync(self._leases.give_back, lease)
            except (DatabaseUnavailableError, DatabaseError) as error:
                _logger.warning("an event stream counts until its lease is over: %r", error.__cause__ or error)

    def close(self) -> None:
        """End all streams; their clients come back with the number of the last event that they have."""
        self._is_closed = True
        for stream in self._streams:
            stream.end()

    @asynccontextmanager
    async def running(self) -> AsyncIterator[None]:
        """Serve streams for the length of a with block."""
        async with anyio.create_task_group() as tasks:
            tasks.start_soon(self._poll)
            tasks.start_soon(self._renew_leases)
            yield
            self.close()
            tasks.cancel_scope.cancel()

    async def _poll(self) -> None:
        """Query for new events: at once for a new stream, then every quarter of a second."""
        while True:
            try:
                async with asyncio.timeout(POLL_S if self._streams else None):
                    await self._woken.wait()
            except TimeoutError:
                pass
            self._woken.clear()
            try:
                await self._read_news()
            except Exception:  # the outermost handler of a task without which all streams would stop
                _logger.exception("a look for new events failed")

    async def _renew_leases(self) -> None:
        while True:
            await anyio.sleep(RENEW_S)
            if not any(stream.lease for stream in self._streams):
                continue
            try:
                await anyio.to_thread.run_sync(self._leases.renew)
            except (DatabaseUnavailableError, DatabaseError) as error:
                _logger.warning("leases of event streams are renewed later: %r", error.__cause__ or error)

    async def _read_news(self) -> None:
        streams = [stream for stream in self._streams if stream.has_room]
        watched: dict[str, int] = {}
        for stream in streams:
            watched[stream.subject] = min(stream.after, watched.get(stream.subject, stream.after))
        if not watched:
            return
        try:
            news = await anyio.to_thread.run_sync(self._read, watched)
        except (DatabaseUnavailableError, DatabaseError) as error:
            # The streams stay open: their clients get no events for a while, and lose none.
            _logger.warning("event streams wait for the database: %r", error.__cause__ or error)
            return
        frames = {subject: [(event, _frame(event)) for event in found.events] for subject, found in news.items()}
        for stream in streams:
            found = news.get(stream.subject)
            for event, frame in frames.get(stream.subject, ()):
                stream.hand(event, frame)
            if found is None or found.is_all:
                stream.end()

    def _read(self, watched: Mapping[str, int]) -> dict[str, NewEvents[Event] | NewEvents[BatchEvent]]:
        batches = {subject: after for subject, after in watched.items() if re.match(BATCH_ID_PATTERN, subject)}
        jobs = {subject: after for subject, after in watched.items() if subject not in batches}
        with self._database.read() as session:
            of_jobs = read_new_events(session, jobs, _MOST_EVENTS) if jobs else {}
            of_batches = read_new_batch_events(session, batches, _MOST_EVENTS) if batches else {}
        return {**of_jobs, **of_batches}


class _StreamResponse(EventSourceResponse):
    """A response that removes its stream, however it ends."""

    def __init__(self, streams: EventStreams, stream: EventStream) -> None:
        super().__init__(stream.chunks(), headers=dict(_HEADERS))
        self._streams = streams
        self._stream = stream

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Stream until the end, or until the client disconnects."""
        try:
            await super().__call__(scope, receive, send)
        finally:
            self._streams.remove(self._stream)
            await self._streams.give_back(self._stream.lease)


def _frame(event: Event | BatchEvent) -> bytes:
    return format_sse_event(data_str=event.model_dump_json(), event=event.type, id=str(event.sequence))
