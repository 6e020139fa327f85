"""A limit on the request bodies that arrive at the same time: each takes memory and a file.

Tested in `tests/attacks/test_d_one_client_alone.py`.
"""

from http import HTTPStatus

from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.problems import RETRY_AFTER_S, ProblemError, problem_response


class BodyLimitMiddleware:
    """Counts requests whose body has not arrived yet, and refuses those over the limit.

    Parameters
    ----------
    app : ASGIApp
    most : int
        Bodies at the same time.
    """

    def __init__(self, app: ASGIApp, most: int) -> None:
        self._app = app
        self._most = most
        self._n_receiving = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer it with 503."""
        if scope["type"] != "http" or not has_body(scope):
            await self._app(scope, receive, send)
            return
        if self._n_receiving >= self._most:
            detail = f"{self._most} bodies are under way, which is the limit; come back later"
            headers = {"Retry-After": RETRY_AFTER_S}
            error = ProblemError(HTTPStatus.SERVICE_UNAVAILABLE, "too_many_bodies", detail, headers)
            await problem_response(Request(scope), error)(scope, receive, send)
            return
        await self._count(scope, receive, send)

    async def _count(self, scope: Scope, receive: Receive, send: Send) -> None:
        is_receiving = True
        self._n_receiving += 1

        def finish() -> None:
            nonlocal is_receiving
            self._n_receiving -= is_receiving
            is_receiving = False

        async def receive_counted() -> Message:
            message = await receive()
            if message["type"] != "http.request" or not message.get("more_body", False):
                finish()
            return message

        try:
            await self._app(scope, receive_counted, send)
        finally:
            finish()


def has_body(scope: Scope) -> bool:
    """Return whether a request announces a body; an empty one is none."""
    headers = dict(scope["headers"])
    return b"transfer-encoding" in headers or headers.get(b"content-length", b"0").strip(b"0 ") != b""
