"""Writing a mesh in another format than the one it came in: PLY, STL, OBJ and OFF.

Coordinates are exact in PLY (as float64 where float32 would round them), OBJ and OFF; STL knows float32 only.
Colours, normals and texture coordinates go along where the format has a place for them.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quadpatch.formats.merged_scene import MergedScene
from quadpatch.formats.obj_source import GROUP, face_lines
from quadpatch.formats.ply.moved_rows import property_word
from quadpatch.formats.stl import encode_stl
from quadpatch.formats.text import to_lines
from quadpatch.mesh.weld import first_of_equal
from quadpatch.types import FloatArray, IntArray


class _Column(NamedTuple):
    """A PLY property: its words in the header, and (n,) numbers or (n, k) lists in the type to be written."""

    words: str
    values: NDArray[Any]


def encode_as_ply(scene: MergedScene) -> bytes:
    """Encode as binary little-endian PLY with the marks `filled`, `hole_id` and `confidence`, if there are any."""
    attributes = scene.vertex_attributes
    single = scene.vertices.astype("<f4")
    exact = bool((single == scene.vertices).all())
    columns = _columns("float" if exact else "double", "x y z", single if exact else scene.vertices.astype("<f8"))
    if attributes.normals is not None:
        columns += _columns("float", "nx ny nz", attributes.normals.astype("<f4"))
    if attributes.colours is not None:
        columns += _columns("uchar", "red green blue alpha", np.rint(attributes.colours).astype("u1"))
    columns += [
        _Column(f"{property_word(values)} {name}", _plain(values)) for name, values in scene.vertex_properties.items()
    ]
    columns += _marks(scene.vertex_hole_id, scene.vertex_confidence) if scene.is_marked else []
    faces = [_Column("list uchar int vertex_indices", scene.triangles.astype("<i4"))]
    if attributes.texture is not None:
        flat = np.nan_to_num(attributes.texture).reshape(-1, 6)
        faces.append(_Column("list uchar float texcoord", flat.astype("<f4")))
    faces += _marks(scene.triangle_hole_id, scene.triangle_confidence) if scene.is_marked else []
    lines = ["ply", "format binary_little_endian 1.0", *([f"comment unit {scene.unit}"] if scene.unit else [])]
    for name, element in (("vertex", columns), ("face", faces)):
        lines.append(f"element {name} {len(element[0].values)}")
        lines += [f"property {column.words}" for column in element]
    return "\n".join([*lines, "end_header", ""]).encode() + _rows(columns) + _rows(faces)


def _plain(values: NDArray[Any]) -> NDArray[Any]:
    """Numbers as little-endian PLY stores them; truth values are bytes."""
    plain = values.astype("u1") if values.dtype == np.bool_ else values
    return plain.astype("<" + plain.dtype.str[1:])


def _columns(word: str, names: str, table: NDArray[Any]) -> list[_Column]:
    return [_Column(f"{word} {name}", column) for name, column in zip(names.split(), table.T, strict=True)]


def _marks(hole: IntArray, confidence: FloatArray) -> list[_Column]:
    return [
        _Column("uchar filled", (hole >= 0).astype("u1")),
        _Column("int hole_id", hole.astype("<i4")),
        _Column("float confidence", confidence.astype("<f4")),
    ]


def _rows(columns: list[_Column]) -> bytes:
    fields: list[Any] = []
    for number, (_, values) in enumerate(columns):
        if values.ndim == 2:
            fields.append((f"n{number}", "u1"))
        fields.append((f"p{number}", values.dtype, values.shape[1:]))
    rows = np.zeros(len(columns[0].values), np.dtype(fields))
    for number, (_, values) in enumerate(columns):
        if values.ndim == 2:
            rows[f"n{number}"] = values.shape[1]
        rows[f"p{number}"] = values
    return rows.tobytes()


def encode_as_stl(scene: MergedScene) -> bytes:
    """Encode as binary STL; invented facets have the attribute 1."""
    return encode_stl(scene.vertices[scene.triangles], scene.facet_normals, scene.invented)


def encode_as_obj(scene: MergedScene) -> bytes:
    """Encode as OBJ; invented faces stand in a group of their own."""
    attributes = scene.vertex_attributes
    vertices = scene.vertices
    if attributes.colours is not None:
        vertices = np.concatenate([vertices, np.round(attributes.colours[:, :3] / 255, 6)], axis=1)
    text = [to_lines("v", vertices, "\n")]
    texture = np.zeros(scene.triangles.shape, dtype=np.int64)
    if attributes.texture is not None:
        textured = np.isfinite(attributes.texture).all(axis=(1, 2))
        points = attributes.texture[textured].reshape(-1, 2)
        corner, index = np.unique(first_of_equal(np.pad(points, ((0, 0), (0, 1)))), return_inverse=True)
        texture[textured] = 1 + index.reshape(-1, 3)
        text.append(to_lines("vt", points[corner], "\n"))
    normal = np.zeros_like(texture)
    if attributes.normals is not None:
        normal = scene.triangles + 1
        text.append(to_lines("vn", attributes.normals, "\n"))
    lines = face_lines(scene.triangles + 1, texture, normal, "\n")
    group = [f"g {GROUP}\n"] if scene.is_marked else []
    text += [*lines[: scene.n_measured], *group, *lines[scene.n_measured :]]
    return "".join(text).encode()


def encode_as_off(scene: MergedScene) -> bytes:
    """Encode as OFF, or as COFF where there are colours."""
    colours = scene.vertex_attributes.colours
    counts = f"{len(scene.vertices)} {len(scene.triangles)} 0\n"
    faces = to_lines("3", scene.triangles, "\n")
    if colours is None:
        return ("OFF\n" + counts + to_lines("", scene.vertices, "\n") + faces).encode()
    positions = to_lines("", scene.vertices, "\n").splitlines()
    tints = to_lines("", np.rint(colours).astype(np.int64), "\n").splitlines()
    rows = "".join(f"{position} {tint}\n" for position, tint in zip(positions, tints, strict=True))
    return ("COFF\n" + counts + rows + faces).encode()
