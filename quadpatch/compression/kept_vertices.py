"""The mesh's own vertices as places on the decoded surface: patch, column, row and height.

This is the paper's connectivity of vertices and bins, in fractions of a bin. Columns and rows are told by their
difference from those of a neighbour that comes earlier in the file, where both lie on one patch. A vertex that no patch
brings back within the promised error stands on a lattice of its own.

Tested in `tests/quadpatch/compression/test_encode.py`.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.compression.content import KeptVertices, QpzContent
from quadpatch.compression.decoded_surface import PIECE_STEP, DecodedSurface
from quadpatch.compression.lattice import from_lattice, to_lattice
from quadpatch.compression.subdivision import grid_normals
from quadpatch.compression.surface_fit import barycentric
from quadpatch.mesh.distance import project
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Rounding of column and row may take this part of the promised error, for most cells.
_ALONG_SURFACE = 0.6
_MOST_CELLS = 95.0
MAX_PARTS = 4096
# Step of the heights, in parts of the promised error.
HEIGHT_STEP = 1.2
_ROUNDING = 1e-9


def parts_of_cell(decoded: DecodedSurface, max_error: float) -> int:
    """Choose the steps of column and row within a cell."""
    corners = decoded.vertices[decoded.grid.triangles]
    edge = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    wanted = np.percentile(edge, _MOST_CELLS) / (2.0 * _ALONG_SURFACE * max_error)
    return int(np.clip(np.ceil(wanted), 1, MAX_PARTS))


def keep_vertices(
    vertices: Vertices, triangles: Triangles, content: QpzContent, decoded: DecodedSurface, parts: int
) -> KeptVertices:
    """Find every vertex on the decoded surface.

    Parameters
    ----------
    vertices : (n, 3) float64
        In the order in which they shall come back, finite.
    triangles : (m, 3) int64
    content : QpzContent
        Without omissions, moves and pieces.
    decoded : DecodedSurface
        Of that content.
    parts : int
        See `parts_of_cell`.
    """
    m = 2**content.levels
    mesh = TriangleMesh(decoded.vertices, decoded.grid.triangles)
    _, triangle, places = project(vertices, mesh)
    weights = barycentric(places, mesh.vertices[mesh.triangles[triangle]])
    cell = triangle // 2
    # Corners 0, 1, 2 of a cell's first triangle, and 0, 2, 3 of its second, as (column, row) of the cell.
    local = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], np.float64)
    inside = np.einsum("ij,ijk->ik", weights, local[triangle % 2])
    patch = cell // (m * m)
    corner = np.stack([cell % m, cell // m % m], axis=1)
    place = np.zeros((len(vertices), 3), np.int64)
    place[:, :2] = np.clip(np.rint((corner + inside) * parts), 0, m * parts).astype(np.int64)
    surface = PatchSurface.of(decoded, m, parts)
    step = HEIGHT_STEP * content.lengths.max_error
    point, normal = surface.at(patch, place)
    place[:, 2] = np.rint(np.einsum("ij,ij->i", vertices - point, normal) / step).astype(np.int64)
    found = point + (step * place[:, 2])[:, np.newaxis] * normal
    is_far = np.linalg.norm(found - vertices, axis=1) > content.lengths.max_error * (1.0 - _ROUNDING)
    patch[is_far] = len(decoded.grid.patches)
    origin = np.array(content.lengths.origin)
    place[is_far] = to_lattice(vertices[is_far], origin, PIECE_STEP * content.lengths.max_error)
    return KeptVertices(triangles, patch, place)


def kept_positions(content: QpzContent, kept: KeptVertices, decoded: DecodedSurface, parts: int) -> Vertices:
    """Bring the vertices (n, 3) back, in the order of the mesh."""
    max_error = content.lengths.max_error
    on_patch = kept.patch < len(decoded.grid.patches)
    surface = PatchSurface.of(decoded, 2**content.levels, parts)
    result = from_lattice(kept.place, np.array(content.lengths.origin), PIECE_STEP * max_error)
    point, normal = surface.at(kept.patch[on_patch], kept.place[on_patch])
    height = HEIGHT_STEP * max_error * kept.place[on_patch, 2]
    result[on_patch] = point + height[:, np.newaxis] * normal
    return result


@dataclass(frozen=True)
class PatchSurface:
    """The decoded surface, read at columns and rows of its patches."""

    vertices: Vertices
    normals: FloatArray
    patches: IntArray
    parts: int

    @classmethod
    def of(cls, decoded: DecodedSurface, m: int, parts: int) -> "PatchSurface":
        """Take the surface of grids of m cells along each side, a cell having so many parts."""
        patches = decoded.grid.patches
        cells = np.stack([patches[:, :m, :m], patches[:, :m, 1:], patches[:, 1:, 1:], patches[:, 1:, :m]], axis=-1)
        return cls(decoded.vertices, grid_normals(decoded.vertices, cells.reshape(-1, 4)), patches, parts)

    def at(self, patch: IntArray, place: IntArray) -> tuple[Vertices, FloatArray]:
        """Points (n, 3) at columns and rows `place[:, :2]`, and normals (n, 3), interpolated and not of unit length."""
        m = self.patches.shape[1] - 1
        cell = np.minimum(place[:, :2] // self.parts, m - 1)
        u, v = ((place[:, :2] - cell * self.parts) / self.parts).T
        column, row = cell.T
        in_first = u >= v
        third = np.where(in_first, self.patches[patch, row, column + 1], self.patches[patch, row + 1, column])
        corners = np.stack([self.patches[patch, row, column], self.patches[patch, row + 1, column + 1], third], axis=1)
        weights = np.stack([1.0 - np.maximum(u, v), np.minimum(u, v), np.abs(u - v)], axis=1)
        point = np.einsum("ij,ijk->ik", weights, self.vertices[corners])
        return point, np.einsum("ij,ijk->ik", weights, self.normals[corners])
