"""A real HTTP server on a line that drops, and the answers of a service that exist nowhere else."""

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

Answer = Callable[[BaseHTTPRequestHandler], None]


@dataclass
class ScriptedServer:
    """Answers the n-th request with the n-th answer, and every further one with the last."""

    url: str = ""
    answers: list[Answer] = field(default_factory=list)
    requests: list[tuple[str, str, dict[str, str], bytes]] = field(default_factory=list)

    def handle(self, handler: BaseHTTPRequestHandler) -> None:
        body = _read_body(handler)
        self.requests.append((handler.command, handler.path, dict(handler.headers), body))
        self.answers[min(len(self.requests), len(self.answers)) - 1](handler)


@pytest.fixture
def server() -> Iterator[ScriptedServer]:
    script = ScriptedServer()

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self) -> None:
            script.handle(self)

        do_POST = do_PUT = do_HEAD = do_PATCH = do_GET  # noqa: N815 - names that the base class looks for

        def log_message(self, *_: object) -> None:
            pass

    httpd = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=httpd.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    script.url = f"http://127.0.0.1:{httpd.server_port}"
    yield script
    httpd.shutdown()
    thread.join()
    httpd.server_close()


def _read_body(handler: BaseHTTPRequestHandler) -> bytes:
    if handler.headers.get("Transfer-Encoding") == "chunked":
        body = b""
        while size := int(handler.rfile.readline(), 16):
            body += handler.rfile.read(size)
            handler.rfile.readline()
        handler.rfile.readline()
        return body
    return handler.rfile.read(int(handler.headers.get("Content-Length", 0)))


def answer(status: int, body: bytes = b"{}", **headers: str) -> Answer:
    """A whole answer; underscores in header names stand for dashes."""

    def send(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(status)
        for name, value in headers.items():
            handler.send_header(name.replace("_", "-"), value)
        handler.send_header("Content-Length", str(len(body)))
        handler.end_headers()
        handler.wfile.write(body)

    return send


def hang_up(handler: BaseHTTPRequestHandler) -> None:
    """Drop the line instead of an answer."""
    handler.close_connection = True
    handler.connection.close()


def break_off(body: bytes, after: int) -> Answer:
    """Drop the line in the middle of a body."""

    def send(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Length", str(len(body)))
        handler.end_headers()
        handler.wfile.write(body[:after])
        handler.wfile.flush()
        hang_up(handler)

    return send


def rest_of(body: bytes) -> Answer:
    """The range that the request asks for."""

    def send(handler: BaseHTTPRequestHandler) -> None:
        start = int(handler.headers["Range"].removeprefix("bytes=").removesuffix("-"))
        answer(206, body[start:], Content_Range=f"bytes {start}-{len(body) - 1}/{len(body)}")(handler)

    return send


@pytest.fixture
def answers() -> dict[str, Callable[..., Answer]]:
    """The makers of answers, for tests to script a server with."""
    return {"answer": answer, "break_off": break_off, "rest_of": rest_of, "hang_up": lambda: hang_up}
