"""Calibrations of earlier repairs, kept so that the next repair of the same scan need not repeat them.

Each is kept under a key: a hash of all that calibration depends on. One that does not belong is never found.
"""

import hashlib
import json
import logging
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import scipy

import quadpatch
from quadpatch.calibration.record import CalibrationRecord, record_of
from quadpatch.filling.fairing import Energy
from quadpatch.types import FloatArray, IntArray
from quadpatch_rules.calibration_records import MOST_RECORDS, RecordError, check_record, read_records, write_records

_log = logging.getLogger(__name__)


class KeptCalibrations:
    """Records by key, oldest first.

    Parameters
    ----------
    scan : str
        Names the scan for sure, such as by the sha256 of its file; without, its arrays are hashed.
    """

    def __init__(self, scan: str = "") -> None:
        self.scan = scan
        self.has_new = False
        self._records: dict[str, CalibrationRecord] = {}

    @classmethod
    def read(cls, data: bytes, energies: Sequence[Energy], scan: str = "") -> "KeptCalibrations":
        """Read what `written` gave; a record that is damaged is left out, with a line in the log.

        Parameters
        ----------
        data : bytes
        energies : sequence of Energy
            Those that calibration may choose.
        scan : str
            See the class.

        Raises
        ------
        RecordError
            If it is something else.
        """
        kept = cls(scan)
        for key, fields in read_records(data, _log.warning).items():
            record = record_of(fields)
            if set(record.blend.energies) <= set(energies):
                kept._records[key] = record
        return kept

    def find(self, key: str) -> CalibrationRecord | None:
        """Return the record of a key, if there is one."""
        return self._records.get(key)

    def add(self, key: str, record: CalibrationRecord) -> None:
        """Keep a record, and drop the oldest of too many; one that could not be read again is not kept."""
        try:
            check_record(record.plain())
        except RecordError as error:
            _log.warning("a calibration is not kept: %s", error)
            return
        self._records.pop(key, None)
        self._records[key] = record
        for oldest in list(self._records)[:-MOST_RECORDS]:
            del self._records[oldest]
        self.has_new = True

    def written(self) -> bytes:
        """Write all of them as JSON."""
        return write_records({key: record.plain() for key, record in self._records.items()})


def key_of(*facts: str | float) -> str:
    """Hash what a calibration depends on, this software among it; floats count bit for bit."""
    return hashlib.sha256(
        json.dumps([_source_digest(), np.__version__, scipy.__version__, *facts]).encode()
    ).hexdigest()


def array_digest(*arrays: FloatArray | IntArray) -> str:
    """Hash arrays of any shape."""
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(f"{array.dtype.str}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()


@cache
def _source_digest() -> str:
    """Hash the source of the method: what other code found may be other than what this one would find."""
    digest, folder = hashlib.sha256(), Path(quadpatch.__file__).parent
    for path in sorted(folder.rglob("*.py")):
        digest.update(f"{path.relative_to(folder)}\n".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()
