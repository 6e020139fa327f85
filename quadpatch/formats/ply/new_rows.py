"""Values of the rows that a fill adds to the elements of a PLY file.

Tested in `tests/quadpatch/formats/ply/test_writer.py`.
"""

import re

import numpy as np

from quadpatch.errors import FormatError
from quadpatch.formats.attributes import (
    extend_colours,
    extend_over_vertices,
    nearest_rim_triangle,
    nearest_rim_vertex,
    triangle_normals,
    vertex_normals,
)
from quadpatch.formats.limits import to_float64
from quadpatch.formats.ply.encoding import Table
from quadpatch.formats.ply.file import INDEX_NAMES, PlyFile
from quadpatch.formats.ply.header import Property, value_range
from quadpatch.formats.ply.rows import ListColumn, Rows, Values
from quadpatch.formats.ply.texture_files import NUMBER, texture_names
from quadpatch.formats.ply.vertex_attributes import colour_columns, wedge_texture
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.surface_texture import TexturePage
from quadpatch.formats.texture import extend_over_corners
from quadpatch.types import FloatArray, IntArray

# PLY type word, numpy code, name, and the value of a measured row.
MARKS = (("uchar", "u1", "filled", 0), ("int", "i4", "hole_id", -1), ("float", "f4", "confidence", 1))
# The number of a face's image: of files that name several, and of those that get a page.
PAGE_MARK = ("int", "i4", NUMBER, 0)

_COLOUR = re.compile(r"((diffuse|ambient|specular)_)?(red|green|blue|alpha|gray|grey|intensity|r|g|b|a)")
_NORMALS = ("nx", "ny", "nz")


def new_vertex_rows(scan: Scan, file: PlyFile, fill: Fill) -> list[Table]:
    """Rows of the new vertices, as one table.

    Numbers that vary smoothly are extended from the rim, normals are those of the new surface, and integers that are
    no colours, which may be flags or labels, are those of the nearest rim vertex.
    """
    rows = file.element("vertex")
    assert rows is not None  # read_ply refuses a file without vertices
    marks = _marks(fill.vertex_hole_id, fill.vertex_confidence)
    given: dict[str, Values] = {name: fill.vertices[:, axis] for axis, name in enumerate("xyz")}
    normals = vertex_normals(scan, fill)
    given |= {name: normals[:, axis] for axis, name in enumerate(_NORMALS)} | marks
    given |= _spread_columns(rows, fill, given)
    given |= _colours(rows, fill)
    nearest = nearest_rim_vertex(scan, fill)
    columns = [_column(rows, index, given, nearest) for index in range(len(rows.columns))]
    return [Table(len(fill.vertices), tuple(columns), marks)]


def _spread_columns(rows: Rows, fill: Fill, given: dict[str, Values]) -> dict[str, Values]:
    names = [
        prop.name
        for prop in rows.element.properties
        if prop.count_code is None and prop.name not in given and _is_continuous(prop)
    ]
    if not names:
        return {}
    columns = [to_float64(column) for name in names if (column := rows.scalar(name)) is not None]
    return dict(zip(names, extend_over_vertices(fill, np.stack(columns, axis=1)).T, strict=True))


def _colours(rows: Rows, fill: Fill) -> dict[str, Values]:
    """Columns of red, green and blue where the fill brings colours."""
    found = colour_columns(rows)
    if found is None or fill.vertex_colours is None:
        return {}
    names, top = found
    table = np.stack([to_float64(column) for name in names if (column := rows.scalar(name)) is not None], axis=1)
    return dict(zip(names, extend_colours(fill, table, top).T, strict=True))


def _is_continuous(prop: Property) -> bool:
    return prop.code[0] == "f" or _COLOUR.fullmatch(prop.name) is not None


def _column(rows: Rows, index: int, given: dict[str, Values], like: IntArray) -> Values:
    """Column of new rows: given by name, else empty lists, else that of the row it is like."""
    prop, old = rows.element.properties[index], rows.columns[index]
    if prop.count_code is not None:
        values = given.get(prop.name)
        return values if values is not None and values.ndim == 2 else np.zeros((len(like), 0))
    if prop.name in given and given[prop.name].ndim == 1:
        return given[prop.name]
    assert not isinstance(old, ListColumn)
    return old[like]


def _marks(hole: IntArray, confidence: FloatArray) -> dict[str, Values]:
    filled = np.ones(len(hole), dtype=np.uint8)
    return {"filled": filled, "hole_id": hole.astype(np.int32), "confidence": confidence.astype(np.float32)}


def new_carrier_rows(scan: Scan, file: PlyFile, fill: Fill) -> list[Table]:
    """Rows of the new triangles: one table for `face`, one for each hole for `tristrips`."""
    rows = file.element(file.carrier)
    assert rows is not None  # read_ply refuses a file without triangles
    index = rows.element.find(*INDEX_NAMES) or 0
    _check_index_type(rows.element.properties[index], len(scan.vertices) + len(fill.vertices))
    name = rows.element.properties[index].name
    if file.carrier == "tristrips":
        return [_strip_row(rows, name, fill, hole) for hole in np.unique(fill.triangle_hole_id)]
    marks = _marks(fill.triangle_hole_id, fill.triangle_confidence)
    normals = triangle_normals(scan, fill)
    given: dict[str, Values] = {axis: normals[:, i] for i, axis in enumerate(_NORMALS)}
    given |= marks | {name: fill.triangles} | _texture(scan, file, rows, fill)
    like = np.maximum(file.rows_of(nearest_rim_triangle(scan, fill)), 0)
    if fill.page is not None:
        numbers = _image_numbers(file, rows, fill.page, like)
        given, marks = given | numbers, marks | numbers
    columns = [_column(rows, i, given, like) for i in range(len(rows.columns))]
    return [Table(len(fill.triangles), tuple(columns), marks)]


def _check_index_type(prop: Property, n_vertices: int) -> None:
    if prop.code[0] != "f" and n_vertices - 1 > value_range(prop.code)[1]:
        raise FormatError(
            f"the PLY file numbers vertices in {8 * int(prop.code[1])} bits, too few for the {n_vertices:,} vertices "
            "of the repaired mesh: send it with int indices"
        )


def _strip_row(rows: Rows, name: str, fill: Fill, hole: int) -> Table:
    """One row of strips with all triangles of a hole, its confidence their mean."""
    chosen = fill.triangle_hole_id == hole
    triangles = fill.triangles[chosen]
    strips = np.column_stack([triangles, np.full(len(triangles), -1)]).reshape(1, -1)[:, :-1]
    confidence = np.atleast_1d(fill.triangle_confidence[chosen].mean())
    marks = _marks(np.atleast_1d(np.int64(hole)), confidence)
    given: dict[str, Values] = marks | {name: strips}
    columns = [_column(rows, i, given, np.zeros(1, dtype=np.int64)) for i in range(len(rows.columns))]
    return Table(1, tuple(columns), marks)


def _texture(scan: Scan, file: PlyFile, rows: Rows, fill: Fill) -> dict[str, Values]:
    """Per-wedge texture coordinates, as MeshLab writes them: six numbers a triangle."""
    coordinates = None if rows.list_column("texcoord") is None else wedge_texture(rows, file.triangle_row)
    if coordinates is None:
        return {}
    extended = extend_over_corners(scan, fill, coordinates)
    if fill.page is not None:
        extended = np.where(np.isfinite(fill.page.coordinates), fill.page.coordinates, extended)
    return {"texcoord": np.nan_to_num(extended.reshape(-1, 6))}


def _image_numbers(file: PlyFile, rows: Rows, page: TexturePage, like: IntArray) -> dict[str, Values]:
    """Return the number of each new triangle's image: that of the page, or of the row that it is like."""
    column = rows.scalar(NUMBER)
    old = np.zeros(len(like), np.int64) if column is None else to_float64(column[like]).astype(np.int64)
    return {NUMBER: np.where(page.material >= 0, len(texture_names(file)), old).astype(np.int32)}
