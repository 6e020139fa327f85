"""New primitives of a glTF document: arrays appended to a buffer, and the entries that describe them.

Tested in `tests/quadpatch/formats/gltf/test_reader.py`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.formats.attributes import normals_at
from quadpatch.formats.gltf.container import GltfFile
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.scene_parts import PartFill
from quadpatch.mesh.weld import first_of_equal
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

_COMPONENTS = {"f4": 5126, "u4": 5125, "u2": 5123, "i1": 5120}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963


@dataclass(frozen=True)
class Corners:
    """What new primitives draw on.

    Attributes
    ----------
    fill : Fill
    n_measured : int
        Vertices of the scan.
    colours : (n_measured + n_new, 4) float64 or None
        0..1, NaN where a measured vertex has none.
    texture : (l, 3, 2) float64 or None
        Of the fill's corners, NaN where there is none.
    normals : (n_measured, 3) float64 or None
        Of the measured vertices, in their part's coordinates, NaN where there is none.
    """

    fill: Fill
    n_measured: int
    colours: FloatArray | None
    texture: FloatArray | None
    normals: FloatArray | None


class Store:
    """A document that is being added to: lists are copied, and one buffer grows."""

    def __init__(self, file: GltfFile) -> None:
        self.document: dict[str, Any] = dict(file.document)
        self._file = file
        self._buffers = list(file.buffers)
        listed = self.document.get("buffers", [])
        # The binary chunk can grow; a buffer with an address of its own is left alone.
        if file.is_binary and listed and "uri" not in listed[0]:
            self._number = 0
        else:
            self._number = self.add("buffers", {"byteLength": 0})
            self._buffers.append(b"")
        self._pieces = [self._buffers[self._number]]
        self._size = len(self._pieces[0])

    @staticmethod
    def of(file: GltfFile) -> "Store":
        """Begin with a file as it is."""
        return Store(file)

    def add(self, name: str, entry: dict[str, Any]) -> int:
        """Append an entry to one of the document's lists; returns its number."""
        self.document[name] = [*self.document.get(name, []), entry]
        return len(self.document[name]) - 1

    def add_array(self, values: NDArray[Any], code: str, is_index: bool = False) -> int:
        """Append an array (n,) or (n, k) as `f4`, `u4` or `u2`; returns the number of its accessor.

        The document states the range of each array, and JSON knows no NaN and no infinity: NaN becomes 0, and what
        float32 can't hold becomes its largest number.
        """
        table = _finite(values.reshape(len(values), -1)).astype("<" + code)
        target = _ELEMENT_ARRAY_BUFFER if is_index else _ARRAY_BUFFER
        return self._add_accessor(table, code, self.add_bytes(table.tobytes(), {"target": target}), {})

    def add_fractions(self, values: FloatArray, code: str) -> int:
        """Append an array (n, 3) or (n, 4) from -1 to 1, or from 0 to 1, as normalised `i1` or `u2`.

        Rows are padded to a multiple of four bytes, as vertex attributes have to be.
        """
        table = np.rint(np.clip(values, -1.0, 1.0) * np.iinfo(code).max).astype("<" + code)
        row = table.shape[1] * table.itemsize
        padded = np.zeros((len(table), (row + 3) // 4 * 4), np.uint8)
        padded[:, :row] = table.view(np.uint8).reshape(len(table), row)
        view = self.add_bytes(padded.tobytes(), {"target": _ARRAY_BUFFER, "byteStride": padded.shape[1]})
        return self._add_accessor(table, code, view, {"normalized": True})

    def _add_accessor(self, table: NDArray[Any], code: str, view: int, rest: Mapping[str, Any]) -> int:
        return self.add(
            "accessors",
            {
                "bufferView": view,
                "componentType": _COMPONENTS[code],
                "count": len(table),
                "type": _TYPES[table.shape[1]],
                "min": table.min(axis=0).tolist(),
                "max": table.max(axis=0).tolist(),
                **rest,
            },
        )

    def add_bytes(self, data: bytes, rest: Mapping[str, Any] | None = None) -> int:
        """Append bytes to the buffer; returns the number of their view, which has the rest of its entry from `rest`."""
        padding = bytes(-self._size % 4)
        start = self._size + len(padding)
        self._pieces += [padding, data]
        self._size = start + len(data)
        entry = {"buffer": self._number, "byteOffset": start, "byteLength": len(data), **(rest or {})}
        return self.add("bufferViews", entry)

    def finished(self) -> GltfFile:
        """Return the file with all that was added."""
        self._buffers[self._number] = b"".join(self._pieces)
        return GltfFile(self.document, self._buffers, self._file.chunks, self._file.is_binary)


def build_primitive(store: Store, piece: PartFill, rows: BoolArray, corners: Corners) -> dict[str, Any]:
    """Store one primitive of a fill.

    Parameters
    ----------
    store : Store
    piece : PartFill
    rows : (l,) bool
        Which of the piece's triangles.
    corners : Corners
    """
    triangles, fill_rows = piece.triangles[rows], piece.rows[rows]
    texture = None if corners.texture is None else corners.texture[fill_rows]
    if texture is not None and not np.isfinite(texture).all():
        texture = None
    if texture is not None and _is_turned(piece, rows, corners.fill):
        texture = texture[:, [0, 2, 1]]
    local, wedge, indices = split_vertices(triangles, texture)
    vertex = piece.vertex[local]
    attributes = {"POSITION": store.add_array(piece.positions[local], "f4")}
    if corners.normals is not None:
        normals = _normals(vertex, piece.positions, triangles, local, corners)
        attributes["NORMAL"] = store.add_array(normals, "f4")
    if corners.colours is not None:
        attributes["COLOR_0"] = store.add_array(np.nan_to_num(corners.colours[vertex], nan=1.0), "f4")
    if texture is not None:
        attributes["TEXCOORD_0"] = store.add_array(wedge, "f4")
    hole, confidence = _marks(vertex, triangles, local, corners, fill_rows)
    attributes["_HOLE_ID"] = store.add_array(hole, "f4")
    attributes["_CONFIDENCE"] = store.add_array(confidence, "f4")
    return {"attributes": attributes, "indices": store.add_array(indices.ravel(), "u4", is_index=True), "mode": 4}


def _is_turned(piece: PartFill, rows: BoolArray, fill: Fill) -> bool:
    return bool((piece.vertex[piece.triangles[rows]] != fill.triangles[piece.rows[rows]]).any())


def split_vertices(triangles: Triangles, texture: FloatArray | None) -> tuple[IntArray, FloatArray, Triangles]:
    """Vertices that are one in position and texture: position of each, its texture, triangles into them."""
    if texture is None:
        vertex, indices = np.unique(triangles, return_inverse=True)
        return vertex, np.zeros((len(vertex), 2)), indices.reshape(-1, 3)
    wedges = texture.reshape(-1, 2)
    first = first_of_equal(np.column_stack([triangles.ravel(), wedges]))
    corner, indices = np.unique(first, return_inverse=True)
    return triangles.ravel()[corner], wedges[corner], indices.reshape(-1, 3)


def _normals(
    vertex: IntArray, positions: Vertices, triangles: Triangles, local: IntArray, corners: Corners
) -> FloatArray:
    """Measured normals on the rim, those of the new surface elsewhere."""
    empty = np.zeros(0)
    whole = Fill(np.zeros((0, 3)), triangles, empty.astype(np.int64), empty, empty.astype(np.int64), empty)
    normals = normals_at(Scan(positions, triangles, ""), whole, local)
    measured = vertex < corners.n_measured
    if corners.normals is not None:
        known = corners.normals[np.where(measured, vertex, 0)]
        has = measured & np.isfinite(known).all(axis=1) & (known != 0).any(axis=1)
        normals[has] = known[has]
    # glTF wants unit vectors even where a triangle has no area.
    normals[(normals == 0).all(axis=1)] = (0.0, 0.0, 1.0)
    return normals


def _marks(
    vertex: IntArray, triangles: Triangles, local: IntArray, corners: Corners, fill_rows: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Hole and confidence of each vertex; rim vertices, repeated here, have those of a triangle around them."""
    hole = np.zeros(int(triangles.max()) + 1)
    confidence = np.zeros_like(hole)
    hole[triangles] = corners.fill.triangle_hole_id[fill_rows][:, np.newaxis]
    confidence[triangles] = corners.fill.triangle_confidence[fill_rows][:, np.newaxis]
    new = vertex >= corners.n_measured
    result_confidence = confidence[local]
    result_confidence[new] = corners.fill.vertex_confidence[vertex[new] - corners.n_measured]
    return hole[local], result_confidence


def _finite(values: NDArray[Any]) -> NDArray[Any]:
    if values.dtype.kind != "f":
        return values
    largest = float(np.finfo(np.float32).max)
    return np.asarray(np.clip(np.nan_to_num(values), -largest, largest))
