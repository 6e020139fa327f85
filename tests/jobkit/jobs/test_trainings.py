"""What a training publishes, on either database.

Also tests `jobkit.models.publication`, `jobkit.models.aliases` and `jobkit.database.training_tables`.
"""

import threading
from collections.abc import Callable
from datetime import timedelta
from functools import partial

import pytest

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import ModelRow
from jobkit.errors import (
    MeshInUseError,
    MeshNotFoundError,
    ModelNotFoundError,
    NameTakenError,
    RowConflictError,
    StaleAttemptError,
)
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.endings import Attempt
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.search import JobSearch
from jobkit.jobs.trainings import check_names, register_learned
from jobkit.meshes import Meshes
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.retention import delete_job, delete_mesh, expire_meshes
from jobkit.storage.base import ObjectStore, StoredObject
from quadpatch_client.schema import Job, JobError, JobResult, JobState, NewTraining, ResolvedModel, TrainingResult

TENANT = "plant-north"
LOST = JobError(code="engine_crashed", message="it was killed", retryable=True)
Bytes = Callable[[int], bytes]


class Bench:
    """One tenant's database and store with uploaded meshes, and hands that do what a worker does."""

    def __init__(self, database: Database, store: ObjectStore, dictionary_bytes: Bytes) -> None:
        self.database, self.store, self.bytes = database.of(TENANT), store, dictionary_bytes
        self.jobs, self.attempts = Jobs(self.database), Attempts(self.database)
        self.registry = Registry(self.database, store)
        self.meshes = [self._mesh(b"ply %d" % i) for i in range(3)]

    def _mesh(self, data: bytes) -> str:
        with self.store.writer("meshes") as writer:
            writer.write(data)
            stored = writer.commit()
        return Meshes(self.database).add(stored, "scan.ply", "ply")[0].id

    def train(self, model: str = "walls", **rest: str) -> Job:
        """Make a training of all meshes."""
        new = NewTraining.model_validate({"model": model, "meshes": self.meshes, **rest})
        spec = new.job_spec(self.meshes, self.meshes[0])
        return self.jobs.create(NewJob(spec, ResolvedModel(requested=model, kind="none"), 3))[0]

    def row(self, seed: int, model: str = "walls") -> ModelRow:
        """Store what was learned, another dictionary for each seed."""
        with self.store.writer(MODEL_PREFIX) as writer:
            writer.write(self.bytes(seed))
            stored = writer.commit()
        return self.registry.prepared(model, stored, is_proven=True)

    def publish(self, job: Job, attempt: Attempt, seed: int = 1, *, is_better: bool = True) -> JobState:
        """Publish as a worker does."""
        train = job.spec.train
        assert train is not None
        row = self.row(seed, train.model)
        learned = TrainingResult(
            model=train.model,
            version=1,
            is_new=True,
            sha256=row.sha256,
            learned_from=self.meshes,
            patches=10,
            judged=[],
            is_better=is_better,
            verdict="judged",
        )
        result = JobResult(format="safetensors", training=learned)
        return self.attempts.publish(attempt, result, None, partial(register_learned, row=row, train=train))

    def learned(self, job: Job) -> TrainingResult:
        """What the training has published."""
        result = self.jobs.get(job.id).result
        assert result is not None
        assert result.training is not None
        return result.training

    def versions(self, model: str = "walls") -> list[int]:
        """Versions that are registered."""
        try:
            return [version.version for version in self.registry.get(model).versions]
        except ModelNotFoundError:
            return []


@pytest.fixture
def bench(any_database: Database, store: ObjectStore, dictionary_bytes: Bytes) -> Bench:
    return Bench(any_database, store, dictionary_bytes)


def test_a_training_makes_one_version_however_many_attempts_end(bench: Bench) -> None:
    job = bench.train()
    late = bench.attempts.start(job.id, "killed", 0).attempt
    bench.attempts.requeue(late, LOST)
    attempt = bench.attempts.start(job.id, "other", 30).attempt
    with pytest.raises(StaleAttemptError):
        bench.publish(job, late, 1)
    assert bench.versions() == []
    assert bench.publish(job, attempt, 2) == JobState.SUCCEEDED
    with pytest.raises(StaleAttemptError):
        bench.publish(job, late, 3)
    assert bench.versions() == [1]
    learned = bench.learned(job)
    assert (learned.version, learned.is_new, learned.alias, learned.verdict) == (1, True, None, "judged")
    assert bench.registry.usable("walls").sha256 == learned.sha256


def test_a_canceled_training_registers_nothing(bench: Bench) -> None:
    job = bench.train()
    attempt = bench.attempts.start(job.id, "w", 30).attempt
    bench.jobs.request_cancel(job.id)
    assert bench.publish(job, attempt) == JobState.CANCELED
    assert bench.versions() == []


def test_the_same_bytes_are_the_same_version(bench: Bench) -> None:
    for seed, number, is_new in ((1, 1, True), (2, 2, True), (1, 1, False)):
        job = bench.train()
        bench.publish(job, bench.attempts.start(job.id, "w", 30).attempt, seed)
        assert (bench.learned(job).version, bench.learned(job).is_new) == (number, is_new)


def test_trainings_that_end_at_once_get_numbers_of_their_own(bench: Bench) -> None:
    started = [(job := bench.train(), bench.attempts.start(job.id, "w", 30).attempt) for _ in range(4)]

    def publish(seed: int) -> None:
        while True:
            try:
                bench.publish(*started[seed], seed)
                return
            except RowConflictError:
                continue  # as a worker does

    threads = [threading.Thread(target=publish, args=(seed,)) for seed in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert bench.versions() == [4, 3, 2, 1]
    assert sorted(bench.learned(job).version for job, _ in started) == [1, 2, 3, 4]


@pytest.mark.parametrize(
    ("make_default", "is_better", "alias", "end"),
    [
        ("never", True, None, ""),
        ("if_better", True, "default", ": made default"),
        ("if_better", False, None, ": not made default"),
    ],
)
def test_the_alias_follows_the_verdict_where_that_is_asked_for(
    bench: Bench, make_default: str, is_better: bool, alias: str | None, end: str
) -> None:
    job = bench.train(make_default=make_default)
    bench.publish(job, bench.attempts.start(job.id, "w", 30).attempt, is_better=is_better)
    learned = bench.learned(job)
    assert (learned.alias, learned.verdict) == (alias, f"judged{end}")
    assert bench.registry.resolve("walls").aliases == ([] if alias is None else [alias])


def test_an_alias_that_cannot_be_moved_leaves_the_version(bench: Bench) -> None:
    job = bench.train(make_default="if_better", alias="default-network")
    bench.publish(job, bench.attempts.start(job.id, "w", 30).attempt)
    learned = bench.learned(job)
    assert learned.alias is None
    assert learned.verdict.startswith("judged: not made default-network, since 'default-network' means models of the ")
    assert bench.versions() == [1]


def test_a_name_that_is_taken_meanwhile_fails_the_attempt_and_leaves_nothing(bench: Bench) -> None:
    bench.train()
    job = bench.train("candidate")
    attempt = bench.attempts.start(job.id, "w", 30).attempt
    bench.registry.publish("other", _stored(bench), is_proven=True)
    bench.registry.set_alias("candidate", "other")
    with pytest.raises(NameTakenError):
        bench.publish(job, attempt, 5)
    assert bench.jobs.get(job.id).state == JobState.RUNNING
    with pytest.raises(NameTakenError):
        check_names(bench.database, job.spec.train)  # type: ignore[arg-type]


def test_its_meshes_are_kept_and_found_as_long_as_it_is(bench: Bench) -> None:
    job = bench.train()
    last = bench.meshes[-1]
    with pytest.raises(MeshInUseError, match="1 job names mesh"):
        delete_mesh(bench.database, last)
    assert [found.id for found in bench.jobs.page(10, None, JobSearch(mesh_id=last)).items] == [job.id]
    bench.jobs.request_cancel(job.id)
    later = utc_now() + timedelta(days=100)
    assert expire_meshes(bench.database, 30, later) == 0
    delete_job(bench.database, bench.store, job.id)
    delete_mesh(bench.database, last)
    assert expire_meshes(bench.database, 30, later) == len(bench.meshes) - 1
    with pytest.raises(MeshNotFoundError):
        bench.train()


def test_a_training_of_another_tenants_mesh_is_not_made(bench: Bench, any_database: Database) -> None:
    other = Jobs(any_database.of("plant-south"))
    spec = bench.train().spec
    with pytest.raises(MeshNotFoundError):
        other.create(NewJob(spec, ResolvedModel(requested="x", kind="none"), 3))


def _stored(bench: Bench) -> StoredObject:
    with bench.store.writer(MODEL_PREFIX) as writer:
        writer.write(bench.bytes(9))
        return writer.commit()
