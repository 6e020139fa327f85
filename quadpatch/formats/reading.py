"""Reading a mesh file of any known format.

The format is told from the content, and from the suffix of the name only where the content leaves it open: a PLY
called `.stl` is a PLY. Whatever a file holds, reading it gives a `Scan` or a `MeshError`.
"""

from dataclasses import replace
from pathlib import Path

from quadpatch.errors import ReadError
from quadpatch.formats.detection import detect_format
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.obj import read_obj
from quadpatch.formats.off import read_off
from quadpatch.formats.ply.reader import read_ply
from quadpatch.formats.scan import Scan
from quadpatch.formats.stl import read_stl

__all__ = ["ReadLimits", "read_bytes", "read_scan"]

_READERS = {"stl": read_stl, "off": read_off}
# Those that may name further files.
_READERS_OF_FOLDERS = {"ply": read_ply, "obj": read_obj}


def read_scan(path: Path, limits: ReadLimits | None = None, *, allow_missing: bool = False) -> Scan:
    """Read a mesh file.

    Parameters
    ----------
    path : Path
    limits : ReadLimits, optional
    allow_missing : bool
        Let vertices pass whose three coordinates are NaN: they are missing, and are to be restored.

    Returns
    -------
    Scan
        Not empty, with finite coordinates, but for missing vertices, and faces that name vertices that are there.

    Raises
    ------
    MeshError
        ReadError, FormatError, EmptyMeshError, NotFiniteError, CoordinateRangeError, IndexRangeError or
        TooLargeError; nothing else, whatever the file holds.
    """
    limits = limits or ReadLimits()
    if allow_missing:
        limits = replace(limits, allow_missing=True)
    try:
        limits.check_bytes(path.stat().st_size)
        data = path.read_bytes()
    except OSError as error:
        raise ReadError(f"{path.name} can't be read: {error.strerror}") from error
    # Buffers of glTF, and images of textures, may lie beside the mesh.
    return read_bytes(data, detect_format(data, path.suffix.lower().lstrip(".")), limits, path.parent)


def read_bytes(data: bytes, kind: str, limits: ReadLimits, folder: Path | None = None) -> Scan:
    """Read a mesh out of the bytes of a file in a known format.

    Parameters
    ----------
    data : bytes
    kind : str
        As `detect_format` tells it.
    limits : ReadLimits
    folder : Path, optional
        Where further files of the mesh may lie; None allows none.

    Raises
    ------
    MeshError
        As `read_scan`.
    """
    # These two are packages, whose libraries the other formats do without.
    if kind in ("glb", "gltf"):
        from quadpatch.formats.gltf.reader import read_gltf  # noqa: PLC0415

        return read_gltf(data, limits, folder)
    if kind == "3mf":
        from quadpatch.formats.threemf.reader import read_threemf  # noqa: PLC0415

        return read_threemf(data, limits)
    if kind in _READERS_OF_FOLDERS:
        return _READERS_OF_FOLDERS[kind](data, limits, folder)
    return _READERS[kind](data, limits)
