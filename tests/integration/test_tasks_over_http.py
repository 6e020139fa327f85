"""Each task besides filling holes, over a real local stack, from upload to result."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.compression.encode import EncodeOptions
from quadpatch.formats.reading import read_scan
from quadpatch.tasks.encode import encode_file
from quadpatch.types import Triangles, Vertices
from quadpatch_client.errors import JobCanceledError, JobFailedError, MeshRejectedError, RefusedError
from quadpatch_client.schema import Job, JobResult, JobSpec, JobState, Mesh
from quadpatch_client.sdk import Client
from tests.integration.conftest import ply_bytes, punched_relief, stl_bytes
from tests.waiting import GUARD_S, wait_until

SELF = {"method": "dictionary", "model": "self"}
NOISE, MAX_SHIFT, MAX_ERROR = 0.002, 0.006, 0.004


def relief(n: int = 40) -> tuple[Vertices, Triangles]:
    """A wavy square of side 1 without holes."""
    return punched_relief(n, n_holes=1, radius=0.0)


def noisy(vertices: Vertices) -> Vertices:
    return vertices + np.random.default_rng(7).normal(scale=[0.0, 0.0, NOISE], size=vertices.shape)


@pytest.fixture
def sent(client: Client, tmp_path: Path) -> Callable[..., Mesh]:
    """Uploads a mesh with double coordinates under a name."""

    def send(name: str, vertices: Vertices, triangles: Triangles) -> Mesh:
        path = tmp_path / name
        path.write_bytes(ply_bytes(vertices, triangles, "double"))
        return client.upload(path)

    return send


@pytest.fixture
def done(client: Client) -> Callable[..., Job]:
    """Runs a job of a task to its end."""

    def run(task: str, mesh_id: str, **fields: Any) -> Job:
        spec = JobSpec.model_validate({"mesh_id": mesh_id, "task": task, "output": {"preview": False}, **fields})
        return client.wait(client.create_job(spec).id, timeout_s=GUARD_S)

    return run


@pytest.fixture(scope="session")
def encoded(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A small surface, encoded without a service."""
    folder = tmp_path_factory.mktemp("encoded")
    (folder / "scan.ply").write_bytes(ply_bytes(*relief(30), "double"))
    encode_file(folder / "scan.ply", folder / "scan.qpz", options=EncodeOptions(MAX_ERROR))
    return (folder / "scan.qpz").read_bytes()


def result_of(job: Job) -> JobResult:
    assert job.state.has_result
    assert job.result is not None
    return job.result


def fetched(client: Client, job: Job, folder: Path) -> Path:
    path = folder / f"{job.id}.{result_of(job).format}"
    client.download(job, "result", path)
    return path


def report_of(client: Client, job: Job, folder: Path) -> dict[str, Any]:
    client.download(job, "report", folder / "report.json")
    report: dict[str, Any] = json.loads((folder / "report.json").read_text())
    return report


@pytest.mark.parametrize("kind", ["nan", "indices"])
def test_missing_vertices_come_back_and_all_others_keep_their_bits(
    client: Client, sent: Callable[..., Mesh], done: Callable[..., Job], tmp_path: Path, kind: str
) -> None:
    vertices, triangles = relief()
    missing = np.random.default_rng(3).choice(len(vertices), 150, replace=False)
    damaged = vertices.copy()
    damaged[missing] = np.nan if kind == "nan" else 0.0
    which = {"kind": "nan"} if kind == "nan" else {"kind": "indices", "indices": sorted(missing.tolist())}
    mesh = sent("scan.ply", damaged, triangles)
    job = done("restore", mesh.id, restore={"missing": which})
    restored = read_scan(fetched(client, job, tmp_path))
    kept = np.setdiff1d(np.arange(len(vertices)), missing)
    assert np.array_equal(restored.vertices[kept], vertices[kept])
    assert np.array_equal(restored.triangles, triangles)
    assert np.linalg.norm(restored.vertices[missing] - vertices[missing], axis=1).max() < 0.03
    assert result_of(job).restored_vertices == len(missing)
    assert report_of(client, job, tmp_path)["task"] == "restore"


def test_a_scan_that_restoring_alone_can_use_says_so(
    client: Client, sent: Callable[..., Mesh], done: Callable[..., Job]
) -> None:
    vertices, triangles = relief()
    vertices[[30, 700]] = np.nan
    mesh = sent("scan.ply", vertices, triangles)
    with pytest.raises(MeshRejectedError) as rejected:
        client.wait_for_mesh(mesh.id, timeout_s=GUARD_S)
    assert rejected.value.problem.code == "not_finite"
    with pytest.raises(RefusedError, match="mesh_rejected"):
        done("denoise", mesh.id)
    assert result_of(done("restore", mesh.id, restore={"missing": {"kind": "nan"}})).restored_vertices == 2


@pytest.mark.parametrize("with_reference", [False, True])
def test_noise_is_taken_away_within_the_bound(
    client: Client, sent: Callable[..., Mesh], done: Callable[..., Job], tmp_path: Path, with_reference: bool
) -> None:
    vertices, triangles = relief()
    mesh = sent("scan.ply", noisy(vertices), triangles)
    options: dict[str, Any] = {"noise": NOISE, "max_shift": MAX_SHIFT}
    if with_reference:
        options["reference"] = sent("clean.ply", vertices[:, [1, 0, 2]], triangles[:, ::-1]).id
    job = done("denoise", mesh.id, denoise=options)
    denoised = read_scan(fetched(client, job, tmp_path))
    shift = np.linalg.norm(denoised.vertices - noisy(vertices), axis=1)
    assert np.array_equal(denoised.triangles, triangles)
    assert shift.max() <= MAX_SHIFT
    assert np.abs(denoised.vertices - vertices)[:, 2].mean() < np.abs(noisy(vertices) - vertices)[:, 2].mean()
    assert result_of(job).moved_vertices == np.count_nonzero(shift)
    assert result_of(job).shift_95 == pytest.approx(np.percentile(shift, 95), rel=0.01)


def test_an_encoded_surface_is_small_and_comes_back_within_its_error(
    client: Client, sent: Callable[..., Mesh], done: Callable[..., Job], tmp_path: Path
) -> None:
    vertices, triangles = relief()
    mesh = sent("scan.ply", vertices, triangles)
    job = done("encode", mesh.id, encode={"max_error": MAX_ERROR, "keep_connectivity": True})
    encoded = fetched(client, job, tmp_path)
    assert encoded.suffix == ".qpz"
    assert encoded.stat().st_size < mesh.size_bytes / 4
    error = result_of(job).max_error
    assert error is not None
    assert error <= MAX_ERROR
    uploaded = client.wait_for_mesh(client.upload(encoded).id, timeout_s=GUARD_S)
    assert uploaded.facts is not None
    assert (uploaded.format, uploaded.facts.format, uploaded.facts.holes) == ("qpz", "qpz", [])
    assert (uploaded.facts.vertices, uploaded.facts.triangles) == (len(vertices), len(triangles))
    jobs = [done("decode", uploaded.id) for _ in range(2)]
    decoded = read_scan(fetched(client, jobs[0], tmp_path))
    assert np.linalg.norm(decoded.vertices - vertices, axis=1).max() <= MAX_ERROR
    assert {result_of(job).files[0].sha256 for job in jobs} == {result_of(jobs[0]).files[0].sha256}


def test_what_was_encoded_with_a_model_is_decoded_with_the_one_of_the_same_bytes(
    client: Client, sent: Callable[..., Mesh], done: Callable[..., Job], tmp_path: Path
) -> None:
    method = {"method": "dictionary", "model": "general-dictionary@1"}
    job = done("encode", sent("scan.ply", *relief(30)).id, encode={"max_error": MAX_ERROR}, method=method)
    uploaded = client.wait_for_mesh(client.upload(fetched(client, job, tmp_path)).id, timeout_s=GUARD_S)
    decoding = done("decode", uploaded.id)
    assert decoding.model.requested == "self"
    assert (decoding.model.name, decoding.model.sha256) == ("general-dictionary", job.model.sha256)
    assert result_of(decoding).max_error == pytest.approx(MAX_ERROR)


def test_a_qpz_file_is_decoded_before_anything_else(
    client: Client, done: Callable[..., Job], tmp_path: Path, encoded: bytes
) -> None:
    (tmp_path / "scan.qpz").write_bytes(encoded)
    mesh = client.wait_for_mesh(client.upload(tmp_path / "scan.qpz").id, timeout_s=GUARD_S)
    for task, fields in (("fill", {}), ("denoise", {}), ("restore", {"restore": {"missing": {"kind": "nan"}}})):
        with pytest.raises(RefusedError, match="mesh_encoded"):
            done(task, mesh.id, **fields)


def test_a_fill_that_comes_before_the_analysis_of_a_qpz_file_says_the_same(
    client: Client, done: Callable[..., Job], tmp_path: Path, encoded: bytes
) -> None:
    """The engine finds out: the job and the analysis race."""
    (tmp_path / "scan.ply").write_bytes(encoded)
    with pytest.raises((JobFailedError, RefusedError), match="mesh_encoded"):
        done("fill", client.upload(tmp_path / "scan.ply").id, method={"method": "smooth"})


@pytest.mark.parametrize("damage", ["cut", "flipped", "longer", "magic alone"])
def test_a_hostile_qpz_file_ends_with_a_clear_code(
    client: Client, done: Callable[..., Job], tmp_path: Path, encoded: bytes, damage: str
) -> None:
    data, middle = encoded, len(encoded) // 2
    hostile = {
        "cut": data[:middle],
        "flipped": data[:middle] + bytes(255 - byte for byte in data[middle : middle + 40]) + data[middle + 40 :],
        "longer": data + data,
        "magic alone": data[:8],
    }[damage]
    path = tmp_path / "hostile.qpz"
    path.write_bytes(hostile)
    with pytest.raises((JobFailedError, RefusedError)) as caught:
        done("decode", client.upload(path).id)
    assert "unreadable_mesh" in str(caught.value)


def test_a_task_is_canceled_in_the_middle(
    client: Client, local_stack: Any, sent: Callable[..., Mesh], done: Callable[..., Job]
) -> None:
    vertices, triangles = relief(200)
    mesh = sent("large.ply", noisy(vertices), triangles)
    job = client.create_job(JobSpec.model_validate({"mesh_id": mesh.id, "task": "denoise"}))
    wait_until(lambda: client.job(job.id).stage is not None)
    assert client.cancel(job.id).state in (JobState.CANCELING, JobState.CANCELED)
    with pytest.raises(JobCanceledError):
        client.wait(job.id, timeout_s=GUARD_S)
    wait_until(lambda: not local_stack.engines() and not local_stack.requests())
    assert done("denoise", sent("small.ply", *relief(30)).id).state.has_result


def test_progress_and_picture_of_a_task_are_those_of_a_repair(
    client: Client, sent: Callable[..., Mesh], tmp_path: Path
) -> None:
    vertices, triangles = relief()
    mesh = sent("scan.ply", noisy(vertices), triangles)
    job = client.create_job(JobSpec.model_validate({"mesh_id": mesh.id, "task": "denoise", "method": SELF}))
    seen: list[Job] = []
    ended = client.wait(job.id, seen.append, timeout_s=GUARD_S)
    client.download(ended, "preview", tmp_path / "preview.png")
    assert (tmp_path / "preview.png").read_bytes().startswith(b"\x89PNG")
    assert [one.percent for one in seen] == sorted(one.percent for one in seen)
    assert report_of(client, ended, tmp_path)["stages"][-1]["name"] == "preview"
    assert ended.percent == 100.0


def test_a_reference_stays_as_long_as_its_job(
    client: Client, sent: Callable[..., Mesh], done: Callable[..., Job]
) -> None:
    vertices, triangles = relief(30)
    reference = sent("clean.ply", vertices + 0.5, triangles)
    job = done("denoise", sent("scan.ply", noisy(vertices), triangles).id, denoise={"reference": reference.id})
    with pytest.raises(RefusedError, match="mesh_in_use"):
        client._transport.request("DELETE", f"/v1/meshes/{reference.id}")
    client.delete(job.id)
    client._transport.request("DELETE", f"/v1/meshes/{reference.id}")
    with pytest.raises(RefusedError, match="mesh_not_found"):
        client.mesh(reference.id)


def test_a_reference_that_no_one_uploaded_is_refused(client: Client, sent: Callable[..., Mesh]) -> None:
    mesh = sent("scan.ply", *relief(30))
    spec = {"mesh_id": mesh.id, "task": "denoise", "denoise": {"reference": "f" * 64}}
    with pytest.raises(RefusedError, match="mesh_not_found"):
        client.create_job(JobSpec.model_validate(spec))


def test_the_files_of_stations_go_through_every_task_by_its_defaults(
    client: Client, done: Callable[..., Job], tmp_path: Path
) -> None:
    """STL, whose triangles share no vertex: what moves stays one surface, and comes back as STL."""
    vertices, triangles = relief(30)
    (tmp_path / "scan.stl").write_bytes(stl_bytes(noisy(vertices), triangles))
    mesh = client.upload(tmp_path / "scan.stl")
    denoised = done("denoise", mesh.id)
    before, after = read_scan(tmp_path / "scan.stl"), read_scan(fetched(client, denoised, tmp_path))
    assert (result_of(denoised).format, len(after.triangles)) == ("stl", len(triangles))
    assert len(np.unique(after.vertices, axis=0)) == len(np.unique(before.vertices, axis=0)) == len(vertices)
    indices = np.flatnonzero((before.vertices == before.vertices[100]).all(axis=1)).tolist()
    restored = done("restore", mesh.id, restore={"missing": {"kind": "indices", "indices": indices}})
    assert result_of(restored).format == "stl"
    assert result_of(restored).restored_vertices == len(indices)
    encoded = client.upload(fetched(client, done("encode", mesh.id, encode={"max_error": MAX_ERROR}), tmp_path))
    decoded = done("decode", encoded.id, output={"preview": False, "format": "stl"})
    assert len(read_scan(fetched(client, decoded, tmp_path)).triangles) > 100
