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


def ply_vertex_colours(file: PlyFile) -> FloatArray | None:
    """Find the colours (n, 4) of the vertices alone, see `quadpatch.formats.scan.VertexAttributes`."""
    rows = file.element("vertex")
    return None if rows is None else _colours(rows)


def _columns(rows: Rows, choices: tuple[tuple[str, ...], ...]) -> FloatArray | None:
    """Columns of the first choice of names that the element has in full."""
    for names in choices:
        columns = [column for name in names if (column := rows.scalar(name)) is not None]
        if len(columns) == len(names):
            return np.stack([to_float64(column) for column in columns], axis=1)
    return None


def colour_columns(rows: Rows) -> tuple[tuple[str, ...], float] | None:
    """Names of the columns of red, green and blue, and full intensity; None where the element has no colours."""
    for names in _COLOURS:
        columns = [column for name in names if (column := rows.scalar(name)) is not None]
        if len(columns) == len(names):
            # Integers fill the range of their type, fractions run to 1.
            whole = columns[0].dtype.kind != "f"
            return names, float(np.iinfo(columns[0].dtype).max) if whole else 1.0
    return None


def _colours(rows: Rows) -> FloatArray | None:
    found = colour_columns(rows)
    colours = None if found is None else _columns(rows, (found[0],))
    if found is None or colours is None:
        return None
    alpha, top = _columns(rows, (("alpha",),)), found[1]
    opaque = np.full((len(colours), 1), top)
    return np.concatenate([colours, opaque if alpha is None else alpha], axis=1) * (255.0 / top)


def has_vertex_texture(file: PlyFile) -> bool:
    """Whether vertices have texture coordinates."""
    rows = file.element("vertex")
    return rows is not None and _columns(rows, _TEXTURES) is not None


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
