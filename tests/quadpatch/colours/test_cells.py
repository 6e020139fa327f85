import numpy as np
import pytest

from quadpatch.colours.cells import WIDEST_CELL, cell_radius, divide, frames_along, gap_radii
from quadpatch.colours.gap_graph import GapGraph
from quadpatch.colours.surface import ColouredSurface
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import sphere

BALL = sphere(4)


def surface_with_gaps(mesh: TriangleMesh, radii: tuple[float, ...]) -> tuple[ColouredSurface, GapGraph]:
    gap = np.full(len(mesh.vertices), -1)
    for number, radius in enumerate(radii):
        axis = np.eye(3)[number]
        gap[np.linalg.norm(mesh.vertices - axis, axis=1) < radius] = number
    colours = np.zeros((len(gap), 3))
    surface = ColouredSurface.of_measured(mesh, colours, gap, len(radii), mean_edge_length(mesh))
    return surface, GapGraph.of_gaps(surface, 0, len(radii))


def test_a_small_gap_is_one_cell_and_a_wide_one_is_divided() -> None:
    surface, graph = surface_with_gaps(BALL, (0.2, 0.7))
    cells = divide(surface, graph, 0.25)
    counts = np.bincount(cells.seeds.quad)
    assert counts[0] == 1
    assert counts[1] > 4


def test_every_vertex_is_in_a_cell_of_its_gap_with_the_nearest_seed_within_the_radius() -> None:
    surface, graph = surface_with_gaps(BALL, (0.3, 0.7, 0.5))
    cells = divide(surface, graph, 0.2)
    points = BALL.vertices[graph.vertices]
    distance = np.linalg.norm(points[:, np.newaxis] - cells.seeds.origins, axis=2)
    distance[graph.gap[:, np.newaxis] != cells.seeds.quad] = np.inf
    assert (cells.of_vertex == distance.argmin(axis=1)).all()
    assert distance.min(axis=1).max() <= 0.2


def test_frames_of_cells_look_along_the_surface_normal() -> None:
    surface, graph = surface_with_gaps(BALL, (0.3, 0.7))
    seeds = divide(surface, graph, 0.2).seeds
    cosines = np.einsum("ij,ij->i", seeds.frames[:, 2], seeds.origins)
    assert (cosines > 0.97).all()


def test_cells_are_as_wide_as_three_of_four_gaps_within_bounds() -> None:
    surface, graph = surface_with_gaps(BALL, (0.2, 0.2, 0.2))
    radii = gap_radii(surface, graph)
    assert cell_radius(surface, graph) == pytest.approx(np.percentile(radii, 75))
    wide, graph = surface_with_gaps(BALL, (1.3,))
    assert cell_radius(wide, graph) == pytest.approx(WIDEST_CELL * wide.edge_length)
    tiny, graph = surface_with_gaps(BALL, (0.01,))
    assert cell_radius(tiny, graph) == pytest.approx(2 * tiny.edge_length)


def test_frames_are_right_handed_and_turn_about_their_normal() -> None:
    rng = np.random.default_rng(0)
    normals = rng.normal(size=(20, 3))
    plain, turned = frames_along(normals), frames_along(normals, np.full(20, 0.3))
    for frames in (plain, turned):
        assert np.allclose(frames @ frames.swapaxes(1, 2), np.eye(3))
        assert np.allclose(np.linalg.det(frames), 1.0)
    assert np.allclose(plain[:, 2], turned[:, 2])
    assert np.allclose(np.einsum("ij,ij->i", plain[:, 0], turned[:, 0]), np.cos(0.3))
