"""Each task in a confined engine child, which was forked from a process that loaded the method once."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.formats.reading import read_scan
from tests.integration.conftest import ply_bytes, punched_relief
from worker.engine.client import ForkServer
from worker.engine.limits import EngineLimits
from worker.engine.request import (
    MESH_FOLDER,
    PAGE_NAME,
    PREVIEW_NAME,
    REFERENCE_FOLDER,
    REPORT_NAME,
    EngineRequest,
    EngineTask,
)
from worker.engine.supervision import Observer, run_engine
from worker.failures import EngineFailedError

LIMITS = EngineLimits(time_s=300.0, memory_mb=4096, n_threads=1)
VERTICES, TRIANGLES = punched_relief(30, 1, radius=0.0)
MISSING = [40, 41, 300]


@pytest.fixture(scope="module")
def fork_server() -> Iterator[ForkServer]:
    with ForkServer(n_threads=1) as fork_server:
        yield fork_server


def request_of(folder: Path, task: EngineTask, output: str, **fields: Any) -> EngineRequest:
    """A request whose mesh is linked from outside of its folder, as it is from a store."""
    (folder / MESH_FOLDER).mkdir()
    stored = folder.parent / f"{folder.name}-stored"
    stored.write_bytes(ply_bytes(VERTICES, TRIANGLES, "double"))
    (folder / MESH_FOLDER / "source.ply").symlink_to(stored)
    values: dict[str, Any] = {"source": f"{MESH_FOLDER}/source.ply", "limits": LIMITS, "model": "self", **fields}
    return EngineRequest(task=task, output=output, **values)


def run(fork_server: ForkServer, request: EngineRequest, folder: Path) -> tuple[dict[str, Any], list[str]]:
    """Return the report, and the stages that were reached."""
    stages: list[str] = []
    run_engine(fork_server, request, folder, Observer(lambda stage, _: stages.append(stage), lambda: None))
    report: dict[str, Any] = json.loads((folder / REPORT_NAME).read_text())
    return report, list(dict.fromkeys(stages))


def test_vertices_of_a_list_are_restored_and_drawn(fork_server: ForkServer, tmp_path: Path) -> None:
    missing = {"kind": "indices", "indices": MISSING}
    asked = {"job_id": "job_01", "tenant": "default", "request_id": None, "label": "hall 7", "mesh_name": "urn.ply"}
    request = request_of(tmp_path, "restore", "restored.ply", missing=missing, with_preview=True, html_report=asked)
    report, stages = run(fork_server, request, tmp_path)
    restored = read_scan(tmp_path / "restored.ply")
    kept = np.setdiff1d(np.arange(len(VERTICES)), MISSING)
    assert np.array_equal(restored.vertices[kept], VERTICES[kept])
    assert (report["task"], report["vertices"]["restored"]) == ("restore", len(MISSING))
    assert (stages[0], *stages[-2:]) == ("read", "preview", "html_report")
    assert (tmp_path / PREVIEW_NAME).read_bytes().startswith(b"\x89PNG")
    page = (tmp_path / PAGE_NAME).read_text("utf-8")
    assert "Restoration report: urn.ply" in page
    assert "hall 7" in page
    assert report["provenance"]["source"]["name"] == "urn.ply"


def test_noise_is_taken_away_as_a_reference_outside_of_the_folder_teaches(
    fork_server: ForkServer, tmp_path: Path
) -> None:
    options = {"noise": 0.002, "max_shift": 0.004}
    request = request_of(
        tmp_path, "denoise", "denoised.ply", options=options, reference=f"{REFERENCE_FOLDER}/source.ply"
    )
    (tmp_path / REFERENCE_FOLDER).mkdir()
    (tmp_path / REFERENCE_FOLDER / "source.ply").symlink_to(tmp_path.parent / f"{tmp_path.name}-stored")
    report, _ = run(fork_server, request, tmp_path)
    shift = np.linalg.norm(read_scan(tmp_path / "denoised.ply").vertices - VERTICES, axis=1)
    assert shift.max() <= options["max_shift"]
    assert report["moved_vertices"] == np.count_nonzero(shift)
    assert not (tmp_path / PREVIEW_NAME).exists()


def test_what_was_encoded_is_decoded_within_its_error(fork_server: ForkServer, tmp_path: Path) -> None:
    encoding, decoding = tmp_path / "encoding", tmp_path / "decoding"
    encoding.mkdir()
    decoding.mkdir()
    options = {"max_error": 0.004, "keep_connectivity": True}
    report, _ = run(fork_server, request_of(encoding, "encode", "encoded.qpz", options=options), encoding)
    assert max(report["max_error"].values()) <= options["max_error"]
    request = request_of(decoding, "decode", "decoded.ply", source=f"{MESH_FOLDER}/source.qpz")
    (decoding / MESH_FOLDER / "source.qpz").symlink_to(encoding / "encoded.qpz")
    run(fork_server, request, decoding)
    decoded = read_scan(decoding / "decoded.ply")
    assert np.linalg.norm(decoded.vertices - VERTICES, axis=1).max() <= options["max_error"]


@pytest.mark.parametrize(
    ("task", "fields", "code"),
    [
        ("restore", {"missing": {"kind": "indices", "indices": [10**6]}}, "invalid_option"),
        ("restore", {"missing": {"kind": "property", "name": "lost"}}, "invalid_option"),
        ("denoise", {"options": {"noise": 0.1, "sigma": 1}}, "invalid_option"),
        ("decode", {}, "unreadable_mesh"),
    ],
)
def test_a_task_that_can_not_be_done_fails_with_its_code(
    fork_server: ForkServer, tmp_path: Path, task: EngineTask, fields: dict[str, Any], code: str
) -> None:
    request = request_of(tmp_path, task, "out.ply", **fields)
    with pytest.raises(EngineFailedError) as caught:
        run(fork_server, request, tmp_path)
    failure = caught.value.failure
    assert (failure.code, failure.retryable) == (code, False)
    assert str(tmp_path) not in failure.message
    assert not (tmp_path / "out.ply").exists()
