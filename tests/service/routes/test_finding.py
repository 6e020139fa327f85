"""Lists that are searched: `jobkit/database/searching.py`, `jobkit/jobs/search.py`, `service/finding.py`."""

from collections.abc import Callable
from datetime import datetime
from typing import Any
from urllib.parse import quote

import pytest
from starlette.testclient import TestClient

from quadpatch_client.schema import Job


def upload(client: TestClient, content: bytes, filename: str) -> str:
    answer = client.post("/v1/meshes", params={"filename": filename}, content=content)
    assert answer.status_code in (200, 201), answer.text
    return str(answer.json()["id"])


def start(client: TestClient, mesh_id: str, **fields: Any) -> str:
    answer = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}, **fields})
    assert answer.status_code == 202, answer.text
    return str(answer.json()["id"])


def found(client: TestClient, query: str, path: str = "/v1/jobs") -> list[str]:
    answer = client.get(f"{path}?{query}")
    assert answer.status_code == 200, answer.text
    return [item["id"] for item in answer.json()["items"]]


@pytest.fixture
def jobs(client: TestClient, finish: Callable[[str], Job]) -> dict[str, str]:
    meshes = [upload(client, content, name) for content, name in ((b"a", "face001.ply"), (b"b", "Bust_2.stl"))]
    ids = {
        "face": start(client, meshes[0], label="station 4, part 1", metadata={"order": "A-17", "shift": "early"}),
        "bust": start(client, meshes[1], label="Station 5", metadata={"order": "A-17"}),
        "renamed": start(client, meshes[0], mesh_name="100%.ply", metadata={"order": "B: 2"}),
    }
    finish(ids["bust"])
    return ids | {"mesh": meshes[0]}


@pytest.mark.parametrize(
    ("query", "names"),
    [
        ("", ["renamed", "bust", "face"]),
        ("oldest_first=true", ["face", "bust", "renamed"]),
        ("state=queued", ["renamed", "face"]),
        ("state=queued&state=succeeded", ["renamed", "bust", "face"]),
        ("task=fill&state=succeeded", ["bust"]),
        ("task=denoise", []),
        ("filename=face*", ["face"]),
        ("filename=bust_2.stl", ["bust"]),
        # An underscore and a per cent sign are no wildcards.
        ("filename=face0_1.ply", []),
        ("filename=100%25.ply", ["renamed"]),
        ("filename=10%25", []),
        ("label=station*", ["bust", "face"]),
        ("label=*part 1", ["face"]),
        ("label=part", []),
        ("metadata=order:A-17", ["bust", "face"]),
        ("metadata=order:A-17&metadata=shift:early", ["face"]),
        ("metadata=order:B: 2", ["renamed"]),
        ("metadata=nothing:there", []),
    ],
)
def test_jobs_are_found_by_what_is_known_of_them(
    client: TestClient, jobs: dict[str, str], query: str, names: list[str]
) -> None:
    assert found(client, quote(query, safe="=&%*")) == [jobs[name] for name in names]


def test_jobs_are_found_by_mesh_and_by_moment(client: TestClient, jobs: dict[str, str]) -> None:
    assert found(client, f"mesh_id={jobs['mesh']}") == [jobs["renamed"], jobs["face"]]
    middle = quote(client.get(f"/v1/jobs/{jobs['bust']}").json()["created_at"])
    assert jobs["face"] not in found(client, f"created_since={middle}")
    assert jobs["renamed"] not in found(client, f"created_before={middle}")
    assert found(client, "finished_since=2000-01-01T00:00:00Z") == [jobs["bust"]]
    assert found(client, "finished_before=2000-01-01T00:00:00Z") == []


def test_pages_go_on_in_either_order(client: TestClient, jobs: dict[str, str]) -> None:
    for order in ("", "&oldest_first=true"):
        whole, pages, cursor = found(client, order), [], ""
        while True:
            page = client.get(f"/v1/jobs?limit=1{order}{cursor}").json()
            pages += [item["id"] for item in page["items"]]
            if page["next_cursor"] is None:
                break
            cursor = f"&cursor={page['next_cursor']}"
        assert pages == whole


@pytest.mark.parametrize("query", ["metadata=order", "metadata=:x", "limit=501", "created_since=2026-01-01T00:00:00"])
def test_wrong_searches_are_refused(client: TestClient, query: str) -> None:
    answer = client.get(f"/v1/jobs?{query}")
    assert (answer.status_code, answer.json()["code"]) == (422, "invalid_request")


def test_meshes_are_listed_and_found(client: TestClient) -> None:
    ids = [upload(client, bytes([65 + i]), f"part {i}.{suffix}") for i, suffix in enumerate(("ply", "stl", "ply"))]
    assert found(client, "", "/v1/meshes") == ids[::-1]
    assert found(client, "filename=part*.ply", "/v1/meshes") == [ids[2], ids[0]]
    assert found(client, "format=stl&state=analysing", "/v1/meshes") == [ids[1]]
    assert found(client, "state=ready", "/v1/meshes") == []
    first = client.get("/v1/meshes?limit=2").json()
    assert found(client, f"cursor={first['next_cursor']}", "/v1/meshes") == ids[:1]
    shown = first["items"][0]
    assert (shown["filename"], shown["size_bytes"], shown["triangles"]) == ("part 2.ply", 1, None)
    assert datetime.fromisoformat(shown["created_at"]).tzinfo is not None
