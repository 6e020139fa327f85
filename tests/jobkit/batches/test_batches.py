"""Also tests `jobkit/batches/progress.py`, `jobkit/batches/events.py`, `jobkit/database/batch_rows.py` and
`jobkit/database/batch_tables.py`."""

import threading
from collections.abc import Iterator
from dataclasses import replace

import pytest
from sqlalchemy import delete, func, select, update

from jobkit.batches.batches import Batches, BatchFacts
from jobkit.batches.events import read_new_batch_events
from jobkit.batches.progress import delete_batch, expire_batches, note_progress
from jobkit.database.batch_tables import BatchEventRow, BatchRow
from jobkit.database.clock import utc_now
from jobkit.database.idempotency import Idempotency
from jobkit.database.session import Database
from jobkit.database.tables import EventRow, IdempotencyRow, JobRow
from jobkit.errors import BatchSizeError, MeshNotFoundError
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.timeouts import TimeLimits
from jobkit.queue import TaskQueue
from jobkit.requeue import MOST_ENQUEUED, reconcile
from jobkit.retention import pin_job
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import MOST_JOBS, Batch, JobState
from tests.jobkit.fixtures import DAY, finish, keys_in, new_job, upload
from tests.waiting import GUARD_S

LIMITS = TimeLimits(queue_s=1e6, total_s=1e6, memory_mb=1000)


@pytest.fixture
def database(any_database: Database) -> Database:
    return any_database


@pytest.fixture
def new(database: Database, store: ObjectStore) -> NewJob:
    return new_job(upload(database, store, b"ply"))


@pytest.fixture
def queue(settings: Settings) -> Iterator[TaskQueue]:
    queue = TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)
    yield queue
    queue.close()


def make(database: Database, new: NewJob, n_jobs: int = 3) -> Batch:
    return Batches(database).create(BatchFacts(), lambda: [new] * n_jobs)[0]


def finish_all(database: Database, store: ObjectStore, batch: Batch) -> list[str]:
    ids = Batches(database).job_ids(batch.id, [JobState.QUEUED])
    for job_id in ids:
        finish(database, store, job_id)
    return ids


def test_jobs_keep_their_order_over_many_statements(database: Database, new: NewJob) -> None:
    jobs = [replace(new, spec=new.spec.model_copy(update={"seed": seed})) for seed in range(1203)]
    batch = Batches(database).create(BatchFacts(), lambda: jobs)[0]
    assert (batch.n_jobs, batch.counts) == (1203, {"queued": 1203})
    with database.read() as session:
        seeds = session.scalars(select(JobRow.spec["seed"].as_integer()).order_by(JobRow.id)).all()
        assert session.scalar(select(func.count()).select_from(EventRow)) == 1203
    assert seeds == [*range(1203)]


def test_what_fails_in_the_middle_leaves_nothing(database: Database, new: NewJob) -> None:
    def jobs() -> Iterator[NewJob]:
        yield from [new] * 700
        yield replace(new, spec=new.spec.model_copy(update={"mesh_id": "0" * 64}))

    with pytest.raises(MeshNotFoundError):
        Batches(database).create(BatchFacts(), jobs)
    for n_jobs in (0, MOST_JOBS + 1):
        with pytest.raises(BatchSizeError):
            make(database, new, n_jobs)
    with database.read() as session:
        for table in (BatchRow, BatchEventRow, JobRow, EventRow):
            assert session.scalar(select(func.count()).select_from(table)) == 0


def test_two_requests_with_one_key_at_one_moment_make_one_batch(database: Database, new: NewJob) -> None:
    idempotency, made = Idempotency("p", "k", "0"), list[str]()

    def create() -> None:
        made.append(Batches(database).create(BatchFacts(), lambda: [new] * 3, idempotency)[0].id)

    threads = [threading.Thread(target=create) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(GUARD_S)
    assert len(made) == 4
    assert len(set(made)) == 1
    with database.read() as session:
        assert session.scalar(select(func.count()).select_from(JobRow)) == 3


def test_two_dispatchers_write_each_change_once(database: Database, store: ObjectStore, new: NewJob) -> None:
    batch = make(database, new, 6)
    for job_id in Batches(database).job_ids(batch.id):
        finish(database, store, job_id)
        threads = [threading.Thread(target=note_progress, args=(database,)) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(GUARD_S)
    events = Batches(database).events(batch.id).items
    assert [event.sequence for event in events] == [*range(1, len(events) + 1)]
    assert [event.type for event in events] == ["started", *["progress"] * 5, "ended"]
    with database.read() as session:
        news = read_new_batch_events(session, {batch.id: 5, "bat_unknown": 0}, 100)
    assert [event.sequence for event in news[batch.id].events] == [6, 7]
    assert news[batch.id].is_all
    assert list(news) == [batch.id]


def test_a_cancel_goes_on_where_a_dispatcher_was_stopped(database: Database, new: NewJob) -> None:
    batch = make(database, new, 120)
    Batches(database).request_cancel(batch.id)
    looks = iter([False, False, True])
    note_progress(database, lambda: next(looks))
    assert Batches(database).get(batch.id).counts == {"canceled": 50, "queued": 70}
    assert note_progress(database) == 1
    assert Batches(database).get(batch.id).counts == {"canceled": 120}


def test_a_batch_whose_jobs_are_deleted_ends(database: Database, store: ObjectStore, new: NewJob) -> None:
    batch = make(database, new, 2)
    for job_id in Batches(database).job_ids(batch.id):
        Jobs(database).request_cancel(job_id)
    with database.write() as session:
        for row in session.scalars(select(JobRow)):
            session.execute(delete(EventRow).where(EventRow.job_id == row.id))
            session.delete(row)
    assert note_progress(database) == 1
    ended = Batches(database).get(batch.id)
    assert (ended.state, ended.n_jobs, ended.counts) == ("ended", 2, {})


def test_a_deletion_takes_all_of_it_and_its_key(database: Database, store: ObjectStore, new: NewJob) -> None:
    idempotency = Idempotency("p", "k", "0")
    batch = Batches(database).create(BatchFacts(), lambda: [new] * 60, idempotency)[0]
    pin_job(database, finish_all(database, store, batch)[0], True)
    note_progress(database)
    delete_batch(database, store, batch.id)
    with database.read() as session:
        for table in (BatchRow, BatchEventRow, JobRow, IdempotencyRow):
            assert session.scalar(select(func.count()).select_from(table)) == 0
    assert not [key for key in keys_in(store) if key.startswith("results")]


def test_it_expires_after_the_last_of_its_jobs(database: Database, store: ObjectStore, new: NewJob) -> None:
    batch = make(database, new, 1)
    finish_all(database, store, batch)
    note_progress(database)
    later = utc_now() + 31 * DAY
    assert expire_batches(database, 30, later) == 0
    with database.write() as session:
        session.execute(delete(EventRow))
        session.execute(update(JobRow).values(batch_id=None))
    assert expire_batches(database, 0, later) == 0
    assert expire_batches(database, 30, later) == 1
    assert Batches(database).page(9).items == []


def test_pages_go_from_the_newest_on(database: Database, new: NewJob) -> None:
    ids = [make(database, new, 1).id for _ in range(3)]
    ids.sort(reverse=True)
    first = Batches(database).page(2)
    assert [batch.id for batch in first.items] == ids[:2]
    rest = Batches(database).page(2, first.next_cursor)
    assert ([batch.id for batch in rest.items], rest.next_cursor) == (ids[2:], None)


def test_a_large_batch_comes_into_the_queue_in_parts(database: Database, new: NewJob, queue: TaskQueue) -> None:
    make(database, new, MOST_ENQUEUED + 20)
    assert reconcile(database, queue, LIMITS).enqueued_jobs == MOST_ENQUEUED
    assert reconcile(database, queue, LIMITS).enqueued_jobs == 20
    assert reconcile(database, queue, LIMITS).enqueued_jobs == 0
    assert sum(entry.startswith("job_") for entry in queue.entries()) == MOST_ENQUEUED + 20
