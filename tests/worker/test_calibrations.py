import logging
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from jobkit.database.session import Database
from jobkit.meshes import Meshes
from jobkit.retention import delete_mesh
from jobkit.storage.base import StoredObject
from quadpatch_rules.calibration_records import MOST_BYTES, write_records
from tests.quadpatch_rules.test_calibration_records import KEY, record
from worker.calibrations import hand_on, take_back
from worker.engine.request import CALIBRATION_NAME

MESH = "a" * 64
KEPT = write_records({KEY: record()})


@pytest.fixture
def meshes(database: Database) -> Meshes:
    meshes = Meshes(database)
    meshes.add(StoredObject(key=f"meshes/{MESH}", size_bytes=1, sha256=MESH), "scan.ply", "ply")
    return meshes


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Of a request."""
    (tmp_path / "request").mkdir()
    return tmp_path / "request"


def test_what_an_engine_left_is_handed_to_the_next_one(meshes: Meshes, folder: Path) -> None:
    assert hand_on(meshes, MESH, folder) == b""
    assert list(folder.iterdir()) == []
    (folder / CALIBRATION_NAME).write_bytes(KEPT)
    take_back(meshes, MESH, folder, b"")
    (folder / CALIBRATION_NAME).unlink()
    assert hand_on(meshes, MESH, folder) == KEPT
    assert (folder / CALIBRATION_NAME).read_bytes() == KEPT


def test_what_was_handed_on_and_came_back_is_not_written_again(meshes: Meshes, folder: Path) -> None:
    (folder / CALIBRATION_NAME).write_bytes(KEPT)
    take_back(meshes, MESH, folder, KEPT)
    assert meshes.calibrations(MESH) is None


def test_it_ends_with_the_mesh(meshes: Meshes, database: Database, folder: Path) -> None:
    meshes.keep_calibrations(MESH, KEPT.decode())
    delete_mesh(database, MESH)
    (folder / CALIBRATION_NAME).write_bytes(KEPT)
    take_back(meshes, MESH, folder, b"")
    assert meshes.calibrations(MESH) is None
    meshes.add(StoredObject(key=f"meshes/{MESH}", size_bytes=1, sha256=MESH), "scan.ply", "ply")
    assert meshes.calibrations(MESH) is None


DAMAGED = ("", "{", '{"kind": "quadpatch calibration", "records": [1]}', "[" * 5000, "1e999")


@pytest.mark.parametrize("text", DAMAGED)
def test_a_row_that_is_damaged_is_ignored_with_a_line_in_the_log(
    meshes: Meshes, folder: Path, text: str, caplog: pytest.LogCaptureFixture
) -> None:
    meshes.keep_calibrations(MESH, text)
    with caplog.at_level(logging.WARNING):
        assert hand_on(meshes, MESH, folder) == b""
    assert f"kept calibrations of mesh {MESH} are damaged" in caplog.text
    assert list(folder.iterdir()) == []


def test_of_several_records_the_sound_ones_are_handed_on(
    meshes: Meshes, folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    meshes.keep_calibrations(MESH, write_records({KEY: record(), "f" * 64: record(belief=7.0)}).decode())
    with caplog.at_level(logging.WARNING):
        assert hand_on(meshes, MESH, folder) == KEPT
    assert f"mesh {MESH}: a kept calibration is left out" in caplog.text


LEFT_BEHIND: dict[str, Callable[[Path], object]] = {
    "a pipe that nothing writes to": os.mkfifo,
    "a link to another file": lambda path: path.symlink_to(path.with_name("kept")),
    "a folder": Path.mkdir,
    "too many bytes": lambda path: path.write_bytes(KEPT + b" " * MOST_BYTES),
    "another file": lambda path: path.write_bytes(b"ply\n"),
    "a damaged record": lambda path: path.write_bytes(write_records({KEY: record(best=9)})),
}


@pytest.mark.parametrize("name", LEFT_BEHIND)
def test_what_a_hostile_engine_left_is_not_kept(
    meshes: Meshes, folder: Path, name: str, caplog: pytest.LogCaptureFixture
) -> None:
    (folder / "kept").write_bytes(KEPT)
    LEFT_BEHIND[name](folder / CALIBRATION_NAME)
    with caplog.at_level(logging.WARNING):
        take_back(meshes, MESH, folder, b"")
    assert meshes.calibrations(MESH) is None
    assert MESH in caplog.text


def test_a_database_that_is_away_costs_the_calibration_alone(
    meshes: Meshes, database: Database, folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (folder / CALIBRATION_NAME).write_bytes(KEPT)
    with database.engine.begin() as connection:
        connection.exec_driver_sql("ALTER TABLE meshes RENAME TO meshes_away")
    with caplog.at_level(logging.WARNING):
        take_back(meshes, MESH, folder, b"")
        assert hand_on(meshes, MESH, folder) == b""
    assert "are not kept" in caplog.text
    assert "are not read" in caplog.text
