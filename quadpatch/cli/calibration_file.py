"""The file of `fill --calibration`: what calibration found out, for the next repair of the same scan.

Tested in `tests/quadpatch/cli/test_fill.py`.
"""

from pathlib import Path
from typing import TYPE_CHECKING

from quadpatch.errors import OptionError
from quadpatch.formats.output_files import is_stream, write_whole
from quadpatch_rules.calibration_records import MOST_BYTES, RecordError

if TYPE_CHECKING:
    from quadpatch.calibration.kept import KeptCalibrations


def read_calibrations(path: Path | None) -> "KeptCalibrations | None":
    """Read the file, if one was named; one that is not there yet keeps nothing.

    Raises
    ------
    OptionError
        If it is something else, which must not be written over.
    OSError
        If it can't be read.
    """
    if path is None:
        return None
    # Numerical libraries.
    from quadpatch.calibration.kept import KeptCalibrations  # noqa: PLC0415
    from quadpatch.recipes.fairing_energies import CALIBRATED_ENERGIES  # noqa: PLC0415

    if is_stream(path):
        raise OptionError(f"{path} can't be read and replaced: --calibration names a file")
    if not path.exists():
        return KeptCalibrations()
    try:
        with path.open("rb") as file:
            return KeptCalibrations.read(file.read(MOST_BYTES + 1), CALIBRATED_ENERGIES)
    except RecordError as error:
        raise OptionError(f"{path} is no file of --calibration, and stays as it is: {error}") from error


def write_calibrations(path: Path | None, kept: "KeptCalibrations | None") -> None:
    """Write the file, if one was named and a calibration has been added."""
    if path is not None and kept is not None and kept.has_new:
        write_whole(path, kept.written())
