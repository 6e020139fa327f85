import numpy as np
import pytest

from quadpatch.colours.cells import frames_along
from quadpatch.colours.exemplars import Lender, Matches, find_matches
from quadpatch.colours.patches import ColouredPatches, PatchSampler
from quadpatch.colours.surface import ColouredSurface
from quadpatch.patches.layout import take
from quadpatch.patches.seeds import Seeds
from quadpatch.types import IntArray
from tests.quadpatch.shapes import open_grid

MESH = open_grid(81)
RNG = np.random.default_rng(0)
COLOURS = RNG.uniform(0, 255, (len(MESH.vertices), 3))
SURFACE = ColouredSurface.of_measured(MESH, COLOURS, np.full(len(COLOURS), -1), 0, 1.0)
SAMPLER = PatchSampler(SURFACE, 16.0)
INSIDE = np.flatnonzero(np.abs(MESH.vertices).max(axis=1) < 20)
VERTICES = INSIDE[:: len(INSIDE) // 12][:12]
NORMALS = np.tile((0.0, 0.0, 1.0), (12, 1))
SEEDS = Seeds(MESH.vertices[VERTICES], frames_along(NORMALS, RNG.uniform(0, 6, 12)), VERTICES)
SOURCES = SAMPLER.cut(SEEDS, 2)


def near(vertex: int) -> IntArray:
    return np.flatnonzero(np.linalg.norm(MESH.vertices - MESH.vertices[vertex], axis=1) < 6)


def lent(cells: ColouredPatches, matches: Matches, vertices: IntArray) -> IntArray:
    """Lenders of some vertices around each cell's seed, in the best match: (n_cells, k)."""
    lender = Lender(SURFACE, cells, SOURCES)
    cell = np.repeat(np.arange(len(cells)), vertices.shape[1])
    source, window = matches.source[:, 0], matches.window[:, 0]
    return lender.lend(source, window, cell, vertices.ravel()).reshape(vertices.shape)


def test_a_patch_is_its_own_best_match_and_lends_its_vertices_to_themselves() -> None:
    cells = SAMPLER.cut(SEEDS)
    matches = find_matches(cells, SOURCES, 3)
    assert matches.count == 3
    assert (matches.source[:, 0] == np.arange(12)).all()
    vertices = np.stack([near(vertex) for vertex in VERTICES])
    assert (lent(cells, matches, vertices) == vertices).all()


@pytest.mark.parametrize("quarter", range(4))
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_a_patch_that_is_turned_or_mirrored_is_found_and_lends_the_same_vertices(
    quarter: int, is_mirrored: bool
) -> None:
    turn = np.linalg.matrix_power(np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]), quarter)
    mirror = np.diag([-1.0 if is_mirrored else 1.0, 1, 1])
    frames = np.einsum("ij,njk->nik", mirror @ turn, SEEDS.frames)
    cells = SAMPLER.cut(Seeds(SEEDS.origins, frames, SEEDS.quad))
    matches = find_matches(cells, SOURCES, 1)
    assert (matches.source[:, 0] == np.arange(12)).all()
    vertices = np.stack([near(vertex) for vertex in VERTICES])
    assert (lent(cells, matches, vertices) == vertices).all()


def test_a_patch_that_is_shifted_by_two_bins_is_found_and_lends_the_same_vertices() -> None:
    shift = 2 * 16.0 / 24 * (SEEDS.frames[:, 0] - SEEDS.frames[:, 1])
    cells = SAMPLER.cut(Seeds(SEEDS.origins + shift, SEEDS.frames, SEEDS.quad))
    matches = find_matches(cells, SOURCES, 1)
    assert (matches.source[:, 0] == np.arange(12)).all()
    vertices = np.stack([near(vertex) for vertex in VERTICES])
    assert (lent(cells, matches, vertices) == vertices).all()


def test_colours_in_a_gap_hardly_count() -> None:
    """A patch whose middle was replaced by harmonic colours still finds itself."""
    gap = np.full(len(COLOURS), -1)
    gap[near(int(VERTICES[5]))] = 0
    hidden = ColouredSurface.of_measured(MESH, COLOURS, gap, 1, 1.0)
    cells = PatchSampler(hidden, 16.0).cut(take(SEEDS, np.array([5])))
    assert find_matches(cells, SOURCES, 1).source[0, 0] == 5
