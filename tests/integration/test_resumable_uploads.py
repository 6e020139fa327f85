"""Resumable uploads through a line that is cut, to a server that is killed; `make resumption` does it at full size.

Also tests `quadpatch_client.parallel_upload`.
"""

import hashlib
import random
import threading
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from quadpatch_client import mesh_calls
from quadpatch_client.errors import UnreachableError
from quadpatch_client.sdk import Client
from tests.resumption.campaign import MIB, Trial, memory_growth, run_trial, running_service
from tests.resumption.clients import mesh_of, send_by_sdk, send_by_tuspy
from tests.resumption.killable_service import KillableService
from tests.resumption.proxy import Proxy
from tests.servers import S3Server, fresh_bucket
from tests.waiting import GUARD_S

TUS = {"Tus-Resumable": "1.0.0"}
BYTES = {**TUS, "Content-Type": "application/offset+octet-stream"}
MOST_GROWTH = 32 * MIB


@pytest.fixture(scope="module")
def variables(valkey_url: str) -> dict[str, str]:
    return {"QUADPATCH_REDIS_URL": valkey_url, "QUADPATCH_QUEUE_NAME": "resumption"}


@pytest.fixture
def on_s3(variables: dict[str, str], s3: S3Server) -> Iterator[dict[str, str]]:
    with fresh_bucket(s3) as bucket:
        yield {**variables, "QUADPATCH_OBJECT_STORE_URL": f"s3://{bucket}/a"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("resumption")


@pytest.fixture(scope="module")
def service(folder: Path, variables: dict[str, str]) -> Iterator[KillableService]:
    with running_service(folder, variables) as running:
        yield running


def by_tuspy(url: str, path: Path) -> str:
    return mesh_of(url, send_by_tuspy(url, path, 4 * MIB))


def test_tuspy_brings_every_byte_to_local_files(tmp_path: Path, variables: dict[str, str]) -> None:
    happened = run_trial(Trial(12, n_kills=2, n_cuts=2, seed=5), tmp_path, variables, by_tuspy)
    assert (happened["kills"], happened["cuts"]) == (2, 2)


def test_tuspy_brings_every_byte_to_s3(tmp_path: Path, on_s3: dict[str, str]) -> None:
    happened = run_trial(Trial(12, n_kills=1, n_cuts=2, seed=6), tmp_path, on_s3, by_tuspy)
    assert (happened["kills"], happened["cuts"]) == (1, 2)


def test_the_sdk_goes_on_where_the_line_broke(
    tmp_path: Path, variables: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mesh_calls, "RESUMABLE_BYTES", MIB)
    happened = run_trial(Trial(16, n_kills=1, n_cuts=2, seed=7), tmp_path, variables, send_by_sdk)
    assert (happened["kills"], happened["cuts"]) == (1, 2)


def test_a_program_that_is_started_again_sends_what_is_left(
    service: KillableService, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mesh_calls, "RESUMABLE_BYTES", MIB)
    path = tmp_path / "scan.ply"
    path.write_bytes(random.Random(8).randbytes(30 * MIB))
    with Proxy(service.port, 60 * MIB, [lambda: None], random.Random(3)).running() as proxy:
        with Client(proxy.url, patience_s=0) as client, pytest.raises(UnreachableError):
            client.upload(path)
        n_first = proxy.n_passed
        with Client(proxy.url) as client:
            assert client.upload(path).id == hashlib.sha256(path.read_bytes()).hexdigest()
    assert n_first > 9 * MIB
    # At most one part, of 8 MiB, was not acknowledged.
    assert proxy.n_passed - n_first < 30 * MIB - n_first + 10 * MIB


def test_parts_that_come_in_parallel_are_joined(service: KillableService) -> None:
    data = random.Random(9).randbytes(20 * MIB + 11)
    pieces = [data[start : start + 5 * MIB] for start in range(0, len(data), 5 * MIB)]
    paths: list[str] = [""] * len(pieces)

    def send(i: int) -> None:
        headers = {**BYTES, "Upload-Concat": "partial", "Upload-Length": str(len(pieces[i]))}
        answer = httpx.post(f"{service.url}/v1/uploads", content=pieces[i], headers=headers, timeout=GUARD_S)
        paths[i] = answer.headers["location"]

    threads = [threading.Thread(target=send, args=(i,)) for i in range(len(pieces))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    headers = {**TUS, "Upload-Concat": f"final;{' '.join(paths)}"}
    joined = httpx.post(f"{service.url}/v1/uploads", headers=headers, timeout=GUARD_S)
    assert joined.headers["quadpatch-mesh"].endswith(hashlib.sha256(data).hexdigest())


def test_the_sdk_sends_large_files_in_parts(
    tmp_path: Path, variables: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mesh_calls, "RESUMABLE_BYTES", MIB)
    monkeypatch.setattr(mesh_calls, "PARALLEL_BYTES", MIB)
    happened = run_trial(Trial(16, n_kills=1, n_cuts=2, seed=8), tmp_path, variables, send_by_sdk)
    assert (happened["kills"], happened["cuts"]) == (1, 2)


def test_progress_of_parts_adds_up(service: KillableService, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_calls, "RESUMABLE_BYTES", MIB)
    monkeypatch.setattr(mesh_calls, "PARALLEL_BYTES", MIB)
    path, seen = tmp_path / "scan.ply", list[int]()
    path.write_bytes(random.Random(12).randbytes(6 * MIB + 3))
    with Client(service.url) as client:
        assert (
            client.upload(path, lambda done, _: seen.append(done)).id == hashlib.sha256(path.read_bytes()).hexdigest()
        )
    assert seen == sorted(seen)
    assert seen[-1] == 6 * MIB + 3


def test_memory_does_not_grow_with_the_upload(service: KillableService) -> None:
    assert memory_growth(service, 256) < MOST_GROWTH


@pytest.mark.slow
def test_memory_does_not_grow_with_the_upload_to_s3(tmp_path: Path, on_s3: dict[str, str]) -> None:
    with running_service(tmp_path, on_s3) as service:
        assert memory_growth(service, 256) < MOST_GROWTH


def test_two_processes_of_the_api_share_an_upload(
    service: KillableService, folder: Path, variables: dict[str, str]
) -> None:
    data = random.Random(10).randbytes(MIB)
    with running_service(folder, variables) as other:
        headers = {**BYTES, "Upload-Length": str(len(data))}
        begun = httpx.post(f"{service.url}/v1/uploads", content=data[:1000], headers=headers, timeout=GUARD_S)
        path = begun.headers["location"]
        sent = httpx.patch(
            f"{other.url}{path}", content=data[1000:], headers={**BYTES, "Upload-Offset": "1000"}, timeout=GUARD_S
        )
        assert sent.headers["quadpatch-mesh"].endswith(hashlib.sha256(data).hexdigest())
        assert httpx.head(f"{service.url}{path}", headers=TUS, timeout=GUARD_S).headers["quadpatch-mesh"]
