"""What the leading dispatcher removes, on a real database and a real store."""

from collections.abc import Callable
from datetime import timedelta

from dispatcher.periodic_tasks import periodic_tasks
from dispatcher.retention import Sweeper, remove_expired
from dispatcher.unreferenced_objects import GRACE
from jobkit.database.leadership import Leadership
from jobkit.database.session import Database
from jobkit.database.upload_tables import UploadRow
from jobkit.jobs.jobs import Jobs
from jobkit.meshes import Meshes
from jobkit.queue import TaskQueue
from jobkit.retention import pin_mesh
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.uploads.parts import PART_PREFIX, UploadPart
from jobkit.uploads.uploads import NewUpload, Uploads
from quadpatch_client.schema import Upload, UploadKind
from tests.jobkit.fixtures import DAY, AgingStore, age_rows, finish, keys_in, new_job, put, upload


def never() -> bool:
    return False


def test_expired_jobs_go_before_the_meshes_that_they_held(
    settings: Settings, database: Database, store: ObjectStore
) -> None:
    mesh = upload(database, store, b"scan")
    finish(database, store, Jobs(database).create(new_job(mesh))[0].id)
    assert remove_expired(settings, database, store, never) == ""
    age_rows(database, 31 * DAY)
    assert remove_expired(settings, database, store, never) == "removed 1 jobs, 1 meshes"
    assert remove_expired(settings, database, store, never) == ""


def test_a_sweep_tells_what_it_found_in_either_direction(database: Database, store: ObjectStore) -> None:
    aging = AgingStore(store)
    kept, lost = upload(database, aging, b"kept"), upload(database, aging, b"lost")
    pin_mesh(database, kept.id, True)
    job = finish(database, aging, Jobs(database).create(new_job(kept))[0].id)
    sweeper = Sweeper(database, aging)
    assert sweeper.sweep(never) == ""
    put(aging, b"without a row")
    store.delete(Meshes(database).source(lost.id).key)
    store.delete_prefix(f"results/{job.id}")
    aging.wait(GRACE + timedelta(minutes=1))
    age_rows(database, GRACE + timedelta(minutes=1))
    assert sweeper.sweep(never) == (
        "deleted 1 objects without a row, 13 bytes; 1 meshes are gone from the store and were marked; "
        "1 finished jobs lack files of their result"
    )
    upload(database, aging, b"lost")
    store.delete(Meshes(database).source(lost.id).key)
    assert "1 meshes are gone" in sweeper.sweep(never)
    put(aging, b"lost")
    assert "1 meshes are in the store again" in sweeper.sweep(never)


def test_all_are_duties_of_the_dispatcher(settings: Settings, database: Database, store: ObjectStore) -> None:
    queue = TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)
    leadership = Leadership(database, "dispatcher", "a", 60)
    tasks = {task.name: task for task in periodic_tasks(settings, database, store, queue, leadership)}
    upload(database, store, b"scan")
    age_rows(database, 31 * DAY)
    assert tasks["retention"].work(never) == "removed 1 meshes"
    assert tasks["sweep"].work(never) == ""
    assert {tasks[name].interval_s for name in ("retention", "sweep")} == {settings.sweep_s}
    assert len(keys_in(store)) == 1
    upload(database, store, b"kept")
    age_rows(database, 28 * DAY)
    assert tasks["scrub"].work(never) == "checked 1 objects, 4 bytes; 0 more are damaged"
    assert tasks["scrub"].work(never) == ""
    queue.close()


def test_expired_uploads_go_with_their_bytes(settings: Settings, database: Database, store: ObjectStore) -> None:
    uploads = Uploads(database, hours=24, most=10, max_bytes=1000)
    kept, expired = (begun(uploads, store, name) for name in (b"kept", b"expired"))
    age_uploads(database, expired.id)
    assert remove_expired(settings, database, store, never) == "removed 1 uploads"
    assert keys_in(store) == {part.key for part in uploads.parts(kept.id)}
    assert remove_expired(settings, database, store, never) == ""


def test_an_upload_is_removed_though_the_store_is_away(
    settings: Settings, database: Database, store: ObjectStore, break_store: Callable[[], None]
) -> None:
    expired = begun(Uploads(database, hours=24, most=10, max_bytes=1000), store, b"expired")
    age_uploads(database, expired.id)
    break_store()
    assert remove_expired(settings, database, store, never) == "removed 1 uploads"


def begun(uploads: Uploads, store: ObjectStore, data: bytes) -> Upload:
    """Do what the service does with the first bytes of a resumable upload."""
    upload = uploads.create(NewUpload(UploadKind.WHOLE, 1000), None)[0]
    stored = put(store, data, key=f"{PART_PREFIX}/{upload.id}-0-a")
    return uploads.acknowledge(upload.id, 0, [UploadPart(0, len(data), stored.key, stored.sha256)])


def age_uploads(database: Database, upload_id: str) -> None:
    with database.write() as session:
        session.get_one(UploadRow, upload_id).expires_at -= timedelta(hours=25)
