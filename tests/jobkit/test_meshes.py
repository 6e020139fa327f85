from collections.abc import Callable

import pytest

from jobkit.database.session import Database
from jobkit.errors import MeshNotFoundError, StaleAttemptError
from jobkit.meshes import Meshes
from jobkit.storage.base import StoredObject
from quadpatch_client.schema import BoundingBox, Mesh, MeshFacts, MeshProblem, MeshState

FACTS = MeshFacts(
    format="stl",
    vertices=3,
    triangles=1,
    bounding_box=BoundingBox(min=[0, 0, 0], max=[1, 1, 0]),
    diagonal=1.4,
    mean_edge_length=1.1,
    holes=[],
)
PROBLEM = MeshProblem(code="unreadable_mesh", message="the header promises 10 vertices, 3 follow")


@pytest.fixture
def meshes(database: Database) -> Meshes:
    return Meshes(database)


def stored(mesh: Mesh) -> StoredObject:
    return StoredObject("meshes/ab/abc", mesh.size_bytes, mesh.id)


def test_the_same_bytes_are_the_same_mesh(meshes: Meshes, mesh: Mesh) -> None:
    again, is_new = meshes.add(stored(mesh), "another-name.ply", "ply")
    assert not is_new
    assert again == mesh.model_copy(update={"filename": "another-name.ply"})


def test_an_upload_without_a_name_leaves_the_mesh_its_own(meshes: Meshes, mesh: Mesh) -> None:
    assert meshes.add(stored(mesh), None, None)[0] == mesh


def test_a_rejected_mesh_gets_a_new_chance_under_another_format(meshes: Meshes, mesh: Mesh) -> None:
    meshes.reject(meshes.start_analysis(mesh.id, "w", 30), PROBLEM)
    assert meshes.add(stored(mesh), "scan.ply", "ply")[0].state == MeshState.REJECTED
    again, is_new = meshes.add(stored(mesh), "scan.stl", "stl")
    assert not is_new
    assert (again.state, again.format, again.problem) == (MeshState.ANALYSING, "stl", None)


def test_an_analysed_mesh_keeps_its_facts_whatever_it_is_called_later(meshes: Meshes, mesh: Mesh) -> None:
    meshes.publish(meshes.start_analysis(mesh.id, "w", 30), FACTS)
    again, _ = meshes.add(stored(mesh), "scan.obj", "obj")
    assert again.state == MeshState.READY
    assert again.facts == FACTS
    assert again.format == "stl"


def test_one_worker_at_a_time_analyses_a_mesh(meshes: Meshes, mesh: Mesh) -> None:
    first = meshes.start_analysis(mesh.id, "w1", 30)
    assert (first.source.key, first.source.format, first.attempt) == (meshes.source(mesh.id).key, "ply", 1)
    with pytest.raises(StaleAttemptError):
        meshes.start_analysis(mesh.id, "w2", 30)


def test_a_late_analysis_writes_nothing(meshes: Meshes, mesh: Mesh) -> None:
    late = meshes.start_analysis(mesh.id, "w1", -1)
    fresh = meshes.start_analysis(mesh.id, "w2", 30)
    writes: list[Callable[[], None]] = [
        lambda: meshes.publish(late, FACTS),
        lambda: meshes.reject(late, PROBLEM),
        lambda: meshes.renew(late, 30),
        lambda: meshes.release(late),
    ]
    for write in writes:
        with pytest.raises(StaleAttemptError):
            write()
    meshes.renew(fresh, 30)
    meshes.publish(fresh, FACTS)
    with pytest.raises(StaleAttemptError):
        meshes.start_analysis(mesh.id, "w3", 30)


def test_an_analysis_that_is_handed_back_can_be_taken_at_once(meshes: Meshes, mesh: Mesh) -> None:
    meshes.release(meshes.start_analysis(mesh.id, "w1", 30))
    assert meshes.start_analysis(mesh.id, "w2", 30).attempt == 2


def test_an_unknown_mesh_is_named_as_such(meshes: Meshes) -> None:
    with pytest.raises(MeshNotFoundError, match="f" * 64):
        meshes.get("f" * 64)
