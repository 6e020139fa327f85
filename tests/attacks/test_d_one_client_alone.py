"""Letter D: one client can't take the others down."""

import asyncio
import json
import resource
from collections.abc import Callable
from http.client import HTTPResponse
from socket import create_connection, socket

import httpx
import pytest
from starlette.testclient import TestClient
from starlette.types import Message, Receive, Scope, Send

from service import connections
from service.body_limit import BodyLimitMiddleware
from service.connections import MOST_HEAD_BYTES, ConnectionLimits, limited_protocol, raise_descriptor_limit
from service.services import Services
from tests.conftest import RunningService
from tests.waiting import GUARD_S, wait_until

HOST = b"Host: 127.0.0.1\r\n"


def connect(url: str) -> socket:
    host, _, port = url.removeprefix("http://").partition(":")
    return create_connection((host, int(port)), timeout=GUARD_S)


def answer_of(connection: socket) -> tuple[int, dict[str, object]]:
    """Read one answer; a connection that was closed without one is status 0."""
    answer = HTTPResponse(connection)
    try:
        answer.begin()
    except (ConnectionError, OSError):
        return 0, {}
    body = answer.read()
    return answer.status, json.loads(body) if body.startswith(b"{") else {}


@pytest.mark.parametrize(
    ("sent", "status", "code"),
    [
        (b"GET / HTTP/1.1\r\n" + HOST + b"X: " + b"x" * MOST_HEAD_BYTES + b"\r\n\r\n", 431, "header_too_large"),
        (b"GET / HTTP/1.1\r\n" + HOST + b"X: 1\r\n" * (MOST_HEAD_BYTES // 4), 431, "header_too_large"),
        (b"GET /" + b"x" * 2 * MOST_HEAD_BYTES, 431, "header_too_large"),
        (b"no HTTP at all\r\n\r\n", 400, "malformed_request"),
        (b"GET / HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", 400, "malformed_request"),
        (b"GET / HTTP/1.1\r\nHost: a\r\nX\x00Y: 1\r\n\r\n", 400, "malformed_request"),
    ],
)
def test_what_never_becomes_a_request_is_answered_with_a_problem(
    shared_service: RunningService, sent: bytes, status: int, code: str
) -> None:
    with connect(shared_service.url) as connection:
        connection.sendall(sent)
        found, problem = answer_of(connection)
        assert (found, problem.get("code")) == (status, code)
        assert problem["type"] == f"urn:quadpatch:problem:{code}"
        assert httpx.get(f"{shared_service.url}/healthz", timeout=GUARD_S).status_code == 200


async def _with_server(limits: ConnectionLimits, work: Callable[[int], object]) -> None:
    """Run `work` in a thread against a bare server of its own under these limits."""
    import uvicorn  # noqa: PLC0415 - these tests alone

    async def app(scope: dict[str, object], receive: Callable, send: Callable) -> None:  # type: ignore[type-arg]
        message = {"more_body": True}
        while message.get("more_body"):
            message = await receive()
        await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"0")]})
        await send({"type": "http.response.body", "body": b""})

    config = uvicorn.Config(app, http=limited_protocol(limits), ws="none", lifespan="off", log_config=None, port=0)
    config.load()
    server = uvicorn.Server(config)
    server.lifespan = config.lifespan_class(config)
    await server.startup()
    port = server.servers[0].sockets[0].getsockname()[1]
    try:
        await asyncio.to_thread(work, port)
    finally:
        server.force_exit = True
        await server.shutdown()


def test_heads_and_bodies_that_never_end_are_timed_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "_CLOCK_S", 0.05)
    statuses: list[int] = []

    def work(port: int) -> None:
        begun = (
            b"",
            b"GET / HTTP/1.1\r\nHost:",
            b"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 9\r\n\r\nx",
            b"GET / HTTP/1.1\r\nHost: a\r\n\r\nGET / HT",
        )
        for sent in begun:
            with connect(f"127.0.0.1:{port}") as connection:
                connection.sendall(sent)
                statuses.append(answer_of(connection)[0])

    asyncio.run(_with_server(ConnectionLimits(100, 0.2, 0.2), work))
    assert statuses == [0, 408, 408, 200]


def test_a_full_house_ends_the_connection_that_has_waited_longest() -> None:
    limits = ConnectionLimits(8)
    found: list[int] = []

    def work(port: int) -> None:
        silent = [connect(f"127.0.0.1:{port}") for _ in range(8)]
        wait_until(lambda: limits.n_open == 8)
        for _ in range(20):
            with connect(f"127.0.0.1:{port}") as connection:
                connection.sendall(b"GET / HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n")
                found.append(answer_of(connection)[0])
        found.append(answer_of(silent[0])[0])
        for connection in silent:
            connection.close()

    asyncio.run(_with_server(limits, work))
    assert found == [200] * 20 + [0]


def test_the_soft_limit_of_descriptors_is_raised_and_never_lowered() -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    try:
        resource.setrlimit(resource.RLIMIT_NOFILE, (512, hard))
        assert raise_descriptor_limit(400) == 400
        assert resource.getrlimit(resource.RLIMIT_NOFILE)[0] == 656
        assert raise_descriptor_limit(100) == 100
        assert resource.getrlimit(resource.RLIMIT_NOFILE)[0] == 656
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def test_bodies_under_way_are_counted_and_give_their_place_back() -> None:
    async def run() -> None:
        arrived, statuses = asyncio.Event(), list[int]()

        async def app(scope: Scope, receive: Receive, send: Send) -> None:
            await receive()
            await send({"type": "http.response.start", "status": 200, "headers": []})
            await send({"type": "http.response.body", "body": b""})

        async def body() -> Message:
            await arrived.wait()
            return {"type": "http.request", "body": b"x", "more_body": False}

        async def send(message: Message) -> None:
            if message["type"] == "http.response.start":
                statuses.append(message["status"])

        bounded = BodyLimitMiddleware(app, 2)
        scopes = [{"type": "http", "headers": [(b"content-length", b"1")], "state": {}} for _ in range(4)]
        slow = [asyncio.create_task(bounded(scope, body, send)) for scope in scopes[:2]]
        await asyncio.sleep(0)
        await bounded(scopes[2], body, send)
        assert statuses == [503]
        arrived.set()
        await asyncio.gather(*slow)
        await bounded(scopes[3], body, send)
        assert statuses == [503, 200, 200, 200]

    asyncio.run(run())


def test_readiness_and_the_document_are_worked_out_once_for_all(
    client: TestClient, services: Services, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[int] = []
    ping = services.database.ping

    def counted() -> None:
        looks.append(1)
        ping()

    monkeypatch.setattr(services.database, "ping", counted)
    client.app.state.readiness._clock = lambda: 0.0  # type: ignore[attr-defined]
    answers = {client.get("/readyz").status_code for _ in range(20)}
    assert len(answers) == 1
    assert len(looks) == 1
    first = client.get("/openapi.json").json()
    monkeypatch.setattr(client.app, "openapi", lambda: pytest.fail("it was written again"))
    assert client.get("/openapi.json").json() == first


def test_a_flood_of_analyses_does_not_pass_a_job_that_came_before(client: TestClient, services: Services) -> None:
    mesh = client.post("/v1/meshes", content=b"ply 0").json()["id"]
    job = client.post("/v1/jobs", json={"mesh_id": mesh, "method": {"method": "smooth"}}).json()["id"]
    for i in range(4):
        client.post("/v1/meshes", content=b"bomb %d" % i)
    names = services.queue._queue.get_job_ids()
    assert names[1] == f"{job}-1"
    assert names[0].startswith(f"mesh_{mesh}")
    assert all(name.startswith("mesh_") for name in names[2:])


def test_healthz_answers_while_clients_wait_and_stall(shared_service: RunningService) -> None:
    """A small edition of the flood: waiters, half-open requests and endless heads at once."""
    mesh = httpx.post(f"{shared_service.url}/v1/meshes", content=b"ply", timeout=GUARD_S).json()["id"]
    spec = {"mesh_id": mesh, "method": {"method": "smooth"}}
    job = httpx.post(f"{shared_service.url}/v1/jobs", json=spec, timeout=GUARD_S).json()["id"]
    held: list[socket] = []
    wait = b"GET /v1/jobs/%s HTTP/1.1\r\nHost: 127.0.0.1\r\nPrefer: wait=30\r\n\r\n" % job.encode()
    half = b"POST /v1/meshes HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9\r\n\r\n"
    try:
        for count, sent in ((300, wait), (300, half), (20, b"GET / HTTP/1.1\r\nX: 1\r\n")):
            for _ in range(count):
                held.append(connect(shared_service.url))
                held[-1].sendall(sent)
        with httpx.Client(base_url=shared_service.url, timeout=GUARD_S) as client:
            assert {client.get("/healthz").status_code for _ in range(50)} == {200}
    finally:
        for connection in held:
            connection.close()
