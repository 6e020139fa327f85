"""Bodies of requests under way: no more at a time than the service has memory and files for.

Tested in `tests/attacks/test_d_one_client_alone.py`.
"""

from http import HTTPStatus

from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.problems import RETRY_AFTER_S, ProblemError, problem_response


class BodiesMiddleware:
    """Counts requests whose body has not arrived yet, and refuses those that are too many.

    Parameters
    ----------
    app : ASGIApp
    most : int
        Bodies at the same time.
    """

    def __init__(self, app: ASGIApp, most: int) -> None:
        self._app = app
        self._most = most
        self._under_way = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer it with 503."""
        if scope["type"] != "http" or not has_body(scope):
            await self._app(scope, receive, send)
            return
        if self._under_way >= self._most:
            detail = f"{self._most} bodies are under way, which is the limit; come back later"
            headers = {"Retry-After": RETRY_AFTER_S}
            error = ProblemError(HTTPStatus.SERVICE_UNAVAILABLE, "too_many_bodies", detail, headers)
            await problem_response(Request(scope), error)(scope, receive, send)
            return
        await self._count(scope, receive, send)

    async def _count(self, scope: Scope, receive: Receive, send: Send) -> None:
        is_under_way = True
        self._under_way += 1

        def leave() -> None:
            nonlocal is_under_way
            self._under_way -= is_under_way
            is_under_way = False

        async def receive_and_note() -> Message:
            message = await receive()
            if message["type"] != "http.request" or not message.get("more_body", False):
                leave()
            return message

        try:
            await self._app(scope, receive_and_note, send)
        finally:
            leave()


def has_body(scope: Scope) -> bool:
    """Return whether a request announces a body; an empty one is none."""
    headers = dict(scope["headers"])
    return b"transfer-encoding" in headers or headers.get(b"content-length", b"0").strip(b"0 ") != b""
