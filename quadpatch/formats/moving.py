"""Writing a scan with vertices at other positions: in its own format as the file that came in, else converted.

In its own format everything stays but the numbers of vertices that moved, and of their normals where the file stores
any: those would describe the surface as it was. What was written is read again before it is handed out: formats round
coordinates to their own type, and a file that shares its arrays in ways that this writer does not follow is converted
instead.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.errors import FormatError, NotFiniteError, StageError
from quadpatch.formats.limits import ReadLimits, check_vertices
from quadpatch.formats.merged_scene import MergedScene, moved_scene
from quadpatch.formats.output_files import write_whole
from quadpatch.formats.reading import read_bytes
from quadpatch.formats.scan import Moved, Scan
from quadpatch.formats.scene_parts import used_vertices
from quadpatch.formats.writing import ENCODERS, check_suffix, written_as
from quadpatch.stages import failure_of
from quadpatch.types import BoolArray, Vertices
from quadpatch_rules.coded_warnings import warning

__all__ = ["Moved", "write_moved"]

# Share of the bounding box's diagonal by which coordinates may be rounded without a word.
QUIET_ROUNDING = 1e-6
# Share beyond which a file's own numbers count as unfit for the mesh: integers, for one.
_MOST_ROUNDING = 1e-3

# Formats that hold 32-bit coordinates, and those that have normals of vertices.
_SINGLE = ("stl", "glb", "gltf")
_WITH_NORMALS = ("ply", "obj", "glb", "gltf")
_RESERVED = ("x", "y", "z")


def write_moved(path: Path, scan: Scan, moved: Moved) -> list[str]:
    """Write a scan with vertices at other positions.

    Parameters
    ----------
    path : Path
        Its suffix says the format; a stream without one gets that of the scan. The scan's own format gives the file
        that was read, with the bits of vertices that stay; another one is a conversion.
    scan : Scan
    moved : Moved

    Returns
    -------
    list of str
        Warnings: normals that were computed anew, properties that the format has no place for, what a conversion
        loses, and rounding of more than a millionth of the bounding box's diagonal.

    Raises
    ------
    FormatError
        If the suffix is that of no format that is written, or the format can't hold the mesh.
    NotFiniteError, CoordinateRangeError
        If a vertex moved to a position that no mesh has, or one without a position is to be converted.
    OSError
        If the file can't be written; what was there before stays.
    """
    check_suffix(path)
    suffix = written_as(path, scan).suffix.lower().lstrip(".")
    _check(scan, moved)
    data, warnings = _encode(suffix, scan, moved)
    write_whole(path, data)
    return warnings


def _check(scan: Scan, moved: Moved) -> None:
    """Refuse positions and properties that no file may hold."""
    check_vertices(moved.vertices, allow_missing=True)
    lost = moved.is_moved(scan) & ~np.isfinite(moved.vertices).all(axis=1)
    if lost.any():
        raise NotFiniteError(f"{int(lost.sum()):,} vertices lost their position, vertex {int(np.argmax(lost))} first")
    for name, values in moved.properties.items():
        if values.shape != (len(scan.vertices),) or name.split() != [name] or name in _RESERVED:
            raise ValueError(f"{name!r} of shape {values.shape} is no property of {len(scan.vertices)} vertices")


def _encode(suffix: str, scan: Scan, moved: Moved) -> tuple[bytes, list[str]]:
    own: list[tuple[bytes, list[str]]] = []
    warnings: list[str] = []
    if suffix == scan.format and scan.source is not None:
        failure = failure_of(lambda: own.append(_in_its_own_file(scan, moved)), passing=(FormatError,))
        if failure is not None:
            warnings.append(warning("file_written_anew", reason=failure))
    data, more = own[0] if own else _converted(suffix, scan, moved)
    return data, [*warnings, *more, *_lost_properties(suffix, moved.properties)]


def _in_its_own_file(scan: Scan, moved: Moved) -> tuple[bytes, list[str]]:
    """Change the file that was read, and read it again."""
    assert scan.source is not None
    data = scan.source.move(scan, moved)
    unlimited = len(data) + 2 * len(scan.vertices) + 2 * len(scan.triangles)
    limits = ReadLimits(unlimited * 1000, unlimited, unlimited, allow_missing=True)
    again = read_bytes(data, scan.format, limits).vertices
    # A glTF array has one row for the copies that primitives make of it, and some of them use it not.
    rounding = _largest_shift(again, moved.vertices, used_vertices(scan, moved))
    if rounding > _MOST_ROUNDING * _diagonal(moved):
        raise StageError(f"the numbers of the file would be off by up to {rounding:.3g}")
    warnings = _stale_normals(scan, moved)
    return data, [*warnings, *_rounded(rounding, moved)]


def _largest_shift(stored: Vertices, wanted: Vertices, rows: BoolArray) -> float:
    """Largest distance between some positions (n, 3) along an axis; infinite where they are not the same vertices."""
    if stored.shape != wanted.shape or (np.isnan(stored) != np.isnan(wanted))[rows].any():
        return np.inf
    return float(np.nanmax(np.abs(stored - wanted)[rows], initial=0.0))


def _diagonal(moved: Moved) -> float:
    there = moved.vertices[np.isfinite(moved.vertices).all(axis=1)]
    return float(np.linalg.norm(np.ptp(there, axis=0)))


def _rounded(rounding: float, moved: Moved) -> list[str]:
    if not rounding > QUIET_ROUNDING * _diagonal(moved):
        return []
    return [warning("coordinates_rounded", rounding=rounding)]


def _stale_normals(scan: Scan, moved: Moved) -> list[str]:
    n_moved = int(moved.is_moved(scan).sum())
    if n_moved == 0 or scan.source is None or scan.source.vertex_attributes(scan).normals is None:
        return []
    return [warning("normals_computed_anew", vertices=n_moved)]


def _converted(suffix: str, scan: Scan, moved: Moved) -> tuple[bytes, list[str]]:
    """Write the mesh in another format, with colours, normals and the like; where these fail, the shape alone."""
    missing = int(np.isnan(moved.vertices).any(axis=1).sum())
    if missing:
        raise NotFiniteError(f"{missing:,} vertices have no position, which {suffix} can't say: write {scan.format}")
    scenes: list[MergedScene] = []
    warnings: list[str] = []
    failure = failure_of(lambda: scenes.append(moved_scene(scan, moved)))
    if failure is None:
        warnings += _stale_normals(scan, moved) if suffix in _WITH_NORMALS else []
    else:
        warnings.append(warning("attributes_left_out", reason=failure))
        scenes.append(moved_scene(replace(scan, source=None), moved))
    single = moved.vertices.astype(np.float32).astype(np.float64)
    rounding = _largest_shift(single, moved.vertices, used_vertices(scan, moved)) if suffix in _SINGLE else 0.0
    return ENCODERS[suffix](scenes[0]), [*warnings, *_rounded(rounding, moved)]


def _lost_properties(suffix: str, properties: Mapping[str, Any]) -> list[str]:
    if suffix == "ply" or not properties:
        return []
    return [warning("numbers_left_out", format=suffix, names=", ".join(properties))]
