import numpy as np

from quadpatch.denoising.folds import n_turned, without_new_folds
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid


def test_moves_that_fold_nothing_stay_as_they_are() -> None:
    mesh = open_grid(6)
    moves = 0.01 * np.random.default_rng(0).normal(size=mesh.vertices.shape)
    unfolded = without_new_folds(mesh, moves)
    assert unfolded.moves.tolist() == moves.tolist()
    assert (unfolded.n_undone, unfolded.n_before, len(unfolded.left)) == (0, 0, 0)


def test_a_fold_that_a_move_brings_in_is_undone() -> None:
    mesh = open_grid(6)
    moves = np.zeros_like(mesh.vertices)
    moves[14] = [1.5 * np.ptp(mesh.vertices[:, 0]), 0, 0]
    assert n_turned(mesh, mesh.vertices + moves) > 0
    unfolded = without_new_folds(mesh, moves)
    assert unfolded.n_undone > 0
    assert len(unfolded.left) == 0
    assert n_turned(mesh, mesh.vertices + unfolded.moves) == 0


def test_a_fold_that_was_there_is_counted_and_left() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, 1, 0.01]])
    mesh = TriangleMesh(vertices, np.array([[0, 1, 2], [1, 0, 3]]))
    unfolded = without_new_folds(mesh, np.full((4, 3), 0.1))
    assert unfolded.n_before == 1
    assert unfolded.moves.tolist() == np.full((4, 3), 0.1).tolist()
