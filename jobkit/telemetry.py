"""Traces for OpenTelemetry; nothing happens without the extra `telemetry` and an OTEL_EXPORTER_OTLP_ENDPOINT.

The trace of a request goes on in the worker: its W3C `traceparent` is stored with the job that the request makes. The
library is imported here alone, and only where traces are sent.
"""

import logging
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from opentelemetry.context import Context
    from opentelemetry.sdk.trace import TracerProvider
    from opentelemetry.trace import Span as OtelSpan
    from opentelemetry.trace import Tracer

# The standard's own names: where to send spans, and what to call the sender.
ENDPOINT_VARIABLES = ("OTEL_EXPORTER_OTLP_ENDPOINT", "OTEL_EXPORTER_OTLP_TRACES_ENDPOINT")
NAME_VARIABLE = "OTEL_SERVICE_NAME"
_SCOPE = "quadpatch"

Attributes = Mapping[str, str | int | float | bool]

_log = logging.getLogger("quadpatch.telemetry")


class Span:
    """Something that takes time, and what is known of it; no-op where no traces are sent."""

    def __init__(self, span: "OtelSpan | None" = None) -> None:
        self._span = span

    def note(self, name: str, value: str | int | float | bool) -> None:
        """Set an attribute."""
        if self._span is not None:
            self._span.set_attribute(name, value)

    def rename(self, name: str) -> None:
        """Give it the name that only its course has shown."""
        if self._span is not None:
            self._span.update_name(name)

    def fail(self, reason: str) -> None:
        """Say that it went wrong."""
        if self._span is not None:
            from opentelemetry.trace import Status, StatusCode  # noqa: PLC0415 - an extra

            self._span.set_status(Status(StatusCode.ERROR, reason))

    def end(self) -> None:
        """End it now."""
        if self._span is not None:
            self._span.end()


class Telemetry:
    """Makes the spans of one process.

    Parameters
    ----------
    provider : TracerProvider, optional
        Where they go; None: nowhere.
    """

    def __init__(self, provider: "TracerProvider | None" = None) -> None:
        self._provider = provider
        self._tracer: Tracer | None = None if provider is None else provider.get_tracer(_SCOPE)

    @contextmanager
    def span(
        self, name: str, kind: str = "internal", parent: str | None = None, attributes: Attributes | None = None
    ) -> Iterator[Span]:
        """Make a span for the length of a `with` block; spans within it are its children.

        Parameters
        ----------
        name : str
        kind : str
            `server`, `consumer` or `internal`.
        parent : str, optional
            W3C `traceparent` of the span that it goes on from; one that can't be read starts a new trace. None: goes on
            from the span around it.
        attributes : mapping, optional
        """
        if self._tracer is None:
            yield Span()
            return
        from opentelemetry.trace import SpanKind  # noqa: PLC0415 - an extra

        with self._tracer.start_as_current_span(
            name, _context_of(parent), SpanKind[kind.upper()], dict(attributes or {})
        ) as span:
            yield Span(span)

    @contextmanager
    def stages(self) -> Iterator["StageSpans"]:
        """Make spans for stages that follow each other; the last one ends with the `with` block."""
        stages = StageSpans(self)
        try:
            yield stages
        finally:
            stages.end()

    def child(self, name: str) -> Span:
        """Start a span that is ended by hand, within the one around it."""
        return Span() if self._tracer is None else Span(self._tracer.start_span(name))

    def close(self) -> None:
        """Send what is left."""
        if self._provider is not None:
            self._provider.shutdown()

    def __enter__(self) -> Self:
        """Nothing to open."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()


class StageSpans:
    """One span for each stage of a repair, as they are reached."""

    def __init__(self, telemetry: Telemetry) -> None:
        self._telemetry = telemetry
        self._stage = ""
        self._span = Span()

    def reach(self, stage: str) -> None:
        """Note that the stage is at work now; does nothing where it already was."""
        if stage != self._stage:
            self._span.end()
            self._stage, self._span = stage, self._telemetry.child(f"stage {stage}")

    def end(self) -> None:
        """End the stage at work."""
        self._span.end()
        self._stage, self._span = "", Span()


def open_telemetry(role: str, environment: Mapping[str, str] = os.environ) -> Telemetry:
    """Send traces where the environment says, or nowhere where it does not.

    Parameters
    ----------
    role : str
        `api` or `worker`; the sender's name is `quadpatch-ROLE` unless OTEL_SERVICE_NAME says otherwise.
    environment : mapping
    """
    if not any(environment.get(name) for name in ENDPOINT_VARIABLES):
        return Telemetry()
    try:
        from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter  # noqa: PLC0415 - an extra
        from opentelemetry.sdk.resources import Resource  # noqa: PLC0415
        from opentelemetry.sdk.trace import TracerProvider  # noqa: PLC0415
        from opentelemetry.sdk.trace.export import BatchSpanProcessor  # noqa: PLC0415
    except ImportError:
        _log.warning("traces are asked for, but the extra `telemetry` is not installed: none are sent")
        return Telemetry()
    named = {} if environment.get(NAME_VARIABLE) else {"service.name": f"quadpatch-{role}"}
    provider = TracerProvider(resource=Resource.create(named))
    provider.add_span_processor(BatchSpanProcessor(OTLPSpanExporter()))
    return Telemetry(provider)


def current_traceparent() -> str | None:
    """Return the W3C `traceparent` of the span at work, None where there is none."""
    try:
        from opentelemetry.trace.propagation.tracecontext import (  # noqa: PLC0415 - an extra
            TraceContextTextMapPropagator,
        )
    except ImportError:
        return None
    carrier: dict[str, str] = {}
    TraceContextTextMapPropagator().inject(carrier)
    return carrier.get("traceparent")


def _context_of(parent: str | None) -> "Context | None":
    if parent is None:
        return None
    from opentelemetry.context import Context  # noqa: PLC0415 - an extra
    from opentelemetry.trace.propagation.tracecontext import TraceContextTextMapPropagator  # noqa: PLC0415

    return TraceContextTextMapPropagator().extract({"traceparent": parent}, Context())
