"""Views in the database: one of each, fenced, given up, gone with what they show."""

from datetime import timedelta

import pytest
from sqlalchemy import func, select, update

from jobkit.database.clock import shared_now
from jobkit.database.quotas import stored_bytes
from jobkit.database.session import Database
from jobkit.database.view_tables import ViewRow
from jobkit.errors import JobNotFoundError, MeshNotFoundError, ModelNotFoundError, StaleAttemptError, StorageQuotaError
from jobkit.jobs.jobs import Jobs
from jobkit.queue import TaskQueue, view_entry
from jobkit.retention import delete_job, delete_mesh
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.views import FAILED, MADE, MAKING, MAX_TRIES, MOST_BYTES, View, ViewOrder, Views
from quadpatch_client.schema import Mesh, Quotas
from tests.jobkit.fixtures import finish, new_job, put, upload


@pytest.fixture
def views(database: Database) -> Views:
    return Views(database)


@pytest.fixture
def mesh(database: Database, store: ObjectStore) -> Mesh:
    return upload(database, store, b"ply")


@pytest.fixture
def queue(settings: Settings) -> TaskQueue:
    return TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, settings.job_time_limit_s)


def made(views: Views, store: ObjectStore, view: View, data: bytes = b"glTF") -> None:
    views.publish(views.start(view.id, "w", 60), put(store, data, "views"))


def n_views(database: Database) -> int:
    with database.read() as session:
        return session.scalar(select(func.count()).select_from(ViewRow)) or 0


def later(database: Database, by: timedelta) -> None:
    """Set what the queue was told, and all leases, back."""
    with database.write() as session:
        then = shared_now(session) - by
        session.execute(update(ViewRow).values(enqueued_at=then))
        session.execute(update(ViewRow).where(ViewRow.lease_until.is_not(None)).values(lease_until=then))


def test_there_is_one_view_of_each_level(views: Views, mesh: Mesh, database: Database) -> None:
    coarse, again = (views.order(ViewOrder("mesh", mesh_id=mesh.id, level="coarse")) for _ in range(2))
    fine = views.order(ViewOrder("mesh", mesh_id=mesh.id, level="fine"))
    assert coarse.id == again.id != fine.id
    assert (coarse.state, coarse.is_due, coarse.stored) == (MAKING, True, None)
    assert n_views(database) == 2


@pytest.mark.parametrize(
    ("order", "error"),
    [
        (ViewOrder("mesh", mesh_id="0" * 64), MeshNotFoundError),
        (ViewOrder("job", job_id="job_00000000000000000000000000"), JobNotFoundError),
        (ViewOrder("model", model_name="none", model_version=1), ModelNotFoundError),
    ],
)
def test_there_is_no_view_of_what_is_not_there(views: Views, order: ViewOrder, error: type[Exception]) -> None:
    with pytest.raises(error):
        views.order(order)


def test_a_view_of_another_tenant_is_another_one(
    database: Database, store: ObjectStore, mesh: Mesh, views: Views
) -> None:
    other = database.of("other")
    with pytest.raises(MeshNotFoundError):
        Views(other).order(ViewOrder("mesh", mesh_id=mesh.id))
    assert upload(other, store, b"ply").id == mesh.id
    assert Views(other).order(ViewOrder("mesh", mesh_id=mesh.id)).id != views.order(ViewOrder("mesh", mesh.id)).id


def test_a_made_view_says_where_it_lies_and_counts_as_stored(
    views: Views, mesh: Mesh, store: ObjectStore, database: Database
) -> None:
    order = ViewOrder("outlines", mesh_id=mesh.id)
    with database.read() as session:
        before = stored_bytes(session, "default")
    made(views, store, views.order(order), b"glTF, made")
    view = views.order(order)
    assert (view.state, view.is_due) == (MADE, False)
    assert view.stored is not None
    assert b"".join(store.read(view.stored.key)) == b"glTF, made"
    with database.read() as session:
        assert stored_bytes(session, "default") == before + 10
    assert views.unfinished([view.id]) == set()


def test_only_the_latest_attempt_may_write(views: Views, mesh: Mesh, store: ObjectStore, database: Database) -> None:
    view = views.order(ViewOrder("mesh", mesh_id=mesh.id))
    first = views.start(view.id, "w", 60)
    with pytest.raises(StaleAttemptError):
        views.start(view.id, "w2", 60)
    later(database, timedelta(seconds=1))
    second = views.start(view.id, "w2", 60)
    with pytest.raises(StaleAttemptError):
        views.renew(first, 60)
    with pytest.raises(StaleAttemptError):
        views.refuse(first, "empty_mesh", "no face")
    with pytest.raises(StaleAttemptError):
        views.release(first)
    views.renew(second, 60)
    views.publish(second, put(store, b"glTF", "views"))
    assert views.order(ViewOrder("mesh", mesh_id=mesh.id)).state == MADE


def test_a_view_is_given_up_after_three_tries_that_count(views: Views, mesh: Mesh, database: Database) -> None:
    view = views.order(ViewOrder("mesh", mesh_id=mesh.id))
    views.forgive(views.start(view.id, "w", 60))
    attempts = []
    for _ in range(MAX_TRIES):
        attempts.append(views.start(view.id, "w", 60))
        later(database, timedelta(seconds=1))
    assert [attempt.is_last for attempt in attempts] == [False, False, True]
    with pytest.raises(StaleAttemptError):
        views.start(view.id, "w", 60)
    assert (views.order(ViewOrder("mesh", mesh_id=mesh.id)).state) == FAILED


def test_a_refusal_is_told_in_words(views: Views, mesh: Mesh) -> None:
    view = views.order(ViewOrder("mesh", mesh_id=mesh.id))
    views.refuse(views.start(view.id, "w", 60), "empty_mesh", "no face")
    assert views.order(ViewOrder("mesh", mesh_id=mesh.id)).problem == "empty_mesh: no face"


def test_a_view_comes_into_the_queue_in_front_and_once(
    views: Views, mesh: Mesh, queue: TaskQueue, database: Database
) -> None:
    order = ViewOrder("mesh", mesh_id=mesh.id)
    queue.enqueue_inspection(mesh.id, 1)
    views.submit(queue, views.order(order))
    view = views.order(order)
    assert not view.is_due
    later(database, timedelta(seconds=11))
    assert views.order(order).is_due
    views.submit(queue, view)
    assert queue.depth() == 2
    assert next(iter(queue._queue.get_job_ids())) == view_entry(view.id, 1)
    queue._queue.empty()
    later(database, timedelta(seconds=11))
    views.submit(queue, views.order(order))
    assert queue.entries() == {view_entry(view.id, 1)}


def test_a_view_that_was_handed_back_is_submitted_again(views: Views, mesh: Mesh, queue: TaskQueue) -> None:
    view = views.order(ViewOrder("mesh", mesh_id=mesh.id))
    attempt = views.start(view.id, "w", 60)
    views.release(attempt)
    views.resubmit(queue, attempt)
    assert queue.entries() == {view_entry(view.id, 2)}


def test_a_view_whose_bytes_are_lost_is_made_again(views: Views, mesh: Mesh, store: ObjectStore) -> None:
    order = ViewOrder("mesh", mesh_id=mesh.id)
    made(views, store, views.order(order))
    views.remake(views.order(order))
    assert (views.order(order).state, views.order(order).is_due) == (MAKING, True)
    made(views, store, views.order(order))
    assert views.order(order).state == MADE


@pytest.mark.parametrize("remove", ["reference", "job"])
def test_a_view_goes_with_what_it_shows(
    remove: str, views: Views, mesh: Mesh, store: ObjectStore, database: Database
) -> None:
    job, _ = Jobs(database).create(new_job(mesh))
    finish(database, store, job.id)
    reference = upload(database, store, b"ply, another one")
    made(views, store, views.order(ViewOrder("job", mesh_id=mesh.id, job_id=job.id, reference_id=reference.id)))
    assert n_views(database) == 1
    if remove == "reference":
        delete_mesh(database, reference.id)
    else:
        delete_job(database, store, job.id)
    assert n_views(database) == 0


def test_a_view_of_a_mesh_goes_with_it(views: Views, mesh: Mesh, database: Database) -> None:
    views.order(ViewOrder("outlines", mesh_id=mesh.id))
    delete_mesh(database, mesh.id)
    assert n_views(database) == 0


def test_comparisons_end_where_the_quota_of_the_tenant_does(
    views: Views, mesh: Mesh, store: ObjectStore, database: Database
) -> None:
    limited = database.of("small").limited(Quotas(stored_bytes=MOST_BYTES))
    scan, reference = upload(limited, store, b"ply"), upload(limited, store, b"ply, another one")
    Views(limited).order(ViewOrder("mesh", mesh_id=scan.id, level="fine"))
    with pytest.raises(StorageQuotaError):
        Views(limited).order(ViewOrder("job", mesh_id=scan.id, reference_id=reference.id))
    views.order(ViewOrder("job", mesh_id=mesh.id, reference_id=mesh.id))
    assert n_views(database) == 2
