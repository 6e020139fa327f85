"""Uploads against the service in a process of its own."""

import contextlib
import hashlib
import socket
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import httpx
import psutil
import pytest
from pydantic import SecretStr

from jobkit.settings import Settings
from tests.waiting import GUARD_S, wait_until

MIB = 1 << 20
LIMIT_MIB = 64
CHUNK = b"0123456789abcdef" * 4096


def body(n_mib: int) -> Iterator[bytes]:
    for _ in range(n_mib * MIB // len(CHUNK)):
        yield CHUNK


def multipart(n_mib: int) -> Iterator[bytes]:
    yield b'--XX\r\nContent-Disposition: form-data; name="file"; filename="a.ply"\r\n\r\n'
    yield from body(n_mib)
    yield b"\r\n--XX--\r\n"


@pytest.fixture(scope="module")
def data_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("uploads")


@pytest.fixture(scope="module")
def service(run_service: Callable[..., Any], data_dir: Path, valkey_url: str) -> Iterator[Any]:
    settings = Settings(
        data_dir=data_dir, redis_url=SecretStr(valkey_url), queue_name="uploads", models_dir=data_dir / "models"
    )
    with run_service(settings, max_upload_mb=LIMIT_MIB) as running:
        httpx.post(f"{running.url}/v1/meshes", content=b"warm up", timeout=GUARD_S).raise_for_status()
        yield running


def incoming(data_dir: Path) -> list[Path]:
    return list((data_dir / "objects" / "incoming").iterdir())


@pytest.mark.parametrize("kind", ["raw", "form"])
def test_a_large_mesh_passes_through_without_filling_the_memory(service: Any, kind: str) -> None:
    process = psutil.Process(service.process.pid)
    before = process.memory_info().rss
    peaks = [before]

    def watched() -> Iterator[bytes]:
        for chunk in multipart(LIMIT_MIB) if kind == "form" else body(LIMIT_MIB):
            yield chunk
            peaks.append(process.memory_info().rss)

    headers = {"Content-Type": "multipart/form-data; boundary=XX"} if kind == "form" else {}
    answer = httpx.post(f"{service.url}/v1/meshes", content=watched(), headers=headers, timeout=GUARD_S)
    assert answer.status_code in (200, 201)
    assert answer.json()["size_bytes"] == LIMIT_MIB * MIB
    assert answer.json()["id"] == hashlib.sha256(CHUNK * (LIMIT_MIB * MIB // len(CHUNK))).hexdigest()
    assert max(peaks) - before < LIMIT_MIB * MIB / 4


def test_a_body_without_end_is_cut_off_at_the_limit(service: Any, data_dir: Path) -> None:
    # The service answers and closes while the client is still sending: either is seen first.
    with contextlib.suppress(httpx.WriteError):
        answer = httpx.post(f"{service.url}/v1/meshes", content=body(8 * LIMIT_MIB), timeout=GUARD_S)
        assert answer.status_code == 413
    wait_until(lambda: incoming(data_dir) == [])
    assert httpx.get(f"{service.url}/healthz", timeout=GUARD_S).status_code == 200


def test_a_body_that_says_it_is_too_large_is_refused_before_it_is_sent(service: Any) -> None:
    with socket.create_connection(("127.0.0.1", urlsplit(service.url).port)) as link:
        link.sendall(b"POST /v1/meshes HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999\r\n\r\n")
        link.settimeout(GUARD_S)
        assert link.recv(4096).startswith(b"HTTP/1.1 413 ")


def test_a_station_that_drops_out_leaves_nothing_behind(service: Any, data_dir: Path) -> None:
    with socket.create_connection(("127.0.0.1", urlsplit(service.url).port)) as link:
        link.sendall(b"POST /v1/meshes HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9999999\r\n\r\n" + CHUNK)
        wait_until(lambda: len(incoming(data_dir)) == 1)
    wait_until(lambda: incoming(data_dir) == [])
    assert httpx.get(f"{service.url}/healthz", timeout=GUARD_S).status_code == 200
