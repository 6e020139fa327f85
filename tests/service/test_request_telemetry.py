from collections.abc import Callable, Iterator

import pytest
from opentelemetry.sdk.trace import ReadableSpan, TracerProvider
from opentelemetry.sdk.trace.export import SimpleSpanProcessor
from opentelemetry.sdk.trace.export.in_memory_span_exporter import InMemorySpanExporter
from opentelemetry.trace import SpanKind
from starlette.testclient import TestClient

from jobkit.settings import Settings
from jobkit.telemetry import Telemetry
from service.app import create_app
from service.services import Services

TRACE = "0af7651916cd43dd8448eb211c80319c"
SENT = f"00-{TRACE}-b7ad6b7169203331-01"


@pytest.fixture
def exporter() -> InMemorySpanExporter:
    return InMemorySpanExporter()


@pytest.fixture
def client(settings: Settings, exporter: InMemorySpanExporter) -> Iterator[TestClient]:
    provider = TracerProvider()
    provider.add_span_processor(SimpleSpanProcessor(exporter))
    with TestClient(create_app(settings, Telemetry(provider)), base_url="http://127.0.0.1") as client:
        yield client


def only(exporter: InMemorySpanExporter, name: str) -> ReadableSpan:
    (span,) = [span for span in exporter.get_finished_spans() if span.name == name]
    return span


def test_a_request_is_a_span_named_by_its_route(client: TestClient, exporter: InMemorySpanExporter) -> None:
    client.get("/v1/jobs/job_0000000000000000000000000a", headers={"traceparent": SENT})
    span = only(exporter, "GET /v1/jobs/{job_id}")
    assert span.kind is SpanKind.SERVER
    assert span.parent is not None
    assert f"{span.parent.trace_id:032x}" == TRACE
    assert span.attributes == {
        "http.request.method": "GET",
        "http.route": "/v1/jobs/{job_id}",
        "http.response.status_code": 404,
    }
    assert span.status.is_unset


def test_a_request_that_the_service_fails_is_a_span_that_failed(
    client: TestClient, services: Services, exporter: InMemorySpanExporter, break_store: Callable[[], None]
) -> None:
    break_store()
    assert client.post("/v1/meshes?filename=a.ply", content=b"ply").status_code == 503
    assert not only(exporter, "POST /v1/meshes").status.is_ok


def test_questions_of_machines_about_health_make_no_spans(client: TestClient, exporter: InMemorySpanExporter) -> None:
    for path in ("/healthz", "/readyz", "/metrics"):
        assert client.get(path).status_code == 200
    assert exporter.get_finished_spans() == ()


def test_a_job_keeps_the_ids_of_the_request_that_made_it(
    client: TestClient, services: Services, exporter: InMemorySpanExporter, mesh_id: str
) -> None:
    headers = {"traceparent": SENT, "X-Request-Id": "station-4.17"}
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}}, headers=headers)
    started = services.attempts.start(answer.json()["id"], "w", 30)
    span = only(exporter, "POST /v1/jobs")
    assert started.request_id == "station-4.17"
    assert started.traceparent == f"00-{TRACE}-{span.context.span_id:016x}-01"


def test_without_traces_a_job_keeps_the_request_alone(settings: Settings) -> None:
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        services: Services = client.app.state.services  # type: ignore[attr-defined]
        mesh = client.post("/v1/meshes?filename=a.ply", content=b"ply").json()
        spec = {"mesh_id": mesh["id"], "method": {"method": "smooth"}}
        answer = client.post("/v1/jobs", json=spec, headers={"traceparent": SENT})
        started = services.attempts.start(answer.json()["id"], "w", 30)
    assert started.request_id == answer.headers["x-request-id"]
    # Nor did it come with a key.
    assert (started.traceparent, started.asked_by) == (None, None)
