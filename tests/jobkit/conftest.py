"""Jobs and meshes to start from."""

import shutil
from collections.abc import Iterator
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from jobkit.database.session import Database
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.storage.base import ObjectStore
from jobkit.storage.open import open_store
from quadpatch_client.schema import DictionaryMethod, Job, JobSpec, Mesh, ResolvedModel
from tests.servers import fresh_bucket, fresh_database


@pytest.fixture
def mesh(database: Database, store: ObjectStore) -> Mesh:
    with store.writer("meshes") as writer:
        writer.write(b"ply\n")
        stored = writer.commit()
    return Meshes(database).add(stored, "scan.ply", "ply")[0]


@pytest.fixture
def new_job(mesh: Mesh) -> NewJob:
    spec = JobSpec(mesh_id=mesh.id, method=DictionaryMethod(method="dictionary", model="self"))
    return NewJob(spec, ResolvedModel(requested="self", kind="self"), max_attempts=2)


@pytest.fixture
def job(database: Database, new_job: NewJob) -> Job:
    return Jobs(database).create(new_job)[0]


@pytest.fixture(params=["local", "s3"])
def any_store(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[ObjectStore]:
    """An empty store of either kind."""
    if request.param == "local":
        yield open_store(f"file://{tmp_path}/objects")
        return
    with fresh_bucket(request.getfixturevalue("s3")) as bucket:
        yield open_store(f"s3://{bucket}/a/prefix", tmp_path / "scratch")


@pytest.fixture(params=["sqlite", "postgresql"])
def any_database(request: pytest.FixtureRequest, tmp_path: Path, migrated_file: Path) -> Iterator[Database]:
    """A migrated, empty database of either kind."""
    with ExitStack() as stack:
        if request.param == "sqlite":
            url = f"sqlite:///{shutil.copy(migrated_file, tmp_path / 'copy.db')}"
        else:
            url = stack.enter_context(fresh_database(request.getfixturevalue("postgres")))
        yield stack.enter_context(closing(Database(url)))
