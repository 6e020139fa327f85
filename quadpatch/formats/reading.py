"""Reading a mesh file of any known format.

The format is told from the content, and from the suffix of the name only where the content leaves it open: a PLY
called `.stl` is a PLY.
"""

from pathlib import Path

from quadpatch.errors import FormatError, ReadError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.ply import read_ply
from quadpatch.formats.scan import Scan


def read_scan(path: Path, limits: ReadLimits | None = None) -> Scan:
    """Read a mesh file.

    Parameters
    ----------
    path : Path
    limits : ReadLimits, optional

    Raises
    ------
    MeshError
        ReadError, FormatError, EmptyMeshError, NotFiniteError, IndexRangeError or TooLargeError; nothing else,
        whatever the file holds.
    """
    limits = limits or ReadLimits()
    try:
        limits.check_bytes(path.stat().st_size)
        data = path.read_bytes()
    except OSError as error:
        raise ReadError(f"{path.name} can't be read: {error.strerror}") from error
    if data[:3] == b"ply":
        return read_ply(data, limits)
    raise FormatError(f"{path.name}: the format is not known")
