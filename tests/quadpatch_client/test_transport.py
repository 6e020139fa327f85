"""Also tests `quadpatch_client.patience`."""

import json
import socket
from typing import Any

import httpx
import pytest

from quadpatch_client.errors import AnswerError, RefusedError, UnreachableError
from quadpatch_client.patience import Line, Patience, retry_after_s
from quadpatch_client.schema import PROBLEM_MEDIA_TYPE
from quadpatch_client.transport import Transport
from tests.waiting import GUARD_S

PROBLEM = json.dumps(
    {
        "type": "urn:quadpatch:problem:mesh_not_found",
        "title": "Not Found",
        "status": 404,
        "code": "mesh_not_found",
        "detail": "there is no such mesh",
        "instance": "urn:quadpatch:request:1",
    }
).encode()
BUSY = PROBLEM.replace(b"404", b"503").replace(b"mesh_not_found", b"queue_unavailable")


def test_a_request_is_repeated_after_a_dropped_line(server: Any, answers: Any) -> None:
    server.answers = [answers["hang_up"](), answers["hang_up"](), answers["answer"](200, b'{"a": 1}')]
    with Transport(server.url) as transport:
        response = transport.request("POST", "/v1/x", content=lambda: iter([b"part", b"s"]))
    assert response.json() == {"a": 1}
    assert [body for _, _, _, body in server.requests] == [b"parts"] * 3


@pytest.mark.parametrize("status", [429, 503, 507])
def test_a_busy_service_is_asked_again_after_the_time_it_names(server: Any, answers: Any, status: int) -> None:
    busy = answers["answer"](status, BUSY, Content_Type=PROBLEM_MEDIA_TYPE, Retry_After="1")
    server.answers = [busy, answers["answer"](200)]
    with Transport(server.url) as transport:
        assert transport.request("GET", "/").is_success
    assert len(server.requests) == 2


def test_a_service_that_stays_busy_is_reported_with_its_own_problem(server: Any, answers: Any) -> None:
    busy = answers["answer"](503, BUSY, Content_Type=PROBLEM_MEDIA_TYPE)
    for_long = answers["answer"](503, BUSY, Content_Type=PROBLEM_MEDIA_TYPE, Retry_After="9999")
    server.answers = [busy, for_long]
    with Transport(server.url, patience_s=GUARD_S) as transport, pytest.raises(RefusedError) as caught:
        transport.request("GET", "/")
    assert caught.value.problem.code == "queue_unavailable"
    assert len(server.requests) == 2


def test_a_quota_that_stays_used_up_is_told_in_the_words_of_the_service(server: Any, answers: Any) -> None:
    full = {"status": 429, "code": "quota_jobs", "detail": "7 jobs of tenant plant-north wait; the limit is 7"}
    problem = json.dumps({**json.loads(PROBLEM), **full, "quota": {"limit": 7, "used": 7}}).encode()
    server.answers = [answers["answer"](429, problem, Content_Type=PROBLEM_MEDIA_TYPE, Retry_After="9999")]
    with Transport(server.url, patience_s=GUARD_S) as transport, pytest.raises(RefusedError) as caught:
        transport.request("POST", "/")
    assert str(caught.value) == "7 jobs of tenant plant-north wait; the limit is 7 (quota_jobs)"
    assert (caught.value.problem.quota and caught.value.problem.quota.limit) == 7


@pytest.mark.parametrize("path", ["", "/", "/v1", "/v1/"])
def test_an_address_may_end_with_the_beginning_of_its_paths(server: Any, answers: Any, path: str) -> None:
    server.answers = [answers["answer"](200)]
    with Transport(f"{server.url}{path}") as transport:
        assert transport.request("GET", "/v1/version").is_success
    assert [asked for _, asked, _, _ in server.requests] == ["/v1/version"]


def test_a_quota_that_waiting_does_not_change_is_told_at_once(server: Any, answers: Any) -> None:
    server.answers = [answers["answer"](507, PROBLEM.replace(b"404", b"507"), Content_Type=PROBLEM_MEDIA_TYPE)]
    with Transport(server.url, patience_s=GUARD_S) as transport, pytest.raises(RefusedError):
        transport.request("POST", "/")
    assert len(server.requests) == 1


def test_a_key_that_is_not_taken_is_told_in_options_of_the_client(server: Any, answers: Any) -> None:
    words = {"status": 401, "code": "unauthorized", "detail": "send a valid key as 'X-API-Key: KEY'"}
    problem = json.dumps({**json.loads(PROBLEM), **words}).encode()
    server.answers = [answers["answer"](401, problem, Content_Type=PROBLEM_MEDIA_TYPE)]
    with Transport(server.url) as transport, pytest.raises(RefusedError) as caught:
        transport.request("GET", "/")
    assert str(caught.value) == (
        "the key is missing or not valid: --api-key or QUADPATCH_CLIENT_API_KEY (`quadpatch-client doctor` looks) "
        "(unauthorized)"
    )


def test_a_problem_is_raised_at_once_with_its_code(server: Any, answers: Any) -> None:
    server.answers = [answers["answer"](404, PROBLEM, Content_Type=PROBLEM_MEDIA_TYPE)]
    with Transport(server.url) as transport, pytest.raises(RefusedError, match="there is no such mesh") as caught:
        transport.request("GET", "/")
    assert caught.value.problem.code == "mesh_not_found"
    assert len(server.requests) == 1


@pytest.mark.parametrize("body", [b"<html>", b'{"code": 3}'])
def test_an_error_of_another_program_is_told_apart(server: Any, answers: Any, body: bytes) -> None:
    server.answers = [answers["answer"](404, body, Content_Type=PROBLEM_MEDIA_TYPE)]
    with Transport(server.url) as transport, pytest.raises(AnswerError, match="is it the right address"):
        transport.request("GET", "/")


def test_a_port_without_a_server_is_unreachable() -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with Transport(f"http://127.0.0.1:{port}", patience_s=0.3) as transport, pytest.raises(UnreachableError):
        transport.request("GET", "/")


def test_the_key_travels_as_a_bearer_token(server: Any, answers: Any) -> None:
    server.answers = [answers["answer"](200)]
    with Transport(server.url, api_key="0123456789abcdef") as transport:
        transport.request("GET", "/")
    assert server.requests[0][2]["Authorization"] == "Bearer 0123456789abcdef"


def test_pauses_grow_until_patience_ends_and_begin_anew_with_bytes() -> None:
    now = 0.0
    line = Line("http://x", patience_s=60.0, first_contact_s=5.0)
    patience = Patience(line, lambda: now)
    error = httpx.ReadError("broken")
    pauses = [patience.pause_s(error) for _ in range(6)]
    assert all(
        0.75 * least <= pause <= 1.25 * least for pause, least in zip(pauses, (0.25, 0.5, 1, 2, 4, 5), strict=True)
    )
    now = 59.9
    assert patience.pause_s(error, done=1) < 0.5
    now = 120.0
    with pytest.raises(UnreachableError, match="no answer from http://x within 60 s: broken"):
        patience.pause_s(error, done=1)


def test_a_service_that_was_never_reached_is_given_up_sooner() -> None:
    now = 0.0
    patience = Patience(Line("http://x", patience_s=60.0, first_contact_s=5.0), lambda: now)
    patience.pause_s(httpx.ConnectError("refused"))
    now = 5.0
    with pytest.raises(UnreachableError, match="within 5 s: refused"):
        patience.pause_s(httpx.ConnectError("refused"))


@pytest.mark.parametrize(
    ("text", "least", "most"),
    [("7", 7.0, 7.0), ("Fri, 31 Dec 2100 23:59:59 GMT", 1e9, 1e11), ("Mon, 30 Nov 2020 12:00:00 GMT", 0.0, 0.0)],
)
def test_retry_after_is_seconds_or_a_moment(text: str, least: float, most: float) -> None:
    seconds = retry_after_s(httpx.Response(503, headers={"Retry-After": text}))
    assert seconds is not None
    assert least <= seconds <= most
    assert retry_after_s(httpx.Response(503, headers={"Retry-After": "soon"})) is None
