"""Writing a mesh that came from no mesh file: its shape alone.

A PLY has no property besides the coordinates. The other formats are those of a scan without attributes.
"""

from pathlib import Path

import numpy as np

from quadpatch.formats.output_files import write_whole
from quadpatch.formats.precision import check_precision
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.writing import check_suffix, write_scan, written_as
from quadpatch.types import TriangleMesh


def write_mesh(path: Path, mesh: TriangleMesh, unit: str | None) -> list[str]:
    """Write a mesh.

    Parameters
    ----------
    path : Path
        Its suffix says the format; a stream without one gets PLY.
    mesh : TriangleMesh
    unit : str or None
        Length unit, where one is known.

    Returns
    -------
    list of str
        Warnings, as where the format's numbers are short.

    Raises
    ------
    FormatError, PrecisionError
        If the format is not written, or can't hold the mesh.
    OSError
        If the file can't be written; what was there before stays.
    """
    check_suffix(path)
    scan = Scan(mesh.vertices, mesh.triangles, "ply", unit)
    named = written_as(path, scan)
    warnings = check_precision(scan, named)
    if named.suffix.lower() != ".ply":
        return [*warnings, *write_scan(path, scan, _nothing())]
    write_whole(path, encode_plain_ply(mesh, unit))
    return warnings


def encode_plain_ply(mesh: TriangleMesh, unit: str | None) -> bytes:
    """Encode as binary little-endian PLY, coordinates as float32 where that is exact and else as float64."""
    single = mesh.vertices.astype("<f4")
    is_exact = bool((single == mesh.vertices).all())
    places = single if is_exact else mesh.vertices.astype("<f8")
    rows = np.zeros(len(mesh.triangles), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, mesh.triangles
    lines = ["ply", "format binary_little_endian 1.0", *([f"comment unit {unit}"] if unit else [])]
    lines.append(f"element vertex {len(places)}")
    lines += [f"property {'float' if is_exact else 'double'} {axis}" for axis in "xyz"]
    lines += [f"element face {len(rows)}", "property list uchar int vertex_indices", "end_header", ""]
    return "\n".join(lines).encode() + places.tobytes() + rows.tobytes()


def _nothing() -> Fill:
    no_index, no_number = np.zeros(0, np.int64), np.zeros(0)
    return Fill(np.zeros((0, 3)), np.zeros((0, 3), np.int64), no_index, no_number, no_index, no_number)
