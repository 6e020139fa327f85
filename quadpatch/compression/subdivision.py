"""Catmull-Clark subdivision of a quad mesh, as sparse matrices.

Every quad becomes a grid of m x m cells, m = 2^levels, whose vertices are fixed weighted means of the quad mesh's
vertices. Neighbouring grids share the vertices along their edge, so the fine surface is welded as the quad mesh is. An
edge of one quad is a border, and so is an edge of three and more: its points depend on the vertices of such edges alone
(cubic B-splines), and a vertex where another number of them than two meet keeps its place.

References
----------
E. Catmull, J. Clark, "Recursively generated B-spline surfaces on arbitrary topological meshes", Computer-Aided Design
10, 1978; borders: H. Biermann, A. Levin, D. Zorin, "Piecewise smooth subdivision surfaces with normal control",
SIGGRAPH 2000.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from quadpatch.types import BoolArray, FloatArray, IntArray, Quads, Triangles, Vertices

# A vertex between edges of one quad has this weight, and its two neighbours along the border share the rest.
_BORDER_WEIGHT = 0.75

Matrix = sp.csr_array


@dataclass(frozen=True)
class Subdivision:
    """What one quad mesh becomes.

    Attributes
    ----------
    matrix : (n_fine, n_coarse) sparse float64
        Fine vertices as weighted means of coarse ones; rows sum to 1.
    grid : (n_quads, m + 1, m + 1) int64
        Fine vertex at row i, column j of each quad; [0, 0], [0, m], [m, m] and [m, 0] are its corners in order.
    """

    matrix: Matrix
    grid: IntArray

    @property
    def cells(self) -> Quads:
        """Cells (n_quads * m * m, 4), turned as the quads are, quad by quad and row by row."""
        return cells_of(self.grid).reshape(-1, 4)

    @property
    def triangles(self) -> Triangles:
        """Two triangles for each cell, one after the other: (2 * n_cells, 3)."""
        return split_cells(self.cells)


def split_cells(cells: Quads) -> Triangles:
    """Cut cells (n, 4) into two triangles each, (2 n, 3), one after the other."""
    return np.stack([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]], axis=1).reshape(-1, 3)


def cells_of(grid: IntArray) -> IntArray:
    """Corners (n_quads, m, m, 4) of the cells of grids (n_quads, m + 1, m + 1)."""
    return np.stack([grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]], axis=-1)


def subdivide(quads: Quads, n_vertices: int, levels: int) -> Subdivision:
    """Subdivide a quad mesh several times.

    Parameters
    ----------
    quads : (n_quads, 4) int64
        Four different corners each; open and non-manifold quad meshes are fine.
    n_vertices : int
    levels : int
        0 keeps the quads.
    """
    matrix: Matrix = sp.csr_array(sp.eye_array(n_vertices))
    grid = quads[:, [0, 1, 3, 2]].reshape(-1, 2, 2)
    for _ in range(levels):
        step, grid = _step(grid, matrix.shape[0])
        matrix = sp.csr_array(step @ matrix)
    return Subdivision(matrix, grid)


def grid_normals(vertices: Vertices, cells: Quads) -> FloatArray:
    """Sum the vector areas of the cells at each grid vertex: unit normals (n, 3), z where there is none."""
    area = np.cross(vertices[cells[:, 2]] - vertices[cells[:, 0]], vertices[cells[:, 3]] - vertices[cells[:, 1]])
    total = np.stack(
        [np.bincount(cells.ravel(), np.repeat(area[:, axis], 4), len(vertices)) for axis in range(3)], axis=1
    )
    length = np.linalg.norm(total, axis=1, keepdims=True)
    unit = np.divide(total, length, out=np.zeros_like(total), where=length > 0)
    return np.where(length > 0, unit, np.array([0.0, 0.0, 1.0]))


def quad_edges(quads: Quads, n_vertices: int) -> tuple[IntArray, IntArray, IntArray]:
    """Find the edges of quads.

    Returns
    -------
    edges : (n_edges, 2) int64
        Lower vertex first, each once, in order.
    of_quad : (n_quads, 4) int64
        Edge from each corner to the next.
    count : (n_edges,) int64
        Quads at each edge.
    """
    ends = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    keys, of_quad, count = np.unique(ends[:, 0] * n_vertices + ends[:, 1], return_inverse=True, return_counts=True)
    return np.stack([keys // n_vertices, keys % n_vertices], axis=1), of_quad.reshape(-1, 4), count


def _step(grid: IntArray, n: int) -> tuple[Matrix, IntArray]:
    """Matrix (n + n_edges + n_quads, n) of one subdivision, and the grids that it refines."""
    n_patches, m = len(grid), grid.shape[1] - 1
    cells = cells_of(grid).reshape(-1, 4)
    edges, of_cell, count = quad_edges(cells, n)
    refined = _refined_grid(grid, n + of_cell.reshape(n_patches, m, m, 4), n + len(edges))
    face_points = _rows(np.repeat(np.arange(len(cells)), 4), cells.ravel(), (len(cells), n))
    midpoints = _rows(np.repeat(np.arange(len(edges)), 2), edges.ravel(), (len(edges), n))
    faces_of_edge = _rows(of_cell.ravel(), np.repeat(np.arange(len(cells)), 4), (len(edges), len(cells)))
    is_inner = count == 2
    half = np.where(is_inner, 0.5, 1.0)
    edge_points = _scaled(midpoints, half) + _scaled(faces_of_edge @ face_points, 1.0 - half)
    vertex_points = _vertex_points(n, cells, edges, is_inner, (face_points, midpoints))
    return sp.csr_array(sp.vstack([vertex_points, edge_points, face_points])), refined


def _refined_grid(grid: IntArray, edge: IntArray, first_face: int) -> IntArray:
    """Put vertices, edge points and face points in their places; `edge` (n, m, m, 4) follows the corners of cells."""
    n_patches, m = len(grid), grid.shape[1] - 1
    refined = np.zeros((n_patches, 2 * m + 1, 2 * m + 1), np.int64)
    refined[:, ::2, ::2] = grid
    refined[:, 0:-1:2, 1::2], refined[:, 2::2, 1::2] = edge[..., 0], edge[..., 2]
    refined[:, 1::2, 2::2], refined[:, 1::2, 0:-1:2] = edge[..., 1], edge[..., 3]
    refined[:, 1::2, 1::2] = first_face + np.arange(n_patches * m * m).reshape(n_patches, m, m)
    return refined


def _vertex_points(n: int, cells: Quads, edges: IntArray, is_inner: BoolArray, points: tuple[Matrix, Matrix]) -> Matrix:
    """Rows of the old vertices: inside (F + 2 E + (k - 3) V) / k with means F, E of face points and midpoints."""
    face_points, midpoints = points
    faces = _rows(cells.ravel(), np.repeat(np.arange(len(cells)), 4), (n, len(cells)))
    spokes = _rows(edges.ravel(), np.repeat(np.arange(len(edges)), 2), (n, len(edges)))
    valence = np.maximum(np.bincount(edges.ravel(), minlength=n), 1).astype(np.float64)
    border = edges[~is_inner]
    n_border = np.bincount(border.ravel(), minlength=n)
    inside, on_curve = n_border == 0, n_border == 2
    along = _rows(np.concatenate([border[:, 0], border[:, 1]]), np.concatenate([border[:, 1], border[:, 0]]), (n, n))
    keeps = np.where(inside, (valence - 3.0) / valence, np.where(on_curve, _BORDER_WEIGHT, 1.0))
    summed = _scaled(faces @ face_points, inside / valence) + _scaled(spokes @ midpoints, 2.0 * inside / valence)
    return sp.csr_array(summed + _scaled(along, (1.0 - _BORDER_WEIGHT) * on_curve) + sp.diags_array(keeps))


def _rows(row: IntArray, column: IntArray, shape: tuple[int, int]) -> Matrix:
    """Means over the columns named for each row."""
    weight = 1.0 / np.maximum(np.bincount(row, minlength=shape[0]), 1)
    return sp.csr_array((weight[row], (row, column)), shape=shape)


def _scaled(matrix: Matrix, factors: FloatArray) -> Matrix:
    """Scale every row."""
    return sp.csr_array(sp.diags_array(np.asarray(factors, np.float64)) @ matrix)
