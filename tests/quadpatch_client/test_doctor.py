"""Also tests `quadpatch_client.doctor_command`; a healthy service: `tests/integration/test_command_line.py`."""

import json
import shutil
import socket
import ssl
import subprocess
from collections import namedtuple
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
from typer.testing import CliRunner

from quadpatch_client.cli import app
from quadpatch_client.doctor import examine
from quadpatch_client.exit_codes import ExitCode

VERSION = json.dumps({"version": "9.1.0", "api": "v1", "python": "3.11.9"}).encode()


def found(url: str, folder: Path, api_key: str | None = None) -> dict[str, tuple[str, str]]:
    return {f.subject: (f.verdict, f"{f.text} {f.advice}") for f in examine(url, api_key, folder)}


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("scans", "say --url http://HOST:PORT"),
        ("http://127.0.0.1:9", "nothing listens at 127.0.0.1, port 9"),
        ("http://no-such-host.invalid", "no-such-host.invalid"),
    ],
)
def test_an_address_that_leads_nowhere_ends_it_with_what_to_do(url: str, words: str, tmp_path: Path) -> None:
    verdict, text = found(url, tmp_path)["address"]
    assert verdict == "error"
    assert words in text
    assert "service" not in found(url, tmp_path)


def test_versions_clocks_and_keys_are_compared(server: Any, answers: Any, tmp_path: Path) -> None:
    class OldClock:
        """An answer of a service whose clock is wrong."""

        def __call__(self, handler: BaseHTTPRequestHandler) -> None:
            handler.date_time_string = lambda timestamp=None: "Mon, 30 Nov 2020 12:00:00 GMT"  # type: ignore[method-assign]
            answers["answer"](200, VERSION)(handler)

    server.answers = [OldClock(), answers["answer"](503, b"the queue is away"), answers["answer"](401)]
    seen = found(server.url, tmp_path, "wrong")
    assert seen["service"][0] == "warning"
    assert "version 9.1.0" in seen["service"][1]
    assert seen["clock"][0] == "warning"
    assert "ahead of the service" in seen["clock"][1]
    assert seen["readiness"] == (
        "error",
        "not ready: the queue is away wait: jobs that were accepted are kept; tell the operator if it stays so",
    )
    assert seen["key"][0] == "error"
    assert "does not know this key" in seen["key"][1]


@pytest.mark.parametrize(
    ("status", "key", "words"),
    [
        (401, [], "the service asks for a key"),
        (401, ["--api-key", "wrong"], "the service does not know this key"),
        (403, ["--api-key", "narrow"], "the scope `read` is missing"),
    ],
)
def test_a_key_that_is_refused_is_told_as_that(
    server: Any, answers: Any, status: int, key: list[str], words: str
) -> None:
    server.answers = [answers["answer"](status)]
    command = ["doctor", "--url", f"{server.url}/v1/", *key]
    environment = {"COLUMNS": "200", "QUADPATCH_CLIENT_API_KEY": ""}
    done = CliRunner().invoke(app, command, env=environment)
    assert done.exit_code == ExitCode.REJECTED
    assert words in done.stdout
    assert "→ set QUADPATCH_CLIENT_API_KEY or say --api-key; the operator makes a key" in done.stdout
    assert [path for _, path, _, _ in server.requests] == ["/v1/version"]


def test_no_answer_of_another_program_is_told_in_words_of_a_library(server: Any, answers: Any, tmp_path: Path) -> None:
    server.answers = [answers["answer"](404)]
    verdict, text = found(server.url, tmp_path)["service"]
    assert (verdict, text.partition(" check")[0]) == ("error", "no answer of a Quadpatch service: status 404 Not Found")


def test_another_program_is_told_apart(server: Any, answers: Any, tmp_path: Path) -> None:
    server.answers = [answers["answer"](200, b"<html>")]
    assert found(server.url, tmp_path)["service"][0] == "error"


def test_a_disk_that_is_nearly_full_is_a_warning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage(10, 9, 1_000_000))
    assert found("scans", tmp_path)["disk"][0] == "warning"


@pytest.fixture
def tls_port(tmp_path: Path) -> Iterator[int]:
    """A server whose certificate no authority has signed."""
    names = [str(tmp_path / name) for name in ("key.pem", "cert.pem")]
    options = ["-newkey", "rsa:2048", "-nodes", "-subj", "/CN=localhost", "-days", "5"]
    made = shutil.which("openssl")
    if made is None:
        pytest.skip("there is no openssl to make a certificate with")
    command = [made, "req", "-x509", *options, "-keyout", names[0], "-out", names[1]]
    subprocess.run(command, check=True, capture_output=True)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(names[1], names[0])
    httpd = HTTPServer(("127.0.0.1", 0), BaseHTTPRequestHandler)
    httpd.socket = context.wrap_socket(httpd.socket, server_side=True)
    thread = Thread(target=httpd.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    yield httpd.server_port
    httpd.shutdown()
    thread.join()
    httpd.server_close()


def test_a_certificate_that_is_not_trusted_is_told_with_what_to_do(tls_port: int, tmp_path: Path) -> None:
    verdict, text = found(f"https://localhost:{tls_port}", tmp_path)["TLS"]
    assert verdict == "error"
    assert "the certificate is not trusted" in text
    assert "SSL_CERT_FILE" in text


def test_the_command_prints_a_table_or_json_and_tells_by_its_code() -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        url = f"http://127.0.0.1:{probe.getsockname()[1]}"
    command = ["doctor", "--url", url]
    table = CliRunner().invoke(app, command, env={"COLUMNS": "80"})
    assert table.exit_code == ExitCode.UNREACHABLE
    assert all(len(line) <= 80 for line in table.stdout.splitlines())
    assert "→ start the service" in table.stdout
    assert json.loads(CliRunner().invoke(app, [*command, "--json"]).stdout)[-1]["verdict"] == "error"
