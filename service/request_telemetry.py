"""What requests do to this process: their counts and times for Prometheus, and a span each."""

import time

from opentelemetry.trace import INVALID_SPAN, Span, SpanKind, StatusCode
from prometheus_client import CollectorRegistry, Histogram
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from jobkit.telemetry import Telemetry

_METHODS = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})
# Asked every few seconds by machines: spans of them would bury the others.
_UNTRACED = frozenset({"/healthz", "/readyz", "/metrics"})
# Seconds. Polling is to be answered in milliseconds; an upload, or `Prefer: wait`, takes up to a minute.
_BUCKETS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0)


class RequestTelemetryMiddleware:
    """Counts each request under the template of its route, never under its path: ids have no end.

    Parameters
    ----------
    app : ASGIApp
    registry : CollectorRegistry
        Where its histogram lives.
    telemetry : Telemetry
    """

    def __init__(self, app: ASGIApp, registry: CollectorRegistry, telemetry: Telemetry) -> None:
        self._app = app
        self._telemetry = telemetry
        self._seconds = Histogram(
            "quadpatch_http_request_duration_seconds",
            "Seconds until the answer began, by route, method and status.",
            ("method", "route", "status"),
            buckets=_BUCKETS,
            registry=registry,
        )

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, and note how it was answered."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        method = request.method if request.method in _METHODS else "other"
        if scope["path"] in _UNTRACED:
            await self._observed(method, INVALID_SPAN, scope, receive, send)
            return
        parent = request.headers.get("traceparent")
        with self._telemetry.span(method, SpanKind.SERVER, parent, {"http.request.method": method}) as span:
            await self._observed(method, span, scope, receive, send)

    async def _observed(self, method: str, span: Span, scope: Scope, receive: Receive, send: Send) -> None:
        started = time.perf_counter()

        async def send_and_note(message: Message) -> None:
            if message["type"] == "http.response.start":
                route, status = _route(scope), str(message["status"])
                self._seconds.labels(method, route, status).observe(time.perf_counter() - started)
                _describe(span, method, route, message["status"])
            await send(message)

        await self._app(scope, receive, send_and_note)


def _route(scope: Scope) -> str:
    """Return the template of the route that the router found, `none` where it found nothing or was not asked."""
    return str(getattr(scope.get("route"), "path", "none"))


def _describe(span: Span, method: str, route: str, status: int) -> None:
    span.update_name(f"{method} {route}")
    span.set_attribute("http.route", route)
    span.set_attribute("http.response.status_code", status)
    if status >= 500:
        span.set_status(StatusCode.ERROR, f"answered with {status}")
