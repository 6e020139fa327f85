"""Requests that come to two processes of the API at once."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.resumption.killable_service import KillableService
from tests.waiting import GUARD_S

_N_REQUESTS = 50


@pytest.fixture
def urls(
    tmp_path: Path, valkey_url: str, new_places: Callable[[], AbstractContextManager[dict[str, str]]]
) -> Iterator[list[str]]:
    """Addresses of two processes with one database, one store and one queue, and no worker."""
    with new_places() as places:
        variables = {f"QUADPATCH_{name.upper()}": url for name, url in places.items()}
        variables |= {"QUADPATCH_REDIS_URL": valkey_url, "QUADPATCH_QUEUE_NAME": "two-apis"}
        services = [KillableService(tmp_path, variables) for _ in range(2)]
        try:
            for service in services:
                service.start()
            yield [service.url for service in services]
        finally:
            for service in services:
                service.stop()


def send_at_once(client: httpx.Client, urls: list[str], body: dict[str, Any], key: str) -> set[str]:
    """Send the same request fifty times, to one process and the other, and return the ids that they answer."""

    def send(number: int) -> str:
        answer = client.post(urls[number % 2], json=body, headers={"Idempotency-Key": key})
        assert answer.status_code == httpx.codes.ACCEPTED, answer.text
        return str(answer.json()["id"])

    with ThreadPoolExecutor(_N_REQUESTS) as pool:
        return set(pool.map(send, range(_N_REQUESTS)))


def test_equal_requests_with_one_key_make_one_job_and_one_batch(urls: list[str]) -> None:
    with httpx.Client(timeout=2 * GUARD_S) as client:
        upload = client.post(f"{urls[0]}/v1/meshes?filename=a.ply", content=b"ply\n").raise_for_status()
        spec = {"mesh_id": upload.json()["id"], "method": {"method": "smooth"}}
        assert len(send_at_once(client, [f"{url}/v1/jobs" for url in urls], spec, "part-1187")) == 1
        jobs = [{**spec, "seed": seed} for seed in range(1, 4)]
        assert len(send_at_once(client, [f"{url}/v1/batches" for url in urls], {"jobs": jobs}, "night")) == 1
        assert len(client.get(f"{urls[1]}/v1/jobs").json()["items"]) == 1 + len(jobs)
