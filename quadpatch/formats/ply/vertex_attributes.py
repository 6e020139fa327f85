"""Colours, normals and texture coordinates of PLY files, by the names that programs give them.

Tested in `tests/quadpatch/formats/test_conversion.py`.
"""

import numpy as np

from quadpatch.formats.limits import to_float64
from quadpatch.formats.ply.file import PlyFile
from quadpatch.formats.ply.rows import Rows
from quadpatch.formats.scan import Scan, VertexAttributes
from quadpatch.types import FloatArray, IntArray

_COLOURS = (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b"))
_TEXTURES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))


def ply_vertex_attributes(scan: Scan, file: PlyFile) -> VertexAttributes:
    """Find the colours, normals and texture coordinates of the measured surface.

    Parameters
    ----------
    scan : Scan
    file : PlyFile
        What it was read from.
    """
    rows = file.element("vertex")
    if rows is None:
        return VertexAttributes()
    normals = _columns(rows, (("nx", "ny", "nz"),))
    faces = file.element("face")
    texture = None if faces is None else wedge_texture(faces, file.triangle_row)
    by_vertex = _columns(rows, _TEXTURES)
    if texture is None and by_vertex is not None:
        texture = by_vertex[scan.triangles]
    return VertexAttributes(_colours(rows), normals, texture)


def _columns(rows: Rows, choices: tuple[tuple[str, ...], ...]) -> FloatArray | None:
    """Columns of the first choice of names that the element has in full."""
    for names in choices:
        columns = [column for name in names if (column := rows.scalar(name)) is not None]
        if len(columns) == len(names):
            return np.stack([to_float64(column) for column in columns], axis=1)
    return None


def _colours(rows: Rows) -> FloatArray | None:
    colours = _columns(rows, _COLOURS)
    if colours is None:
        return None
    alpha = _columns(rows, (("alpha",),))
    column = next(column for name in ("red", "diffuse_red", "r") if (column := rows.scalar(name)) is not None)
    # Integers fill the range of their type, fractions run to 1.
    top = 1.0 if column.dtype.kind == "f" else float(np.iinfo(column.dtype).max)
    opaque = np.full((len(colours), 1), top)
    return np.concatenate([colours, opaque if alpha is None else alpha], axis=1) * (255.0 / top)


def wedge_texture(rows: Rows, triangle_row: IntArray) -> FloatArray | None:
    """Texture coordinates of each corner, as MeshLab writes them: a list `texcoord` of six numbers a triangle.

    Parameters
    ----------
    rows : Rows
        Of the element `face`.
    triangle_row : (m,) int64
        Row of each triangle, -1 for none.

    Returns
    -------
    (m, 3, 2) float64 or None
        NaN for polygons and for faces with another number of values; None where the file has no such list.
    """
    texture = rows.list_column("texcoord")
    if texture is None:
        return None
    corners = rows.list_column("vertex_indices", "vertex_index")
    wedged = (triangle_row >= 0) & (texture.counts[triangle_row] == 6)
    if corners is not None:
        wedged &= corners.counts[triangle_row] == 3
    coordinates = np.full((len(triangle_row), 3, 2), np.nan)
    places = texture.starts[triangle_row[wedged]][:, np.newaxis] + np.arange(6)
    coordinates[wedged] = texture.values[places].reshape(-1, 3, 2)
    return coordinates
