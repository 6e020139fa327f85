import numpy as np
import pytest

from quadpatch.colours.gap_graph import GapGraph
from quadpatch.colours.surface import ColouredSurface
from quadpatch.types import FloatArray
from tests.quadpatch.shapes import bumpy_plate

MESH = bumpy_plate(25, 24.0)
PLACES = np.array([[-5.0, 0.0], [6.0, 2.0]])
DISTANCE = np.linalg.norm(MESH.vertices[:, np.newaxis, :2] - PLACES, axis=2)
GAP = np.where(DISTANCE.min(axis=1) < 4.2, DISTANCE.argmin(axis=1), -1)
RNG = np.random.default_rng(0)
SURFACE = ColouredSurface.of_measured(MESH, RNG.uniform(0, 255, (len(GAP), 3)), GAP, 2, 1.0)
GRAPH = GapGraph.of_gaps(SURFACE, 0, 2)
EXEMPLAR = RNG.uniform(0, 255, (len(GAP), 3))


def divergence(values: FloatArray) -> FloatArray:
    differences = values[GRAPH.vertices[GRAPH.start]] - values[GRAPH.end]
    return np.stack([np.bincount(GRAPH.start, column, minlength=len(GRAPH.vertices)) for column in differences.T], 1)


def test_all_edges_at_the_vertices_of_gaps_are_there_once_in_each_direction() -> None:
    edges = np.unique(MESH.triangles[:, [0, 1, 1, 2, 2, 0, 1, 0, 2, 1, 0, 2]].reshape(-1, 2), axis=0)
    expected = edges[GAP[edges[:, 0]] >= 0]
    found = np.stack([GRAPH.vertices[GRAPH.start], GRAPH.end], axis=1)
    assert sorted(map(tuple, found.tolist())) == sorted(map(tuple, expected.tolist()))
    inner = GRAPH.inner_end >= 0
    assert (GRAPH.vertices[GRAPH.inner_end[inner]] == GRAPH.end[inner]).all()
    assert (GAP[GRAPH.end[~inner]] < 0).all()


def test_one_gap_can_be_taken_alone() -> None:
    alone = GapGraph.of_gaps(SURFACE, 1, 2)
    assert (alone.vertices == np.flatnonzero(GAP == 1)).all()


def test_detail_without_screening_is_the_exemplar_less_the_harmonic_extension_of_its_rim() -> None:
    harmonic = ColouredSurface.of_measured(MESH, EXEMPLAR, GAP, 2, 1.0).colours
    detail = GRAPH.solver(0.0)(divergence(EXEMPLAR))
    assert np.allclose(detail, (EXEMPLAR - harmonic)[GRAPH.vertices])


def test_screening_leaves_out_what_is_coarse_and_keeps_what_is_fine() -> None:
    coarse = np.cos(MESH.vertices[:, :1] * np.pi / 12)
    fine = np.where(np.arange(len(GAP)) % 2, 1.0, -1.0)[:, np.newaxis]
    left = {}
    for name, values in (("coarse", coarse), ("fine", fine)):
        whole, screened = (GRAPH.solver(screening)(divergence(values)) for screening in (0.0, 0.3))
        left[name] = float((screened**2).sum() / (whole**2).sum())
    assert left["coarse"] < 0.2
    assert left["fine"] > 0.5


def test_detail_vanishes_over_edges_that_are_not_joined() -> None:
    side = MESH.vertices[GRAPH.vertices, 0] > PLACES[GRAPH.gap, 0]
    joined = side[GRAPH.start] == side[GRAPH.inner_end]
    right = divergence(EXEMPLAR)
    detail = GRAPH.solver(0.0, joined)(np.where(side[:, np.newaxis], right, 0.0))
    assert np.allclose(detail[~side], 0.0)
    assert np.abs(detail[side]).max() > 1.0


def test_energies_of_harmonic_colours_and_detail_add_up() -> None:
    harmonic = SURFACE.colours[GRAPH.vertices]
    detail = GRAPH.solver(0.7)(divergence(EXEMPLAR))
    apart = GRAPH.energy(harmonic, SURFACE.colours).sum() + GRAPH.energy(detail).sum()
    assert GRAPH.energy(harmonic + detail, SURFACE.colours).sum() == pytest.approx(apart)


def test_energy_is_the_sum_of_squares_along_all_edges() -> None:
    colours = SURFACE.colours
    edges = np.unique(np.sort(np.stack([GRAPH.vertices[GRAPH.start], GRAPH.end], axis=1), axis=1), axis=0)
    expected = ((colours[edges[:, 0]] - colours[edges[:, 1]]) ** 2).sum()
    assert GRAPH.energy(colours[GRAPH.vertices], colours).sum() == pytest.approx(expected)
