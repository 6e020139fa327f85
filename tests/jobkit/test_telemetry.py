import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from opentelemetry.sdk.trace import ReadableSpan, TracerProvider
from opentelemetry.sdk.trace.export import SimpleSpanProcessor
from opentelemetry.sdk.trace.export.in_memory_span_exporter import InMemorySpanExporter
from opentelemetry.trace import SpanKind, StatusCode

from jobkit.telemetry import Telemetry, current_traceparent, open_telemetry
from tests.waiting import GUARD_S


class Recorded:
    """Telemetry whose spans stay in memory."""

    def __init__(self) -> None:
        self._exporter = InMemorySpanExporter()
        provider = TracerProvider()
        provider.add_span_processor(SimpleSpanProcessor(self._exporter))
        self.telemetry = Telemetry(provider)

    def spans(self) -> dict[str, ReadableSpan]:
        return {span.name: span for span in self._exporter.get_finished_spans()}


def times(span: ReadableSpan) -> tuple[int, int]:
    """Return when a span began and ended, in nanoseconds."""
    assert span.start_time is not None
    assert span.end_time is not None
    return span.start_time, span.end_time


@pytest.fixture
def recorded() -> Recorded:
    return Recorded()


def test_a_trace_goes_on_from_where_it_was_written_down(recorded: Recorded) -> None:
    with recorded.telemetry.span("POST /v1/jobs", SpanKind.SERVER):
        written = current_traceparent()
    assert current_traceparent() is None
    with recorded.telemetry.span("attempt", SpanKind.CONSUMER, written, {"quadpatch.attempt": 2}):
        pass
    request, attempt = recorded.spans()["POST /v1/jobs"], recorded.spans()["attempt"]
    assert attempt.parent is not None
    assert attempt.parent.span_id == request.context.span_id
    assert attempt.context.trace_id == request.context.trace_id
    assert attempt.kind is SpanKind.CONSUMER
    assert attempt.attributes == {"quadpatch.attempt": 2}


def test_stages_follow_each_other_within_the_attempt(recorded: Recorded) -> None:
    with recorded.telemetry.span("attempt") as span:
        with recorded.telemetry.stages() as stages:
            for stage in ("read", "read", "fill", "write"):
                stages.reach(stage)
        span.set_attribute("quadpatch.state", "failed")
        span.set_status(StatusCode.ERROR, "it was lost")
    spans = recorded.spans()
    assert list(spans) == ["stage read", "stage fill", "stage write", "attempt"]
    attempt = spans.pop("attempt")
    assert attempt.attributes == {"quadpatch.state": "failed"}
    assert not attempt.status.is_ok
    before, _ = times(attempt)
    for stage_span in spans.values():
        assert stage_span.parent is not None
        assert stage_span.parent.span_id == attempt.context.span_id
        start, end = times(stage_span)
        assert start >= before
        before = end


@given(header=st.text(max_size=80))
def test_an_unreadable_header_starts_a_trace_of_its_own(header: str) -> None:
    recorded = Recorded()
    with recorded.telemetry.span("around"), recorded.telemetry.span("request", SpanKind.SERVER, header):
        pass
    assert recorded.spans()["request"].parent is None


def test_without_an_address_nothing_is_made() -> None:
    with open_telemetry("api", {}) as telemetry, telemetry.span("attempt") as span, telemetry.stages() as stages:
        stages.reach("read")
        span.set_attribute("quadpatch.state", "failed")
        span.update_name("other")
        span.set_status(StatusCode.ERROR, "it was lost")
        assert current_traceparent() is None


def test_with_an_address_spans_are_made() -> None:
    # Nothing listens there; what could not be sent is dropped when the process ends.
    environment = {"OTEL_EXPORTER_OTLP_ENDPOINT": "http://127.0.0.1:1"}
    telemetry = open_telemetry("api", environment)
    with telemetry.span("attempt"):
        assert current_traceparent() is not None


def test_the_library_is_needed_only_where_traces_are_sent() -> None:
    """Without the extra there is a warning, and no trace."""
    code = """
import sys, logging
sys.modules["opentelemetry.sdk"] = None
from jobkit.telemetry import current_traceparent, open_telemetry
logging.basicConfig()
for endpoint in ("", "http://127.0.0.1:1"):
    with open_telemetry("api", {"OTEL_EXPORTER_OTLP_ENDPOINT": endpoint}) as telemetry, telemetry.span("attempt"):
        print(current_traceparent())
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=GUARD_S, check=True)
    assert ended.stdout.split() == ["None", "None"]
    assert ended.stderr.count("the extra `telemetry` is not installed") == 1
