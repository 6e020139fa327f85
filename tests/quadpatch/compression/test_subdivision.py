import numpy as np
import pytest

from quadpatch.compression.subdivision import grid_normals, quad_edges, split_cells, subdivide
from quadpatch.types import FloatArray, IntArray


def cube() -> tuple[FloatArray, IntArray]:
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float64)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return corners, quads


def strip() -> tuple[FloatArray, IntArray]:
    x, y = np.meshgrid(np.arange(4.0), np.arange(3.0))
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(12)], axis=1)
    quads = np.array([[i, i + 1, i + 5, i + 4] for i in (0, 1, 2, 4, 5, 6)])
    return vertices, quads


@pytest.mark.parametrize("levels", [0, 1, 2, 3])
def test_each_fine_vertex_is_a_mean_of_coarse_ones(levels: int) -> None:
    vertices, quads = cube()
    matrix = subdivide(quads, len(vertices), levels).matrix
    assert np.allclose(matrix.sum(axis=1), 1.0)
    assert matrix.min() >= 0.0


def test_a_corner_of_a_cube_moves_as_catmull_and_clark_say() -> None:
    vertices, quads = cube()
    fine = subdivide(quads, len(vertices), 1)
    # Valence 3: (F + 2 E) / 3 with F and E the means of three face centres and three edge midpoints.
    assert np.allclose((fine.matrix @ vertices)[0], (np.full(3, 1 / 3) + 2 * np.full(3, 1 / 6)) / 3)


def test_neighbouring_grids_share_the_vertices_along_their_edge() -> None:
    vertices, quads = cube()
    fine = subdivide(quads, len(vertices), 2)
    n_edges = len(quad_edges(quads, len(vertices))[0])
    assert len(np.unique(fine.grid)) == 8 + 3 * n_edges + 9 * len(quads)
    assert (quad_edges(fine.cells, fine.matrix.shape[0])[2] == 2).all()


def test_corners_of_a_grid_are_those_of_its_quad_in_order() -> None:
    vertices, quads = strip()
    grid = subdivide(quads, len(vertices), 3).grid
    assert (np.stack([grid[:, 0, 0], grid[:, 0, -1], grid[:, -1, -1], grid[:, -1, 0]], axis=1) == quads).all()


def test_the_border_of_a_flat_rectangle_follows_from_its_border_alone() -> None:
    vertices, quads = strip()
    fine = subdivide(quads, len(vertices), 3)
    inner = [5, 6]
    edges, _, count = quad_edges(fine.cells, fine.matrix.shape[0])
    border = np.unique(edges[count == 1])
    assert fine.matrix[border][:, inner].nnz == 0
    assert ((fine.matrix @ vertices)[:, 2] == 0.0).all()


def test_an_edge_of_three_quads_is_a_border_of_each() -> None:
    vertices = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [-1, 1, 0], [0, 0, 1], [0, 1, 1.0]])
    quads = np.array([[0, 2, 3, 1], [0, 1, 5, 4], [0, 1, 7, 6]])
    fine = subdivide(quads, len(vertices), 2)
    shared = fine.matrix @ vertices
    on_edge = np.flatnonzero(np.abs(shared[:, [0, 2]]).max(axis=1) < 1e-12)
    assert len(on_edge) == 5


def test_normals_of_a_cube_point_outwards() -> None:
    vertices, quads = cube()
    fine = subdivide(quads, len(vertices), 2)
    points = fine.matrix @ vertices
    normals = grid_normals(points, fine.cells)
    assert (np.einsum("ij,ij->i", normals, points - 0.5) > 0).all()
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)


def test_a_cell_becomes_two_triangles_that_are_turned_alike() -> None:
    assert split_cells(np.array([[3, 5, 7, 9]])).tolist() == [[3, 5, 7], [3, 7, 9]]
