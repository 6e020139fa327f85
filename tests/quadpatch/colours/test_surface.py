import numpy as np

from quadpatch.colours.surface import ColouredSurface
from tests.quadpatch.shapes import open_grid

MESH = open_grid(9)
GAP = np.where(np.linalg.norm(MESH.vertices[:, :2], axis=1) < 1.5, 0, -1)
COLOURS = np.random.default_rng(0).uniform(0, 255, (len(GAP), 3))
SURFACE = ColouredSurface.of_measured(MESH, COLOURS, GAP, 1, 1.0)


def test_measured_colours_stay_as_they_are() -> None:
    assert (SURFACE.colours[GAP < 0] == COLOURS[GAP < 0]).all()


def test_colours_in_a_gap_are_the_mean_of_their_neighbours() -> None:
    edges = np.unique(MESH.triangles[:, [0, 1, 1, 2, 2, 0, 1, 0, 2, 1, 0, 2]].reshape(-1, 2), axis=0)
    for vertex in np.flatnonzero(GAP == 0):
        neighbours = edges[edges[:, 0] == vertex, 1]
        assert np.allclose(SURFACE.colours[vertex], SURFACE.colours[neighbours].mean(axis=0))


def test_what_stands_in_a_gap_is_not_read() -> None:
    other = COLOURS.copy()
    other[GAP == 0] = 1e6
    again = ColouredSurface.of_measured(MESH, other, GAP, 1, 1.0)
    assert again.colours.tobytes() == SURFACE.colours.tobytes()


def test_measured_triangles_have_no_corner_in_a_gap() -> None:
    measured = SURFACE.mesh.triangles[SURFACE.is_measured]
    assert (GAP[measured] < 0).all()
    assert len(measured) == (GAP[MESH.triangles] < 0).all(axis=1).sum()
    assert (SURFACE.measured_vertices == np.unique(measured)).all()


def test_roughness_is_the_mean_squared_difference_along_measured_edges() -> None:
    ramp = ColouredSurface.of_measured(MESH, MESH.vertices[:, :1] * 3.0, np.full(len(GAP), -1), 0, 1.0)
    # Of the four straight and two diagonal edges inside, those along x differ by 3, as do the diagonals.
    inside = np.abs(MESH.vertices[:, :2]).max(axis=1) < 3.5
    assert np.allclose(ramp.roughness[inside], 9 * 4 / 6)


def test_a_vertex_without_measured_edges_has_no_roughness() -> None:
    assert np.isnan(SURFACE.roughness[np.linalg.norm(MESH.vertices, axis=1) < 0.5]).all()
