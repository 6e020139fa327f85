import json
import time
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler
from typing import Any

import pytest

from quadpatch_client.errors import JobFailedError, WaitTimeoutError
from quadpatch_client.schema import PROBLEM_MEDIA_TYPE, Job
from quadpatch_client.sdk import Client
from quadpatch_client.watching import watch
from tests.quadpatch_client.wire_jobs import JOB_ID, PATH, body


def frame(number: int) -> str:
    return f'event: progress\ndata: {{"sequence": {number}}}\nid: {number}\n\n'


def sse(text: str, then: str = "end") -> Callable[[BaseHTTPRequestHandler], None]:
    """A stream, then its orderly `end`, a `break` of the line, or `silence`."""

    def send(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Type", "text/event-stream; charset=utf-8")
        handler.send_header("Transfer-Encoding", "chunked")
        handler.end_headers()
        handler.wfile.write(f"{len(text):x}\r\n{text}\r\n".encode())
        handler.wfile.flush()
        if then == "end":
            handler.wfile.write(b"0\r\n\r\n")
        elif then == "silence":
            time.sleep(1.0)
        if then != "end":
            handler.close_connection = True
            handler.connection.close()

    return send


def watched(server: Any, timeout_s: float | None = None) -> list[tuple[str, int]]:
    with Client(server.url) as client:
        return [(job.state.value, job.revision) for job in watch(client._transport, PATH, timeout_s)]


def streams_asked_for(server: Any) -> list[str]:
    return [headers["Last-Event-ID"] for _, path, headers, _ in server.requests if path.endswith("/events")]


def test_a_job_is_asked_for_once_for_each_piece_of_news(server: Any, answers: Any) -> None:
    get = answers["answer"]
    server.answers = [
        get(200, body("queued", 1)),
        # Events 2 and 3 arrive together, and the job that is then asked for shows both.
        sse(": hello\nretry: 1000\n\n" + frame(2) + frame(3) + frame(4)),
        get(200, body("running", 3)),
        get(200, body("succeeded", 4)),
    ]
    assert watched(server) == [("queued", 1), ("running", 3), ("succeeded", 4)]
    assert streams_asked_for(server) == ["1"]


def test_a_broken_stream_is_taken_up_after_what_the_job_shows(server: Any, answers: Any) -> None:
    get = answers["answer"]
    server.answers = [
        get(200, body("queued", 1)),
        sse(frame(2), then="break"),
        get(200, body("running", 2)),
        get(200, body("running", 5)),
        sse(frame(6)),
        get(200, body("succeeded", 6)),
    ]
    assert watched(server) == [("queued", 1), ("running", 2), ("running", 5), ("succeeded", 6)]
    assert streams_asked_for(server) == ["1", "5"]


def test_a_sign_of_life_is_an_occasion_to_see_the_place_in_the_queue(server: Any, answers: Any) -> None:
    get = answers["answer"]
    server.answers = [
        get(200, body("queued", 1, queue_position=2)),
        sse(": ping\n\n" + frame(2)),
        get(200, body("queued", 1, queue_position=1)),
        get(200, body("succeeded", 2)),
    ]
    seen: list[int | None] = []
    with Client(server.url) as client:
        client.wait(JOB_ID, lambda job: seen.append(job.queue_position))
    assert seen == [2, 1, None]


def test_an_older_service_without_streams_is_polled(server: Any, answers: Any) -> None:
    get = answers["answer"]
    page = get(200, b'{"items": [], "next_after": null}', Content_Type="application/json")
    server.answers = [get(200, body("queued", 1)), page, get(200, body("running", 2)), get(200, body("succeeded", 3))]
    with Client(server.url) as client:
        assert client.wait(JOB_ID).revision == 3
    assert len(streams_asked_for(server)) == 1


def test_a_service_with_too_many_streams_is_polled(server: Any, answers: Any) -> None:
    problem = {
        "type": "urn:quadpatch:problem:too_many_streams",
        "title": "Service Unavailable",
        "status": 503,
        "code": "too_many_streams",
        "detail": "the limit",
        "instance": "urn:quadpatch:request:1",
    }
    get = answers["answer"]
    busy = get(503, json.dumps(problem).encode(), Content_Type=PROBLEM_MEDIA_TYPE, Retry_After="2")
    error = {"code": "time_limit", "message": "too slow"}
    server.answers = [get(200, body("queued", 1)), busy, get(200, body("failed", 2, error=error))]
    with Client(server.url) as client, pytest.raises(JobFailedError, match="too slow"):
        client.wait(JOB_ID)


def test_waiting_ends_in_time_though_the_stream_stays_silent(server: Any, answers: Any) -> None:
    get = answers["answer"]
    server.answers = [get(200, body("running", 2)), sse(": hello\n\n", then="silence"), get(200, body("running", 2))]
    with Client(server.url) as client, pytest.raises(WaitTimeoutError):
        client.wait(JOB_ID, timeout_s=0.2)


def test_a_job_that_has_ended_needs_no_stream(server: Any, answers: Any) -> None:
    server.answers = [answers["answer"](200, body("succeeded", 9))]
    assert watched(server) == [("succeeded", 9)]
    assert streams_asked_for(server) == []
    assert Job.model_validate_json(body("succeeded", 9)).eta_s is None
