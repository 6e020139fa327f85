"""The scrub, on a real database and a real store."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from dispatcher.missing_objects import MissingCounts, MissingObjects
from dispatcher.scrub import Scrub, ScrubCounts, ScrubLimits
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.errors import StoreUnavailableError
from jobkit.jobs.jobs import Jobs
from jobkit.meshes import MESH_DAMAGED, Meshes
from jobkit.models.registry import MODEL_PREFIX, Registry
from jobkit.storage.base import CHUNK_BYTES, ObjectStore, result_key
from jobkit.storage.scrub_schedule import oldest_check
from quadpatch_client.schema import Mesh, MeshState
from tests.jobkit.fixtures import DAY, AgingStore, age_rows, damage, finish, new_job, put, upload
from tests.waiting import GUARD_S

LIMITS = ScrubLimits(days=30, bytes_per_s=1e9)


class Reads(AgingStore):
    """A real store that says which keys are read, and in which a sector can go bad or a line flip bits."""

    def __init__(self, store: ObjectStore) -> None:
        super().__init__(store)
        self.read_keys: list[str] = []
        self.unreadable: set[str] = set()
        self.flips = 0
        self.on_chunk: Callable[[], object] = lambda: None

    def read(self, key: str, start: int = 0, length: int | None = None) -> Iterator[bytes]:
        self.read_keys.append(key)
        return self._chunks(key, super().read(key, start, length))

    def _chunks(self, key: str, chunks: Iterator[bytes]) -> Iterator[bytes]:
        for chunk in chunks:
            self.on_chunk()
            if key in self.unreadable:
                raise StoreUnavailableError("a sector is bad")
            flipped, self.flips = self.flips > 0, max(0, self.flips - 1)
            yield bytes([chunk[0] ^ 1]) + chunk[1:] if flipped else chunk


@pytest.fixture
def reads(store: ObjectStore) -> Reads:
    return Reads(store)


@pytest.fixture
def scrub(database: Database, reads: Reads) -> Scrub:
    return Scrub(database, reads, LIMITS)


def key_of(database: Database, mesh: Mesh) -> str:
    return Meshes(database).source(mesh.id).key


def hold_everything(
    database: Database, store: ObjectStore, dictionary_bytes: Callable[[int], bytes]
) -> tuple[str, str, str]:
    """Let the store hold a mesh, a model and a result; return their keys."""
    mesh = upload(database, store, b"a scan")
    stored = put(store, dictionary_bytes(1), MODEL_PREFIX)
    Registry(database, store).publish("parts", stored)
    job = finish(database, store, Jobs(database).create(new_job(mesh))[0].id)
    return key_of(database, mesh), stored.key, result_key(job.id, job.attempt, "repaired.ply")


def test_every_object_that_a_row_names_is_read_once_in_the_period(
    database: Database, reads: Reads, scrub: Scrub, dictionary_bytes: Callable[[int], bytes]
) -> None:
    keys = hold_everything(database, reads, dictionary_bytes)
    put(reads, b"no row names it")
    assert scrub.round() == ScrubCounts()
    age_rows(database, 28 * DAY)
    size_bytes = sum(reads.size(key) for key in keys)
    assert scrub.round() == ScrubCounts(objects=3, size_bytes=size_bytes)
    assert sorted(reads.read_keys) == sorted(keys)
    assert scrub.round() == ScrubCounts()
    age_rows(database, 28 * DAY)
    assert scrub.round().objects == 3


@pytest.mark.parametrize("which", [0, 1, 2])
def test_damage_is_found_told_once_and_over_when_the_bytes_are_back(
    database: Database,
    any_store: ObjectStore,
    dictionary_bytes: Callable[[int], bytes],
    tmp_path: Path,
    which: int,
) -> None:
    key = hold_everything(database, any_store, dictionary_bytes)[which]
    scrub = Scrub(database, any_store, LIMITS)
    right = tmp_path / "backup"
    right.write_bytes(b"".join(any_store.read(key)))
    damage(any_store, key, tmp_path)
    age_rows(database, 28 * DAY)
    assert scrub.round().damaged == 1
    assert scrub.round() == ScrubCounts()
    age_rows(database, DAY)
    assert (found := scrub.round()).objects == 1
    assert found.damaged == 0
    any_store.put_file(key, right)
    age_rows(database, DAY)
    assert scrub.round().objects == 1
    age_rows(database, DAY)
    assert scrub.round() == ScrubCounts()


def test_a_damaged_mesh_is_rejected_and_analysed_again_once_it_is_whole(
    database: Database, reads: Reads, scrub: Scrub, mesh: Mesh, tmp_path: Path
) -> None:
    damage(reads, key_of(database, mesh), tmp_path)
    age_rows(database, 28 * DAY)
    scrub.round()
    seen = Meshes(database).get(mesh.id)
    assert seen.state is MeshState.REJECTED
    assert seen.problem is not None
    assert seen.problem.code == MESH_DAMAGED
    put(reads, b"ply\n")
    age_rows(database, DAY)
    scrub.round()
    assert Meshes(database).get(mesh.id).state is MeshState.ANALYSING


def test_bits_that_flip_on_the_way_are_no_damage(database: Database, reads: Reads, scrub: Scrub, mesh: Mesh) -> None:
    age_rows(database, 28 * DAY)
    reads.flips = 1
    assert scrub.round() == ScrubCounts(objects=1, size_bytes=2 * mesh.size_bytes)
    assert len(reads.read_keys) == 2


def test_bytes_that_come_again_while_they_are_read_are_no_damage(
    database: Database, reads: Reads, scrub: Scrub, mesh: Mesh, tmp_path: Path
) -> None:
    damage(reads, key_of(database, mesh), tmp_path)
    age_rows(database, 28 * DAY)
    upload_again = [lambda: upload(database, reads, b"ply\n")]
    reads.on_chunk = lambda: upload_again and upload_again.pop()()
    reads.flips = 2
    assert scrub.round().damaged == 0
    assert Meshes(database).get(mesh.id).state is MeshState.ANALYSING


def test_a_sector_that_cannot_be_read_holds_up_no_other_object(
    database: Database, reads: Reads, scrub: Scrub, mesh: Mesh
) -> None:
    reads.unreadable = {key_of(database, mesh)}
    age_rows(database, DAY)
    upload(database, reads, b"another")
    age_rows(database, 28 * DAY)
    assert scrub.round() == ScrubCounts(objects=2, size_bytes=len(b"another"), damaged=1)


def test_a_store_that_is_away_damages_nothing(
    database: Database, scrub: Scrub, mesh: Mesh, break_store: Callable[[], None]
) -> None:
    age_rows(database, 28 * DAY)
    break_store()
    with pytest.raises(StoreUnavailableError):
        scrub.round()
    assert Meshes(database).get(mesh.id).problem is None


def test_an_object_that_is_gone_is_left_to_the_sweep(
    database: Database, reads: Reads, scrub: Scrub, mesh: Mesh
) -> None:
    reads.delete(key_of(database, mesh))
    age_rows(database, 28 * DAY)
    assert scrub.round().damaged == 0
    assert MissingObjects(database, reads).look() == MissingCounts(meshes=1)


def test_a_round_reads_no_faster_and_no_more_than_it_may(database: Database, reads: Reads) -> None:
    for number in range(6):
        upload(database, reads, bytes([number]) * CHUNK_BYTES)
    age_rows(database, 28 * DAY)
    pauses: list[float] = []
    limits = ScrubLimits(days=30, bytes_per_s=CHUNK_BYTES / 50_000, round_s=100_000)
    slow = Scrub(database, reads, limits, pauses.append)
    for n_left in (4, 2, 0):
        assert slow.round().objects == 2
        assert len(set(reads.read_keys)) == 6 - n_left
    # Each round begins its own pace: 50,000 s for the first MiB, twice as much for both, less what reading took.
    assert all(50_000 - GUARD_S < pause <= 100_000 for pause in pauses)
    assert len(pauses) == 6


def test_a_round_breaks_off_in_the_middle_of_an_object_and_counts_it_not(
    database: Database, reads: Reads, scrub: Scrub
) -> None:
    upload(database, reads, bytes(3 * CHUNK_BYTES))
    age_rows(database, 28 * DAY)
    chunks: list[None] = []
    reads.on_chunk = lambda: chunks.append(None)
    assert scrub.round(lambda: len(chunks) >= 2) == ScrubCounts()
    assert scrub.round().objects == 1


def test_zero_days_switch_it_off(database: Database, reads: Reads, mesh: Mesh) -> None:
    age_rows(database, 3_000 * DAY)
    assert Scrub(database, reads, replace(LIMITS, days=0)).round() == ScrubCounts()
    assert reads.read_keys == []


def test_the_oldest_look_moves_on_with_what_is_read(
    any_database: Database, reads: Reads, dictionary_bytes: Callable[[int], bytes]
) -> None:
    hold_everything(any_database, reads, dictionary_bytes)
    age_rows(any_database, 28 * DAY)
    for age, act in ((28 * DAY, lambda: Scrub(any_database, reads, LIMITS).round()), (0 * DAY, lambda: None)):
        with any_database.read() as session:
            oldest = oldest_check(session)
        assert oldest is not None
        assert age <= utc_now() - oldest < age + DAY
        act()
