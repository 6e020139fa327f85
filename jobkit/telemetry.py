"""Traces for OpenTelemetry; none are sent without the extra `telemetry` and an OTEL_EXPORTER_OTLP_ENDPOINT.

The trace of a request goes on in the worker: its W3C `traceparent` is stored with the job that the request makes. Where
no traces are sent, spans are those of OpenTelemetry's API that do nothing.
"""

import logging
import os
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from typing import TYPE_CHECKING, Self

from opentelemetry.context import Context
from opentelemetry.trace import INVALID_SPAN, NoOpTracerProvider, Span, SpanKind, Tracer
from opentelemetry.trace.propagation.tracecontext import TraceContextTextMapPropagator

if TYPE_CHECKING:
    from opentelemetry.sdk.trace import TracerProvider

# The standard's own names: where to send spans, and what to call the sender.
ENDPOINT_VARIABLES = ("OTEL_EXPORTER_OTLP_ENDPOINT", "OTEL_EXPORTER_OTLP_TRACES_ENDPOINT")
NAME_VARIABLE = "OTEL_SERVICE_NAME"
_SCOPE = "quadpatch"

Attributes = Mapping[str, str | int | float | bool]

_log = logging.getLogger("quadpatch.telemetry")


class Telemetry:
    """Makes the spans of one process.

    Parameters
    ----------
    provider : TracerProvider, optional
        Where they go; None: nowhere.
    """

    def __init__(self, provider: "TracerProvider | None" = None) -> None:
        self._provider = provider
        self._tracer = (provider or NoOpTracerProvider()).get_tracer(_SCOPE)

    def span(
        self,
        name: str,
        kind: SpanKind = SpanKind.INTERNAL,
        parent: str | None = None,
        attributes: Attributes | None = None,
    ) -> AbstractContextManager[Span]:
        """Make a span for the length of a `with` block; spans within it are its children.

        Parameters
        ----------
        name : str
        kind : SpanKind
        parent : str, optional
            W3C `traceparent` of the span that it goes on from; one that can't be read starts a new trace. None: goes on
            from the span around it.
        attributes : mapping, optional
        """
        # A span that does nothing would hand on the trace of its parent.
        context = None if self._provider is None else _context_of(parent)
        return self._tracer.start_as_current_span(name, context, kind, attributes)

    @contextmanager
    def stages(self) -> Iterator["StageSpans"]:
        """Make spans for stages that follow each other; the last one ends with the `with` block."""
        stages = StageSpans(self._tracer)
        try:
            yield stages
        finally:
            stages.end()

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

    def __init__(self, tracer: Tracer) -> None:
        self._tracer = tracer
        self._stage = ""
        self._span: Span = INVALID_SPAN

    def reach(self, stage: str) -> None:
        """Note that the stage is at work now; does nothing where it already was."""
        if stage != self._stage:
            self._span.end()
            self._stage, self._span = stage, self._tracer.start_span(f"stage {stage}")

    def end(self) -> None:
        """End the stage at work."""
        self._span.end()
        self._stage, self._span = "", INVALID_SPAN


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
    attributes = {} if environment.get(NAME_VARIABLE) else {"service.name": f"quadpatch-{role}"}
    provider = TracerProvider(resource=Resource.create(attributes))
    provider.add_span_processor(BatchSpanProcessor(OTLPSpanExporter()))
    return Telemetry(provider)


def current_traceparent() -> str | None:
    """Return the W3C `traceparent` of the span at work, None where there is none."""
    carrier: dict[str, str] = {}
    TraceContextTextMapPropagator().inject(carrier)
    return carrier.get("traceparent")


def _context_of(parent: str | None) -> Context | None:
    return None if parent is None else TraceContextTextMapPropagator().extract({"traceparent": parent}, Context())
