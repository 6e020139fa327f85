"""A file is parsed by an engine child and nowhere else; whatever it is, the workers live on."""

import itertools
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from quadpatch_client.errors import JobFailedError, MeshRejectedError, RefusedError
from quadpatch_client.progress import no_progress
from quadpatch_client.schema import Job, JobSpec, Mesh
from quadpatch_client.sdk import Client
from tests.waiting import GUARD_S

SHARED = Path(__file__).resolve().parents[3] / "shared"
INPUTS, CASES = SHARED / "inputs", SHARED / "cases"
# Errors without a code of their own: the engine met something that it was not made for.
UNCLEAR = ("engine_error", "engine_crashed", "")
# Side files of other meshes, the list of all of them, and what checks a repair.
NO_MESHES = {".bin", ".mtl", ".png", ".json", ".py"}
LARGE_BYTES = 20_000
SMOOTH = {"method": {"method": "smooth"}, "output": {"preview": False}}

HEADER = "ply\nformat ascii 1.0\nelement vertex {v}\nproperty float x\nproperty float y\nproperty float z\n"
FACES = "element face {f}\nproperty list uchar int vertex_indices\nend_header\n"
REACHING = (
    '{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],'
    '"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],'
    '"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],'
    '"bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"uri":"{uri}","byteLength":36}}]}}'
)
HOSTILE = {
    "reaching_up.gltf": (REACHING.format(uri="../request.json").encode(), "unreadable_mesh"),
    "reaching_out.gltf": (REACHING.format(uri="/etc/passwd").encode(), "unreadable_mesh"),
    "reaching_beside.gltf": (REACHING.format(uri="source.gltf").encode(), "unreadable_mesh"),
    "calling_home.gltf": (REACHING.format(uri="http://127.0.0.1:1/x").encode(), "unreadable_mesh"),
    "garbage.ply": (bytes(range(256)) * 40, "unreadable_mesh"),
    "garbage.stl": (b"solid nothing\n" + bytes(range(256)) * 4, "unreadable_mesh"),
    "truncated.ply": ((HEADER + FACES).format(v=3, f=1).encode() + b"0 0 0\n1 0 0\n", "unreadable_mesh"),
    "bomb.ply": ((HEADER + FACES).format(v=2_000_000_000, f=1).encode(), "mesh_too_large"),
    "infinite.ply": ((HEADER + FACES).format(v=3, f=1).encode() + b"0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "not_finite"),
    "index.ply": ((HEADER + FACES).format(v=3, f=1).encode() + b"0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "index_out_of_range"),
    "no_faces.ply": ((HEADER + FACES).format(v=3, f=0).encode() + b"0 0 0\n1 0 0\n0 1 0\n", "empty_mesh"),
    "surrogate.gltf": (REACHING.format(uri="data:;base64,AAAA").replace("VEC3", "\\ud800").encode(), "unreadable_mesh"),
    "forging.gltf": (REACHING.format(uri="\\n2026 INFO forged \\u001b[1m").encode(), "unreadable_mesh"),
    "notes.txt": (b"not a mesh at all", "unsupported_format"),
    "archive.3mf": (b"PK\x03\x04" + bytes(100), "unsupported_format"),
    "broken.glb": (b"glTF\x02\0\0\0\xff\xff\xff\x7f" + bytes(40), "unreadable_mesh"),
}


@pytest.fixture
def steady_workers(local_stack: Any) -> Iterator[None]:
    """Holds the local stack to the processes that it had before the test."""
    before = {worker.pid for worker in local_stack.workers()}
    assert before
    yield
    assert {worker.pid for worker in local_stack.workers()} == before


@pytest.mark.usefixtures("steady_workers")
@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_rejected_with_its_code(client: Client, tmp_path: Path, name: str) -> None:
    content, code = HOSTILE[name]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(MeshRejectedError) as caught:
        client.wait_for_mesh(_sent_as_it_is(client, path).id, timeout_s=GUARD_S)
    assert caught.value.problem.code == code
    assert str(tmp_path) not in caught.value.problem.message
    assert caught.value.problem.message.isprintable()


def _sent_as_it_is(client: Client, path: Path) -> Mesh:
    """Send a file without the client's look at it, which refuses a glTF that reaches out of its folder."""
    return client._upload(path, no_progress)


@pytest.mark.usefixtures("steady_workers")
def test_a_job_for_a_hostile_file_ends_with_its_code_too(client: Client, tmp_path: Path) -> None:
    path = tmp_path / "cut.ply"
    path.write_bytes((HEADER + FACES).format(v=4, f=1).encode() + b"0 0 0\n1 0 0\n")
    mesh = client.upload(path)
    code = _ending(client, mesh, _start(client, mesh, SMOOTH))
    assert code == "unreadable_mesh"


@pytest.mark.usefixtures("steady_workers")
@pytest.mark.parametrize("step", [pytest.param(1, marks=pytest.mark.slow, id="all"), pytest.param(6, id="some")])
def test_every_file_that_people_have_gives_a_mesh_or_an_error_with_a_code(
    client: Client, relief_file: Callable[[str], Path], step: int
) -> None:
    """By the default spec, with its picture; the largest files by geometry alone, which takes seconds."""
    if not INPUTS.is_dir():
        pytest.skip(f"there is no folder {SHARED.name} of real files beside this repository")
    files = dict([*_meshes_of(INPUTS).items(), *_meshes_of(CASES).items()][::step])
    is_small = {name: path.stat().st_size < LARGE_BYTES for name, path in files.items()}
    meshes = {name: client.upload(path) for name, path in files.items()}
    jobs = {name: _start(client, mesh, {} if is_small[name] else SMOOTH) for name, mesh in meshes.items()}
    endings = {name: _ending(client, meshes[name], job) for name, job in jobs.items()}
    assert {name: ending for name, ending in endings.items() if ending in UNCLEAR} == {}
    assert sum(ending == "mesh" for ending in endings.values()) > len(files) // 2
    repaired = [name for name in files if is_small[name] and endings[name] == "mesh"]
    assert [name for name in repaired if not _has_picture(client, jobs[name])] == []
    # And after all that, work goes on.
    mesh = client.wait_for_mesh(client.upload(relief_file("float.ply")).id, timeout_s=GUARD_S)
    assert mesh.facts is not None


def _has_picture(client: Client, job: Job | str) -> bool:
    return isinstance(job, Job) and client.job(job.id).links.preview is not None


def _meshes_of(folder: Path) -> dict[str, Path]:
    files = {
        f"{folder.name}/{path.relative_to(folder)}": path
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.suffix.lower() not in NO_MESHES
    }
    assert len(files) > 10
    return files


def _start(client: Client, mesh: Mesh, spec: dict[str, Any]) -> Job | str:
    try:
        return client.create_job(JobSpec.model_validate({"mesh_id": mesh.id, **spec}))
    except RefusedError as refusal:
        return refusal.problem.code


def _ending(client: Client, mesh: Mesh, job: Job | str) -> str:
    """`mesh`, or the code of the error."""
    if isinstance(job, Job):
        try:
            client.wait(job.id, timeout_s=GUARD_S)
        except JobFailedError as failure:
            return failure.job.error.code if failure.job.error else ""
        return "mesh"
    try:
        client.wait_for_mesh(mesh.id, timeout_s=GUARD_S)
    except MeshRejectedError as rejection:
        return rejection.problem.code
    return job


def test_all_codes_of_hostile_files_are_documented() -> None:
    from quadpatch import errors  # noqa: PLC0415 - the tree is drawn in its docstring

    for code in set(itertools.chain(code for _, code in HOSTILE.values())):
        assert f" {code} " in (errors.__doc__ or "")
