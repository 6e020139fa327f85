"""Connections under limits: how many there are, how long and how large the head of a request may be, how slow its body.

uvicorn has none of these limits. A connection costs a client a packet and the service a descriptor, so a client that
opens thousands and sends nothing would keep all others out. Where there are too many, the connection that has waited
longest for its client is closed; where all of them have a request at work, the newest is refused.

Tested in `tests/attacks/test_d_one_client_alone.py`.
"""

import asyncio
import json
import resource
from collections import OrderedDict
from http import HTTPStatus
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from quadpatch_client.schema import PROBLEM_MEDIA_TYPE, Problem

MOST_HEAD_BYTES = 64 << 10
HEAD_S = 10.0
# Between two packets of a body.
BODY_S = 30.0
# Descriptors that the process needs for files, the database and the queue.
SPARE_DESCRIPTORS = 256
TOO_MANY = "too_many_connections"
_CLOCK_S = 1.0
_LINGER_S = 1.0


class ConnectionLimits:
    """What all connections of a process share.

    Parameters
    ----------
    most : int
        Connections at the same time.
    head_s, body_s : float
        Seconds for the head of a request, and between two packets of its body.
    """

    def __init__(self, most: int, head_s: float = HEAD_S, body_s: float = BODY_S) -> None:
        self.most = most
        self.head_s = head_s
        self.body_s = body_s
        self.n_open = 0
        # Those that wait for their client, with the time at which the wait ends; the longest waiting first.
        self._idle: OrderedDict[LimitedProtocol, float] = OrderedDict()
        self._timer: asyncio.TimerHandle | None = None

    def wait_for(self, connection: "LimitedProtocol", seconds: float) -> None:
        """Note that a connection waits for its client from now on."""
        loop = connection.loop
        self._idle[connection] = loop.time() + seconds
        self._idle.move_to_end(connection)
        if self._timer is None:
            self._timer = loop.call_later(_CLOCK_S, self._end_overdue, loop)

    def heard(self, connection: "LimitedProtocol") -> None:
        """Note that a connection waits for its client no longer."""
        self._idle.pop(connection, None)

    def make_room(self) -> bool:
        """End the connection that has waited longest where there are too many; return whether there is room."""
        if self.n_open <= self.most:
            return True
        oldest = next(iter(self._idle), None)
        if oldest is None:
            return False
        oldest.drop()
        return True

    def _end_overdue(self, loop: asyncio.AbstractEventLoop) -> None:
        now = loop.time()
        for connection in [connection for connection, until in self._idle.items() if until <= now]:
            connection.time_out()
        self._timer = loop.call_later(_CLOCK_S, self._end_overdue, loop) if self._idle else None


class LimitedProtocol(HttpToolsProtocol):
    """uvicorn's protocol under `limits`, which a subclass of its own sets."""

    limits: ConnectionLimits

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        self._head_bytes = 0
        self._in_head = True
        self._n_whole = 0
        self._is_ended = False

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Count it, and make room for it."""
        super().connection_made(transport)
        self.limits.n_open += 1
        if not self.limits.make_room():
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE, TOO_MANY, "there are too many connections")
            return
        self.limits.wait_for(self, self.limits.head_s)

    def connection_lost(self, exc: Exception | None) -> None:
        """Count it no longer."""
        self.limits.n_open -= 1
        self.limits.heard(self)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take bytes, up to the limit on heads; the clock of a head runs on, that of a body starts anew."""
        if self._is_ended:
            return
        n_whole = self._n_whole
        super().data_received(data)
        if self._in_head and not self.transport.is_closing():
            # What came with the end of the request before is counted, too: at most one packet.
            self._head_bytes = len(data) if self._n_whole > n_whole else self._head_bytes + len(data)
            if self._head_bytes > MOST_HEAD_BYTES:
                self._refuse_head()
        elif self._is_sending:
            self.limits.wait_for(self, self.limits.body_s)

    def on_message_begin(self) -> None:
        """Start with a head: its clock runs from the first byte, and later bytes do not reset it."""
        super().on_message_begin()
        self._in_head = True
        self.limits.wait_for(self, self.limits.head_s)

    def on_headers_complete(self) -> None:
        """Wait for the body from now on; httptools tells at once where there is none."""
        self._in_head, self._head_bytes = False, 0
        if sum(len(name) + len(value) for name, value in self.headers) + len(self.url) > MOST_HEAD_BYTES:
            self._refuse_head()
            raise ValueError("the head is too large")  # ends the parser, and no request is made of it
        self.limits.wait_for(self, self.limits.body_s)
        super().on_headers_complete()

    def on_message_complete(self) -> None:
        """Stop the clock: from here on the service takes the time."""
        self._n_whole += 1
        self.limits.heard(self)
        super().on_message_complete()

    def on_response_complete(self) -> None:
        """Wait for the next request."""
        super().on_response_complete()
        if not self.transport.is_closing() and (self.cycle is None or self.cycle.response_complete):
            self.limits.wait_for(self, self.limits.head_s)

    def pause_writing(self) -> None:
        """Wait for a client that does not read, up to the limit of a body."""
        super().pause_writing()
        self.limits.wait_for(self, self.limits.body_s)

    def resume_writing(self) -> None:
        """Stop the clock again."""
        super().resume_writing()
        self.limits.heard(self)

    def send_400_response(self, msg: str) -> None:
        """Answer what is no HTTP with a problem document."""
        self._refuse(HTTPStatus.BAD_REQUEST, "malformed_request", "the request does not follow HTTP/1.1")

    def time_out(self) -> None:
        """End a connection whose client was silent, or slow, for too long."""
        if self.flow.read_paused:  # by us: the bytes wait until the disk has taken those before
            self.limits.wait_for(self, self.limits.body_s)
        elif self._is_sending and not self._has_answer:
            self._refuse(HTTPStatus.REQUEST_TIMEOUT, "request_timeout", "the request did not arrive in time")
        else:
            self.drop()

    def drop(self) -> None:
        """Close a connection at once and without an answer: its client may never read what is buffered."""
        self._is_ended = True
        self.limits.heard(self)
        self.transport.abort()

    @property
    def _is_sending(self) -> bool:
        """Whether the client has begun a request that is not whole yet."""
        is_body = self.cycle is not None and self.cycle.more_body
        return self._head_bytes > 0 or (is_body and not self._in_head)

    @property
    def _has_answer(self) -> bool:
        return self.cycle is not None and self.cycle.response_started and not self.cycle.response_complete

    def _refuse_head(self) -> None:
        detail = f"the head of the request has more than {MOST_HEAD_BYTES} bytes, which is the limit"
        self._refuse(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE, "header_too_large", detail)

    def _refuse(self, status: HTTPStatus, code: str, detail: str) -> None:
        if self._is_ended:
            return
        self._is_ended = True
        self.limits.heard(self)
        if not self._has_answer:
            self.transport.write(_problem_bytes(status, code, detail))
        if self.cycle is not None:
            self.cycle.disconnected = True
            self.cycle.message_event.set()
        if code == TOO_MANY:
            self.transport.close()
            return
        # What a client still sends is read and discarded for a moment: a reset would discard the answer at the client.
        if self.transport.can_write_eof():
            self.transport.write_eof()
        self.loop.call_later(_LINGER_S, self.transport.abort)


def limited_protocol(limits: ConnectionLimits) -> type[LimitedProtocol]:
    """Return the protocol class for uvicorn's `http`."""
    return type("BoundLimitedProtocol", (LimitedProtocol,), {"limits": limits})


def raise_descriptor_limit(most_connections: int) -> int:
    """Raise the soft limit of descriptors as far as needed; return how many connections it leaves room for."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = most_connections + SPARE_DESCRIPTORS
    if soft != resource.RLIM_INFINITY and soft < wanted:
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    return (
        most_connections if soft == resource.RLIM_INFINITY else max(1, min(most_connections, soft - SPARE_DESCRIPTORS))
    )


def _problem_bytes(status: HTTPStatus, code: str, detail: str) -> bytes:
    problem = Problem(
        type=f"urn:quadpatch:problem:{code}",
        title=status.phrase,
        status=status.value,
        code=code,
        detail=detail,
        instance="urn:quadpatch:request:none",
        retryable=status == HTTPStatus.SERVICE_UNAVAILABLE,
    )
    body = json.dumps(problem.model_dump(mode="json", exclude_none=True)).encode()
    lines = [
        f"HTTP/1.1 {status.value} {status.phrase}",
        f"content-type: {PROBLEM_MEDIA_TYPE}",
        f"content-length: {len(body)}",
        "x-content-type-options: nosniff",
        "cache-control: no-store",
        *(["retry-after: 2"] if problem.retryable else []),
        "connection: close",
    ]
    return "\r\n".join([*lines, "", ""]).encode() + body
