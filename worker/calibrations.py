"""What calibration found out about a mesh: from one repair of it to the next, by way of its row.

Engines write it, and they read untrusted files: it is checked on its way in and on its way out. A repair does without
where anything fails.
"""

import logging
import os
from pathlib import Path

from jobkit.errors import DatabaseError, DatabaseUnavailableError
from jobkit.meshes import Meshes
from quadpatch_rules.calibration_records import MOST_BYTES, RecordError, read_records, write_records
from worker.engine.request import CALIBRATION_NAME

_log = logging.getLogger("quadpatch.worker.calibrations")


def hand_on(meshes: Meshes, mesh_id: str, folder: Path) -> bytes:
    """Put what repairs of a mesh have kept into the folder of a request; return it, empty where there is nothing."""
    try:
        text = meshes.calibrations(mesh_id)
    except (DatabaseUnavailableError, DatabaseError) as error:
        _log.warning("calibrations of mesh %s are not read: %s", mesh_id, error)
        return b""
    data = b"" if text is None else _checked(text.encode(errors="replace"), mesh_id)
    if data:
        (folder / CALIBRATION_NAME).write_bytes(data)
    return data


def take_back(meshes: Meshes, mesh_id: str, folder: Path, before: bytes) -> None:
    """Keep what an engine left in its folder, unless that is what it was handed."""
    try:
        # An engine may be led to put a link or a pipe there.
        descriptor = os.open(folder / CALIBRATION_NAME, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        with os.fdopen(descriptor, "rb") as file:
            data = _checked(file.read(MOST_BYTES + 1) or b"", mesh_id)
        if data and data != before:
            meshes.keep_calibrations(mesh_id, data.decode())
    except FileNotFoundError:
        return
    except (DatabaseUnavailableError, DatabaseError, OSError) as error:
        _log.warning("calibrations of mesh %s are not kept: %s", mesh_id, error)


def _checked(data: bytes, mesh_id: str) -> bytes:
    """Return what is sound in kept calibrations; say what is not."""
    try:
        records = read_records(data, lambda reason: _log.warning("mesh %s: %s", mesh_id, reason))
    except RecordError as error:
        _log.warning("kept calibrations of mesh %s are damaged: %s", mesh_id, error)
        return b""
    return write_records(records) if records else b""
