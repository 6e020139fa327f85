"""Jobs and meshes to start from."""

from pathlib import Path

import pytest

from jobkit.database import Database
from jobkit.jobs import Jobs, NewJob
from jobkit.meshes import Meshes
from jobkit.schema import Job, JobSpec, Mesh, ResolvedModel
from jobkit.store import ObjectStore, open_store


@pytest.fixture
def mesh(database: Database, store: ObjectStore) -> Mesh:
    with store.writer("meshes") as writer:
        writer.write(b"ply\n")
        stored = writer.commit()
    return Meshes(database).add(stored, "scan.ply", "ply")[0]


@pytest.fixture
def new_job(mesh: Mesh) -> NewJob:
    return NewJob(JobSpec(mesh_id=mesh.id), ResolvedModel(requested="self", kind="self"), max_attempts=2)


@pytest.fixture
def job(database: Database, new_job: NewJob) -> Job:
    return Jobs(database).create(new_job)[0]


@pytest.fixture
def any_store(tmp_path: Path) -> ObjectStore:
    """An empty store of either kind."""
    return open_store(f"file://{tmp_path}/objects")
