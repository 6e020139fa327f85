"""A model from upload to use, against a local stack whose worker proves it."""

import json
from collections.abc import Callable
from pathlib import Path

import httpx

from quadpatch_client.schema import JobSpec
from quadpatch_client.sdk import Client
from tests.integration.conftest import RunningStack
from tests.quadpatch.inpainters.test_onnx_network import PAPER, write_network
from tests.waiting import GUARD_S


def test_what_is_published_is_proven_and_used_at_once_as_the_documents_show(
    local_stack: RunningStack,
    client: Client,
    relief_file: Callable[[str], Path],
    dictionary_bytes: Callable[[int], bytes],
) -> None:
    with httpx.Client(base_url=local_stack.url, timeout=GUARD_S) as http:
        wait = {"Prefer": "wait=30"}
        published = http.post("/v1/models/my-parts/versions", content=dictionary_bytes(7), headers=wait)
        assert (published.status_code, published.json()["state"]) == (201, "ready")
        assert http.put("/v1/aliases/mine", json={"model": "my-parts@1"}).status_code == 200
        spec = {
            "mesh_id": client.upload(relief_file("float.ply")).id,
            "method": {"method": "dictionary", "model": "mine"},
        }
        job = client.wait(client.create_job(JobSpec.model_validate(spec)).id, timeout_s=GUARD_S)
        assert job.state.has_result
        assert any(model.name == "my-parts" for model in client.models().models)
        assert http.delete("/v1/aliases/mine").status_code == 204
        assert http.delete("/v1/models/my-parts/versions/1").status_code == 204


def test_what_cannot_be_proven_is_answered_with_the_check_that_failed(
    local_stack: RunningStack, tmp_path: Path
) -> None:
    network = write_network(tmp_path / "copy.onnx", None, 1).read_bytes()
    card = json.dumps({**PAPER, "patch_resolution": 32})
    files: dict[str, tuple[str, bytes] | tuple[None, str, str]] = {
        "artifact": ("copy.onnx", network),
        "card": (None, card, "application/json"),
    }
    with httpx.Client(base_url=local_stack.url, timeout=GUARD_S) as http:
        refused = http.post("/v1/models/wrong/versions", files=files, headers={"Prefer": "wait=30"})
        assert (refused.status_code, refused.json()["code"]) == (422, "unusable_model")
        assert refused.json()["detail"].startswith("wrong@1 takes tensor(float)")
        assert http.delete(refused.headers["location"]).status_code == 204
