"""Letter B: the Host header decides who is asking; the path never follows it."""

import ast
import tomllib
from collections.abc import Iterator
from http.client import HTTPResponse
from pathlib import Path
from socket import create_connection

import httptools
import pytest
from hypothesis import given
from hypothesis import strategies as st
from packaging.requirements import Requirement
from packaging.version import Version
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.settings import Settings
from service.app import create_app
from service.host_header import Authority, parse_authority, parse_origin
from tests.conftest import RunningService
from tests.waiting import GUARD_S

KEY = "a-key-of-station-1"
PARSES = [
    ("127.0.0.1:8000", Authority("127.0.0.1", 8000)),
    ("LocalHost", Authority("localhost", 80)),
    ("[::1]:8000", Authority("::1", 8000)),
    ("[0:0:0:0:0:0:0:1]", Authority("::1", 80)),
    ("scan_box.plant.example:443", Authority("scan_box.plant.example", 443)),
]
DOES_NOT_PARSE = [
    "a{b.attacker.example",
    "x/healthz?",
    "127.0.0.1/",
    "user@127.0.0.1",
    "127.0.0.1:80@attacker.example",
    "127.0.0.1 attacker.example",
    "127.0.0.1:port",
    "127.0.0.1:99999",
    "[::1",
    "[::1]x",
    "[12]",
    "::1",
    "127.0.0.1#",
    "127.0.0.1\\@attacker.example",
    "%31",
    "",
    "\xb2",
]


def exchange(url: str, request: bytes) -> tuple[int, bytes]:
    """Send bytes as they are and return the status and the body of the answer."""
    host, _, port = url.removeprefix("http://").partition(":")
    with create_connection((host, int(port)), timeout=GUARD_S) as connection:
        connection.sendall(request)
        answer = HTTPResponse(connection)
        answer.begin()
        return answer.status, answer.read()


@pytest.fixture
def guarded(settings: Settings) -> Iterator[TestClient]:
    keyed = settings.model_copy(update={"api_keys": SecretStr(KEY), "host": "0.0.0.0"})
    with TestClient(create_app(keyed), base_url="http://scanner.example") as client:
        yield client


@pytest.mark.parametrize(("text", "expected"), PARSES)
def test_a_host_is_compared_in_one_form(text: str, expected: Authority) -> None:
    assert parse_authority(text, "http") == expected


@pytest.mark.parametrize("text", DOES_NOT_PARSE)
def test_what_is_no_host_names_nothing(text: str) -> None:
    assert parse_authority(text, "http") is None


@given(st.text(max_size=40))
def test_any_text_parses_or_names_nothing(text: str) -> None:
    for found in (parse_authority(text, "http"), parse_origin(text), parse_origin(f"http://{text}")):
        assert found is None or (set(found.host).isdisjoint("/@?#{}[] \\") and found.port <= 65_535)


def test_a_service_without_keys_answers_to_its_own_names_alone(shared_service: RunningService) -> None:
    keyless_url = shared_service.url
    for host in ("127.0.0.1", "localhost:1", "[::1]:8000"):
        assert exchange(keyless_url, f"GET /v1/jobs HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())[0] == 200
    for host in ("attacker.example", "127.0.0.1.attacker.example", "localhost.", "127.0.0.2"):
        assert exchange(keyless_url, f"GET /v1/jobs HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())[0] == 403
    for host in DOES_NOT_PARSE:
        assert exchange(keyless_url, f"GET /v1/jobs HTTP/1.1\r\nHost: {host}\r\n\r\n".encode("latin-1"))[0] == 400
    for request, status in (
        (b"GET /v1/jobs HTTP/1.1\r\n\r\n", 400),
        (b"GET /v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nHost: 127.0.0.1\r\n\r\n", 400),
        (b"GET /v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nHost: attacker.example\r\n\r\n", 400),
        (b"GET /v1/jobs HTTP/1.0\r\n\r\n", 403),
    ):
        assert exchange(keyless_url, request)[0] == status, request


@pytest.mark.parametrize("host", ["x/healthz?", "x/healthz#", "x/metrics?", "a{b", "[", "scanner.example/"])
def test_no_host_opens_a_path_that_asks_for_a_key(guarded: TestClient, host: str) -> None:
    for path in ("/v1/jobs", "/v1/models", "/nothing"):
        assert guarded.get(path, headers={"Host": host}).status_code in (400, 401)


@pytest.mark.parametrize("path", ["/healthz//", "/healthz/", "/healthz/../v1/jobs", "/v1/jobs;/healthz", "/%68ealthz?"])
def test_a_path_is_public_only_if_the_router_finds_that_route(guarded: TestClient, path: str) -> None:
    answer = guarded.get(path)
    assert answer.status_code == 401 or answer.json() == {"status": "ok"}


@pytest.mark.parametrize(
    "origin",
    [
        "null",
        "http://[",
        "http://attacker.example",
        "http://127.0.0.1.attacker.example",
        "http://127.0.0.1:81",
        "http://127.0.0.1/attacker.example",
        "file://127.0.0.1",
        "http://a{b",
    ],
)
def test_pages_of_other_origins_change_nothing(settings: Settings, origin: str) -> None:
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        answer = client.post("/v1/meshes", content=b"ply", headers={"Origin": origin})
        assert (answer.status_code, answer.json()["code"]) == (403, "foreign_origin")
        assert client.post("/v1/meshes", content=b"ply", headers={"Origin": "http://127.0.0.1"}).status_code == 201


def test_the_service_asks_no_library_what_was_requested() -> None:
    """`request.url` and `request.base_url` follow the Host header, or guess where it does not parse."""
    found = [
        f"{path.name}:{node.lineno}"
        for path in sorted(Path("service").rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Attribute) and node.attr in ("url", "base_url", "url_for")
        if isinstance(node.value, ast.Name) and "request" in node.value.id
    ]
    assert found == []


def test_the_parser_leaves_a_host_as_it_is() -> None:
    """What stands above relies on it: the header reaches the service byte for byte."""
    seen: list[tuple[bytes, bytes]] = []

    class Taker:
        def on_header(self, name: bytes, value: bytes) -> None:
            seen.append((name, value))

    httptools.HttpRequestParser(Taker()).feed_data(b"GET / HTTP/1.1\r\nHost: a{b/x?\r\n\r\n")
    assert seen == [(b"Host", b"a{b/x?")]


def test_no_older_library_stands_in_front_than_is_tested() -> None:
    """Starlette 0.52 took the path from Host; the lower bounds are what constraints.txt pins, up to patches."""
    project = tomllib.loads(Path("pyproject.toml").read_text("utf-8"))
    needed = {r.name: r for r in map(Requirement, project["project"]["optional-dependencies"]["service"])}
    lines = Path("constraints.txt").read_text("utf-8").splitlines()
    pinned = dict(line.split("==", 1) for line in lines if "==" in line and not line.startswith("#"))
    for name in ("fastapi", "httptools", "python-multipart", "starlette", "uvicorn", "uvloop"):
        (lowest,) = [Version(s.version) for s in needed[name].specifier if s.operator == ">="]
        assert lowest.release[:2] == Version(pinned[name]).release[:2], name
