import numpy as np
import pytest

from quadpatch.compression.heights import Grid, make_grid
from quadpatch.compression.patch_dictionary import cosine_atoms, with_constant
from quadpatch.compression.sparse_codes import decoded_heights, sparse_codes
from quadpatch.types import FloatArray, QuadMesh


def plate_of_quads(n: int) -> Grid:
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0))
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros((n + 1) ** 2)], axis=1)
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)
    return make_grid(QuadMesh(vertices, quads), 3)


def waves(grid: Grid) -> FloatArray:
    return np.asarray(0.1 * np.sin(2.0 * grid.points[:, 0]) * np.cos(1.5 * grid.points[:, 1]))


@pytest.mark.parametrize("step", [0.1, 0.02, 0.004])
def test_the_error_of_the_heights_falls_with_the_step(step: float) -> None:
    grid = plate_of_quads(4)
    codes = sparse_codes(grid, waves(grid), np.ones(len(grid.points), bool), cosine_atoms(9), step)
    error = decoded_heights(grid, codes, cosine_atoms(9), step) - waves(grid)
    assert np.sqrt((error**2).mean()) < 0.25 * step


def test_codes_of_a_smooth_surface_are_sparse() -> None:
    grid = plate_of_quads(4)
    codes = sparse_codes(grid, waves(grid), np.ones(len(grid.points), bool), cosine_atoms(9), 0.02)
    assert 0 < np.count_nonzero(codes) < 0.15 * codes.size


def test_unknown_heights_are_never_read() -> None:
    grid = plate_of_quads(3)
    known = grid.points[:, 0] < 2.4
    other = np.where(known, waves(grid), 1e9)
    same = [sparse_codes(grid, h, known, cosine_atoms(9), 0.01) for h in (waves(grid), other)]
    assert (same[0] == same[1]).all()


def test_an_overcomplete_dictionary_codes_its_own_atoms_with_few_coefficients() -> None:
    rng = np.random.default_rng(0)
    atoms = rng.normal(size=(81, 200))
    atoms = with_constant(atoms / np.linalg.norm(atoms, axis=0))
    grid = plate_of_quads(1)
    heights = np.zeros(len(grid.points))
    heights[grid.patches[0].ravel()] = 3.0 * atoms[:, 17] - 2.0 * atoms[:, 90]
    codes = sparse_codes(grid, heights, np.ones(len(heights), bool), atoms, 0.05)
    assert set(np.argsort(-np.abs(codes[0]))[:2].tolist()) == {17, 90}
    assert np.abs(decoded_heights(grid, codes, atoms, 0.05) - heights).max() < 0.05
