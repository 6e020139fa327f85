"""Uploads against the service in a process of its own."""

import hashlib
import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import httpx
import psutil
import pytest

from jobkit.settings import Settings

MIB = 1 << 20
CHUNK = b"0123456789abcdef" * 4096


def body(n_mib: int) -> Iterator[bytes]:
    for _ in range(n_mib * MIB // len(CHUNK)):
        yield CHUNK


def multipart(n_mib: int) -> Iterator[bytes]:
    yield b'--XX\r\nContent-Disposition: form-data; name="file"; filename="a.ply"\r\n\r\n'
    yield from body(n_mib)
    yield b"\r\n--XX--\r\n"


def stored_files(settings: Settings) -> list[Path]:
    return [path for path in (settings.data_dir / "objects").rglob("*") if path.is_file()]


def eventually(holds: Callable[[], bool]) -> bool:
    deadline = time.monotonic() + 20
    while not holds() and time.monotonic() < deadline:
        time.sleep(0.05)
    return holds()


@pytest.mark.parametrize("kind", ["raw", "form"])
def test_a_large_mesh_passes_through_without_filling_the_memory(serve: Callable[..., Any], kind: str) -> None:
    n_mib = 160
    with serve() as service:
        httpx.post(f"{service.url}/v1/meshes", content=b"warm up").raise_for_status()
        process = psutil.Process(service.process.pid)
        before = process.memory_info().rss
        peaks = [before]

        def watched() -> Iterator[bytes]:
            for chunk in multipart(n_mib) if kind == "form" else body(n_mib):
                yield chunk
                peaks.append(process.memory_info().rss)

        headers = {"Content-Type": "multipart/form-data; boundary=XX"} if kind == "form" else {}
        answer = httpx.post(f"{service.url}/v1/meshes", content=watched(), headers=headers, timeout=120)
    assert answer.status_code == 201
    assert answer.json()["size_bytes"] == n_mib * MIB
    assert answer.json()["id"] == hashlib.sha256(CHUNK * (n_mib * MIB // len(CHUNK))).hexdigest()
    assert max(peaks) - before < 24 * MIB


def test_a_body_without_end_is_cut_off_at_the_limit(serve: Callable[..., Any], settings: Settings) -> None:
    with serve(max_upload_mb=2) as service:
        try:
            answer = httpx.post(f"{service.url}/v1/meshes", content=body(512), timeout=60)
            assert answer.status_code == 413
        except httpx.WriteError:
            pass  # the service has answered and closed while the client was still sending
        assert stored_files(settings) == []
        assert httpx.get(f"{service.url}/healthz").status_code == 200


def test_a_body_that_says_it_is_too_large_is_refused_before_it_is_sent(serve: Callable[..., Any]) -> None:
    with serve(max_upload_mb=2) as service, socket.create_connection(("127.0.0.1", urlsplit(service.url).port)) as link:
        link.sendall(b"POST /v1/meshes HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999\r\n\r\n")
        link.settimeout(20)
        answer = link.recv(4096)
    assert answer.startswith(b"HTTP/1.1 413 ")


def test_a_station_that_drops_out_leaves_nothing_behind(serve: Callable[..., Any], settings: Settings) -> None:
    with serve() as service:
        with socket.create_connection(("127.0.0.1", urlsplit(service.url).port)) as link:
            link.sendall(b"POST /v1/meshes HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999\r\n\r\n" + CHUNK)
            assert eventually(lambda: len(stored_files(settings)) == 1)
        assert eventually(lambda: stored_files(settings) == [])
        assert httpx.get(f"{service.url}/healthz").status_code == 200
