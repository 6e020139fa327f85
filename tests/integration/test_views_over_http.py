"""Views through a real local stack: of an upload, of a repair, of a model, and of what can not be shown."""

import json
from pathlib import Path
from typing import Any

import httpx
import pytest

from quadpatch_client.schema import JobSpec
from quadpatch_client.sdk import Client
from tests.integration.conftest import RunningStack, ply_bytes, punched_relief
from tests.quadpatch.views.test_glb import attribute, extras, loaded
from tests.waiting import GUARD_S, wait_until


@pytest.fixture
def http(local_stack: RunningStack) -> Any:
    with httpx.Client(base_url=local_stack.url, timeout=GUARD_S) as client:
        yield client


def fetched(http: httpx.Client, path: str) -> httpx.Response:
    """Fetch a view as a page does: with a request that waits, again and again."""

    def made() -> httpx.Response | None:
        answer = http.get(path, headers={"Prefer": "wait=10"})
        return None if answer.status_code == httpx.codes.ACCEPTED else answer.raise_for_status()

    return wait_until(made)


def test_a_scan_and_its_repair_are_shown(http: httpx.Client, client: Client, tmp_path: Path) -> None:
    scan = tmp_path / "scan.ply"
    scan.write_bytes(ply_bytes(*punched_relief(40)))
    mesh = client.upload(scan)
    before = loaded(fetched(http, f"/v1/meshes/{mesh.id}/view").content)
    outlines = json.loads(fetched(http, f"/v1/meshes/{mesh.id}/outlines").content)
    ready = client.wait_for_mesh(mesh.id)
    assert ready.facts is not None
    assert [hole["id"] for hole in outlines["holes"]] == [hole.id for hole in ready.facts.holes]
    assert extras(before)["triangles"] == ready.facts.triangles

    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": {"method": "smooth"}})
    job = client.wait(client.create_job(spec).id)
    answer = fetched(http, f"/v1/jobs/{job.id}/view?level=fine&reference={mesh.id}")
    after = loaded(answer.content)
    assert [node["name"] for node in after.document["nodes"]] == ["measured", "invented"]
    assert extras(after)["origin"] == extras(before)["origin"]
    filled = {row["id"] for row in http.get(f"/v1/jobs/{job.id}/report").json()["holes"] if row["new_triangles"]}
    assert set(attribute(after, 1, "_HOLE_ID")[:, 0]) == filled
    assert attribute(after, 0, "_DISTANCE_TO_REFERENCE").max() == pytest.approx(0, abs=1e-6)
    again = http.get(answer.request.url, headers={"If-None-Match": answer.headers["ETag"]})
    assert again.status_code == httpx.codes.NOT_MODIFIED


def test_a_model_is_shown(http: httpx.Client) -> None:
    answer = fetched(http, "/v1/models/general-dictionary/versions/1/picture")
    assert answer.content.startswith(b"\x89PNG")
    assert answer.headers["Content-Type"] == "image/png"


def test_what_can_not_be_shown_is_said_at_once(http: httpx.Client, client: Client, tmp_path: Path) -> None:
    (tmp_path / "scan.ply").write_bytes(b"ply, but no mesh")
    mesh = client.upload(tmp_path / "scan.ply")
    answer = http.get(f"/v1/meshes/{mesh.id}/view", headers={"Prefer": "wait=60"})
    assert answer.status_code == httpx.codes.CONFLICT
    assert answer.json()["code"] in ("view_failed", "mesh_rejected")
