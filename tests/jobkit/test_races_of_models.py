"""Many threads at one model: what is needed is never deleted, on either database."""

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from jobkit.database.session import Database
from jobkit.errors import JobkitError, ModelNotFoundError, StaleAttemptError
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.models.errors import ModelDeprecatedError, ModelInUseError
from jobkit.models.lifetime import delete_version, deprecate_version
from jobkit.models.proofs import Proofs
from jobkit.models.registry import Registry
from jobkit.storage.base import ObjectStore, StoredObject
from quadpatch_client.schema import JobSpec, Mesh, ModelState, ResolvedModel
from tests.waiting import GUARD_S

ROUNDS = 8
PINNED = ResolvedModel(requested="parts", kind="dictionary", name="parts", version=1)


@pytest.fixture
def database(any_database: Database) -> Database:
    return any_database


@pytest.fixture
def registry(database: Database, store: ObjectStore) -> Registry:
    return Registry(database, store)


@pytest.fixture
def publish(
    registry: Registry, store: ObjectStore, dictionary_bytes: Callable[[int], bytes]
) -> Callable[..., StoredObject]:
    def run(name: str, seed: int = 1, *, is_proven: bool = True) -> StoredObject:
        with store.writer("models") as writer:
            writer.write(dictionary_bytes(seed))
            stored = writer.commit()
        registry.publish(name, stored, is_proven=is_proven)
        return stored

    return run


def at_once(*calls: Callable[[], Any]) -> list[Any]:
    """Make all calls in the same moment; gives what they return, or the error where a call lost its race."""
    barrier = threading.Barrier(len(calls))

    def run(call: Callable[[], Any]) -> Any:
        barrier.wait(GUARD_S)
        try:
            return call()
        except JobkitError as error:
            return error

    with ThreadPoolExecutor(len(calls)) as pool:
        return list(pool.map(run, calls))


def test_a_job_and_a_deletion_never_both_succeed(
    database: Database, registry: Registry, mesh: Mesh, publish: Callable[..., StoredObject]
) -> None:
    for i in range(ROUNDS):
        name = f"parts-{i}"
        publish(name)
        new = NewJob(JobSpec(mesh_id=mesh.id), PINNED.model_copy(update={"name": name}), 3)
        job, deletion = at_once(
            lambda new=new: Jobs(database).create(new),  # type: ignore[misc]
            lambda name=name: delete_version(database, name, 1),  # type: ignore[misc]
        )
        if deletion is None:
            assert isinstance(job, ModelNotFoundError)
        else:
            assert isinstance(deletion, ModelInUseError)
            assert registry.resolve(f"{name}@1").version == 1


def test_an_alias_and_a_deletion_never_both_succeed(
    database: Database, registry: Registry, publish: Callable[..., StoredObject]
) -> None:
    for i in range(ROUNDS):
        name = f"parts-{i}"
        publish(name)
        alias, deletion = at_once(
            lambda i=i, name=name: registry.set_alias(f"alias-{i}", f"{name}@1"),  # type: ignore[misc]
            lambda name=name: delete_version(database, name, 1),  # type: ignore[misc]
        )
        assert isinstance(alias, ModelNotFoundError) != isinstance(deletion, ModelInUseError)
        assert (deletion is None) == isinstance(alias, ModelNotFoundError)


def test_default_never_comes_to_point_to_what_is_deprecated_at_that_moment(
    database: Database, registry: Registry, publish: Callable[..., StoredObject]
) -> None:
    publish("first")
    for i in range(ROUNDS):
        name = f"parts-{i}"
        publish(name)
        registry.set_alias("default", "first")
        at_once(
            lambda name=name: registry.set_alias("default", f"{name}@1"),  # type: ignore[misc]
            lambda name=name: deprecate_version(database, name, 1, ""),  # type: ignore[misc]
        )
        assert registry.resolve("default").deprecated is None


def test_versions_that_are_deleted_at_once_leave_no_number_free(
    database: Database, registry: Registry, publish: Callable[..., StoredObject]
) -> None:
    for seed in (1, 2, 3):
        publish("parts", seed)
    assert at_once(*(lambda n=n: delete_version(database, "parts", n) for n in (1, 2, 3))) == [None] * 3
    publish("parts", 1)
    assert registry.resolve("parts").version == 4


def test_a_number_is_not_taken_again_while_its_version_is_deleted(
    database: Database, registry: Registry, publish: Callable[..., StoredObject]
) -> None:
    for i in range(ROUNDS):
        name = f"parts-{i}"
        publish(name, 1)
        at_once(
            lambda name=name: delete_version(database, name, 1),  # type: ignore[misc]
            lambda name=name: publish(name, 2),  # type: ignore[misc]
        )
        assert registry.resolve(name).version == 2


def test_a_proof_is_started_by_one_of_many_workers(
    database: Database, registry: Registry, publish: Callable[..., StoredObject]
) -> None:
    publish("parts", is_proven=False)
    proofs = Proofs(database)
    started = at_once(*(lambda: proofs.start("parts@1", "w", 30) for _ in range(8)))
    assert sum(not isinstance(answer, StaleAttemptError) for answer in started) == 1
    assert registry.resolve("parts@1").state is ModelState.PROVING


def test_what_is_deprecated_gets_no_alias(
    database: Database, registry: Registry, publish: Callable[..., StoredObject]
) -> None:
    publish("parts")
    deprecate_version(database, "parts", 1, "why not")
    with pytest.raises(ModelDeprecatedError):
        registry.set_alias("ours", "parts@1")


def test_a_shipped_version_that_was_deleted_does_not_come_back(
    database: Database, registry: Registry, publish: Callable[..., StoredObject]
) -> None:
    stored = publish("parts")
    delete_version(database, "parts", 1)
    with pytest.raises(JobkitError, match="was deleted"):
        registry.publish("parts", stored, version=1, is_proven=True)
