from collections.abc import Callable

import pytest

from dispatcher.missing_objects import MissingCounts, MissingObjects
from jobkit.database.session import Database
from jobkit.errors import StoreUnavailableError
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import MESH_MISSING, Meshes
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.retention import delete_job
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import Mesh, MeshState
from tests.jobkit.fixtures import AgingStore, finish, put, upload


@pytest.fixture
def look(database: Database, store: ObjectStore) -> MissingObjects:
    return MissingObjects(database, store)


def lose(database: Database, store: ObjectStore, mesh: Mesh) -> None:
    store.delete(Meshes(database).source(mesh.id).key)


def test_a_mesh_whose_bytes_are_gone_is_marked_once(
    database: Database, store: ObjectStore, mesh: Mesh, look: MissingObjects
) -> None:
    assert look.look() == MissingCounts()
    lose(database, store, mesh)
    assert look.look() == MissingCounts(meshes=1)
    seen = Meshes(database).get(mesh.id)
    assert seen.state == MeshState.REJECTED
    assert seen.problem is not None
    assert seen.problem.code == MESH_MISSING
    assert look.look() == MissingCounts()


def test_a_missing_mesh_is_analysed_again_once_it_is_uploaded_again(
    database: Database, store: ObjectStore, mesh: Mesh, look: MissingObjects
) -> None:
    lose(database, store, mesh)
    look.look()
    again = upload(database, store, b"ply\n")
    assert (again.id, again.state, again.problem, again.format) == (mesh.id, MeshState.ANALYSING, None, "ply")
    assert look.look() == MissingCounts()


def test_a_missing_mesh_is_analysed_again_once_the_disk_is_back(
    database: Database, store: ObjectStore, mesh: Mesh, look: MissingObjects
) -> None:
    lose(database, store, mesh)
    look.look()
    put(store, b"ply\n")
    assert look.look() == MissingCounts(found_again=1)
    assert Meshes(database).get(mesh.id).state == MeshState.ANALYSING


def test_bytes_that_arrive_while_the_sweep_looks_are_not_missing(
    database: Database, store: ObjectStore, mesh: Mesh
) -> None:
    """They come right after the store has said that there are none."""
    lose(database, store, mesh)

    class LateStore(AgingStore):
        def size(self, key: str) -> int:
            try:
                return super().size(key)
            finally:
                upload(database, store, b"ply\n")

    assert MissingObjects(database, LateStore(store)).look() == MissingCounts()
    assert Meshes(database).get(mesh.id).problem is None


def test_a_store_that_is_away_has_lost_nothing(database: Database, store: ObjectStore, mesh: Mesh) -> None:
    class AwayStore(AgingStore):
        def size(self, key: str) -> int:
            raise StoreUnavailableError("away")

    with pytest.raises(StoreUnavailableError):
        MissingObjects(database, AwayStore(store)).look()
    assert Meshes(database).get(mesh.id).problem is None


def test_finished_jobs_without_their_files_are_counted_and_kept(
    database: Database, store: ObjectStore, new_job: NewJob, look: MissingObjects
) -> None:
    job = finish(database, store, Jobs(database).create(new_job)[0].id)
    assert look.look() == MissingCounts()
    store.delete_prefix(f"results/{job.id}")
    assert look.look() == look.look() == MissingCounts(results=1)
    assert Jobs(database).get(job.id) == job
    delete_job(database, store, job.id)
    assert look.look() == MissingCounts()


def test_models_without_their_file_are_counted(
    database: Database, store: ObjectStore, look: MissingObjects, dictionary_bytes: Callable[[int], bytes]
) -> None:
    stored = put(store, dictionary_bytes(1), MODEL_PREFIX)
    Registry(database, store).publish("general-dictionary", stored)
    assert look.look() == MissingCounts()
    store.delete(stored.key)
    assert look.look() == MissingCounts(models=1)


def test_a_look_at_few_rows_goes_on_where_the_last_one_stopped(database: Database, store: ObjectStore) -> None:
    meshes = [upload(database, store, bytes([i])) for i in range(5)]
    for mesh in meshes:
        lose(database, store, mesh)
    few = MissingObjects(database, store, most=2)
    assert [few.look().meshes for _ in range(4)] == [2, 2, 1, 0]


def test_a_look_breaks_off_when_told(database: Database, store: ObjectStore, mesh: Mesh, look: MissingObjects) -> None:
    lose(database, store, mesh)
    assert look.look(lambda: True) == MissingCounts()
