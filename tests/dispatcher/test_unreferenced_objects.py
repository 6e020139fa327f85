from collections.abc import Callable
from datetime import timedelta
from pathlib import Path

import pytest

from dispatcher.unreferenced_objects import CONTENT_PREFIXES, GRACE, SweepResult, sweep_objects
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.errors import StoreUnavailableError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.retention import delete_mesh
from jobkit.storage.base import ObjectStore, result_key
from jobkit.storage.open import open_store
from jobkit.storage.removals import START_S, assure, claim, release
from jobkit.uploads.parts import PART_PREFIX, UploadPart
from jobkit.uploads.uploads import NewUpload, Uploads
from jobkit.views import VIEW_PREFIX, ViewOrder, Views
from quadpatch_client.schema import Job, Mesh, UploadKind
from tests.jobkit.fixtures import AgingStore, KilledError, age_rows, fail, finish, keys_in, put, upload

SOON = timedelta(minutes=1)


def sweep(database: Database, store: ObjectStore) -> SweepResult:
    return sweep_objects(database, store, utc_now())


@pytest.fixture
def aging(database: Database, store: ObjectStore, mesh: Mesh) -> AgingStore:
    """The store, a day after the mesh came."""
    old = AgingStore(store)
    old.wait(GRACE + SOON)
    age_rows(database, GRACE + SOON)
    return old


def test_what_rows_name_stays_whatever_its_age(
    database: Database, store: ObjectStore, new_job: NewJob, dictionary_bytes: Callable[[int], bytes]
) -> None:
    Registry(database, store).publish("general-dictionary", put(store, dictionary_bytes(1), MODEL_PREFIX))
    finish(database, store, Jobs(database).create(new_job)[0].id)
    before = keys_in(store)
    assert len(before) == 3
    assert sweep_objects(database, store, utc_now() + 2 * GRACE) == SweepResult()
    assert keys_in(store) == before


def test_what_no_row_names_goes_after_a_day_and_not_before(
    database: Database, store: ObjectStore, aging: AgingStore
) -> None:
    before = keys_in(store)
    orphans = [put(aging, b"broken off"), put(aging, b"no model", MODEL_PREFIX)]
    orphans.append(put(aging, b"of a job that is gone", key=result_key("job_gone", 1, "repaired.ply")))
    assert sweep(database, aging) == SweepResult()
    aging.wait(GRACE - SOON)
    assert sweep(database, aging) == SweepResult()
    aging.wait(2 * SOON)
    assert sweep(database, aging) == SweepResult(3, sum(orphan.size_bytes for orphan in orphans))
    assert keys_in(store) == before


def test_views_go_a_day_after_what_they_show(
    database: Database, store: ObjectStore, aging: AgingStore, mesh: Mesh
) -> None:
    views = Views(database)
    stored = put(aging, b"glTF", VIEW_PREFIX)
    views.publish(views.start(views.order(ViewOrder("outlines", mesh_id=mesh.id)).id, "w", 60), stored)
    aging.wait(GRACE + SOON)
    assert sweep(database, aging) == SweepResult()
    delete_mesh(database, mesh.id)
    anchor(database, aging)
    assert sweep(database, aging).objects == 2
    assert stored.key not in keys_in(store)


def test_files_of_attempts_that_published_nothing_go(
    database: Database, aging: AgingStore, new_job: NewJob, store: ObjectStore
) -> None:
    failed, lost_once, working = (Jobs(database).create(new_job)[0] for _ in range(3))
    fail(database, aging, failed.id)
    put(aging, b"of the lost attempt", key=result_key(lost_once.id, 0, "repaired.ply"))
    finish(database, aging, lost_once.id)
    attempt = Attempts(database).start(working.id, "w", 60).attempt
    put(aging, b"not published yet", key=result_key(working.id, attempt.number, "repaired.ply"))
    aging.wait(GRACE + SOON)
    assert sweep(database, aging).objects == 2
    left = {key for key in keys_in(store) if key.startswith("results/")}
    assert left == {result_key(lost_once.id, 1, "repaired.ply"), result_key(working.id, 1, "repaired.ply")}


def test_a_database_that_was_just_set_up_deletes_nothing(database: Database, store: ObjectStore) -> None:
    """It may be the wrong one, or its backup may not be restored yet."""
    put(store, b"of another time")
    aging = AgingStore(store)
    aging.wait(99 * GRACE)
    assert sweep(database, aging) == SweepResult()
    upload(database, aging, b"the first mesh")
    assert sweep(database, aging) == SweepResult()
    age_rows(database, GRACE + SOON)
    assert sweep(database, aging).objects == 1


def test_files_that_are_no_objects_are_left_alone(database: Database, data_dir: Path, mesh: Mesh) -> None:
    store = open_store(f"file://{data_dir / 'objects'}")
    odd = data_dir / "objects" / "meshes" / ".keep"
    odd.parent.mkdir(exist_ok=True)
    odd.touch()
    assert sweep_objects(database, store, utc_now() + 2 * GRACE) == SweepResult()
    assert odd.exists()


def test_bytes_that_come_again_before_the_last_look_are_kept(database: Database, aging: AgingStore, mesh: Mesh) -> None:
    """The sweep has claimed them as unreferenced when they arrive."""
    delete_mesh(database, mesh.id)
    anchor(database, aging)
    arrived: list[str] = []

    def send_again(prefix: str) -> None:
        if prefix not in ("results", *CONTENT_PREFIXES):
            arrived.append(put(aging, b"ply\n").key)

    aging.on_list = send_again
    assert sweep(database, aging) == SweepResult()
    assert len(arrived) == 1
    assure(database, aging, arrived[0], claim_wait_s=0)


def test_bytes_that_come_again_between_look_and_deletion_have_to_be_sent_once_more(
    database: Database, aging: AgingStore, mesh: Mesh
) -> None:
    delete_mesh(database, mesh.id)
    anchor(database, aging)

    def send_again(key: str) -> None:
        with pytest.raises(StoreUnavailableError, match="are being removed"):
            upload(database, aging, b"ply\n")

    aging.on_delete = send_again
    assert sweep(database, aging).objects == 1
    aging.on_delete = lambda key: None
    again = upload(database, aging, b"ply\n")
    assert b"".join(aging.read(Meshes(database).source(again.id).key)) == b"ply\n"


def test_bytes_that_were_swept_before_a_row_could_name_them_have_to_be_sent_once_more(
    database: Database, aging: AgingStore
) -> None:
    key = put(aging, b"of a sender that was asleep for a day").key
    aging.wait(GRACE + SOON)
    assert sweep(database, aging).objects == 1
    with pytest.raises(StoreUnavailableError, match="send them again"):
        assure(database, aging, key)


@pytest.mark.parametrize("kills_after", [False, True])
@pytest.mark.parametrize("step", range(6))
def test_a_sweep_that_is_killed_anywhere_is_done_by_the_next(
    database: Database, aging: AgingStore, mesh: Mesh, step: int, kills_after: bool
) -> None:
    orphans = {put(aging, b"one").key, put(aging, b"two").key, put(aging, b"three", MODEL_PREFIX).key}
    aging.wait(GRACE + SOON)
    aging.kill_countdown, aging.kills_after = step, kills_after
    with pytest.raises(KilledError):
        sweep(database, aging)
    age_rows(database, timedelta(hours=1))
    sweep(database, aging)
    assert keys_in(aging).isdisjoint(orphans)
    assert Meshes(database).source(mesh.id).key in keys_in(aging)


def test_a_sweep_breaks_off_when_told(database: Database, aging: AgingStore) -> None:
    put(aging, b"orphan")
    aging.wait(GRACE + SOON)
    assert sweep_objects(database, aging, utc_now(), lambda: True) == SweepResult()
    assert sweep(database, aging).objects == 1


def test_one_sweep_at_a_time_claims_a_key_and_none_that_has_a_name(database: Database, mesh: Mesh) -> None:
    named = Meshes(database).source(mesh.id).key
    assert claim(database, [named, "meshes/ab/a", "meshes/ab/b"]) == ["meshes/ab/a", "meshes/ab/b"]
    assert claim(database, ["meshes/ab/b", "meshes/ab/c"]) == ["meshes/ab/c"]
    release(database, ["meshes/ab/a", "meshes/ab/b"])
    assert claim(database, ["meshes/ab/b"]) == ["meshes/ab/b"]


def test_claims_of_a_killed_sweep_run_out_long_after_it_could_have_deleted_anything(database: Database) -> None:
    claim(database, ["meshes/ab/a"])
    age_rows(database, timedelta(seconds=2 * START_S))
    assert claim(database, ["meshes/ab/a"]) == []
    age_rows(database, timedelta(hours=1))
    assert claim(database, ["meshes/ab/a"]) == ["meshes/ab/a"]


def anchor(database: Database, store: ObjectStore) -> None:
    """Leave an old row in the database, so that it counts as grown up."""
    upload(database, store, b"another mesh")
    age_rows(database, GRACE + SOON)


def test_a_job_that_was_accepted_keeps_its_mesh_from_the_sweep(database: Database, aging: AgingStore, job: Job) -> None:
    aging.wait(99 * GRACE)
    assert sweep(database, aging) == SweepResult()
    assert aging.size(Meshes(database).source(job.mesh_id).key) == 4


def test_parts_that_no_upload_names_go_after_a_day_and_the_others_stay(
    database: Database, store: ObjectStore, aging: AgingStore
) -> None:
    uploads = Uploads(database, hours=100, most=10, max_bytes=1000)
    upload = uploads.create(NewUpload(UploadKind.WHOLE, 1000), None)[0]
    named = put(aging, b"acknowledged", key=f"{PART_PREFIX}/{upload.id}-0-a")
    uploads.acknowledge(upload.id, 0, [UploadPart(0, named.size_bytes, named.key, named.sha256)])
    orphan = put(aging, b"of a process that was killed", key=f"{PART_PREFIX}/{upload.id}-12-b")
    aging.wait(GRACE - SOON)
    assert sweep(database, aging) == SweepResult()
    aging.wait(2 * SOON)
    assert sweep(database, aging) == SweepResult(1, orphan.size_bytes)
    assert [found.key for found in store.keys(PART_PREFIX)] == [named.key]
