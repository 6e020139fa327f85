"""The outermost middleware: an id and security headers for every request, and an answer to every exception."""

import logging
import re
import uuid
from collections.abc import Mapping

from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from jobkit.logs import log_about
from service.problems import internal_error, problem_response

_logger = logging.getLogger("service")
_REQUEST_ID = re.compile(r"^[A-Za-z0-9._-]{1,64}$")
_DEFAULT_HEADERS: Mapping[str, str] = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Content-Security-Policy": "default-src 'none'; frame-ancestors 'none'",
    "Cache-Control": "no-store",
}


class RequestContextMiddleware:
    """Gives each request an id, each response its headers, and each fault a problem document and a log entry."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Run the app, and answer an exception that it raises."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope, receive)
        sent = request.headers.get("x-request-id", "")
        request.state.request_id = sent if _REQUEST_ID.match(sent) else str(uuid.uuid4())
        has_started = False

        async def send_with_headers(message: Message) -> None:
            nonlocal has_started
            if message["type"] == "http.response.start":
                has_started = True
                headers = MutableHeaders(scope=message)
                headers["X-Request-Id"] = request.state.request_id
                for name, value in _DEFAULT_HEADERS.items():
                    headers.setdefault(name, value)
            await send(message)

        with log_about(request_id=request.state.request_id):
            try:
                await self._app(scope, receive, send_with_headers)
            except Exception:  # the outermost handler of a request
                _logger.exception("%s %s failed", request.method, scope["path"])
                if has_started:
                    raise  # the connection breaks, so that the client sees that the body is not whole
                await problem_response(request, internal_error())(scope, receive, send_with_headers)
