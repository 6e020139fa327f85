import numpy as np
import pytest

from quadpatch.filling.weight_table import best_triangulations
from quadpatch.types import BoolArray, FloatArray, IntArray


def rings(n_loops: int, n: int) -> tuple[FloatArray, FloatArray]:
    """Loops (n_loops, n, 3) that wave and bulge at random, clockwise, and normals at their edges."""
    rng, angle = np.random.default_rng(n), -2 * np.pi * np.arange(n) / n
    flat = np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)
    normals = rng.normal(0, 0.3, (n_loops, n, 3)) + np.array([0, 0, 1])
    points = flat * rng.uniform(0.7, 1.0, (n_loops, n, 1)) + rng.normal(0, 0.1, (n_loops, n, 3))
    return points, normals / np.linalg.norm(normals, axis=-1, keepdims=True)


def sides(corners: IntArray) -> set[tuple[int, int]]:
    return {(t[k - 1], t[k]) for t in corners.tolist() for k in range(3)}


@pytest.mark.parametrize("n", [3, 4, 9, 40])
def test_triangles_close_their_loop_and_each_chord_joins_two(n: int) -> None:
    corners, exists = best_triangulations(*rings(5, n), np.zeros((5, n, n), bool), None)
    assert exists.all()
    for of_loop in corners:
        rim = {((i + 1) % n, i) for i in range(n)}
        assert len(sides(of_loop)) == 3 * (n - 2)
        assert {(a, b) for a, b in sides(of_loop) if (b, a) not in sides(of_loop)} == rim


@pytest.mark.parametrize("n", [3, 5, 24])
def test_a_loop_gets_the_same_triangles_alone_and_among_others(n: int) -> None:
    points, normals = rings(7, n)
    together, _ = best_triangulations(points, normals, np.zeros((7, n, n), bool), None)
    for i in range(7):
        alone, _ = best_triangulations(points[i : i + 1], normals[i : i + 1], np.zeros((1, n, n), bool), None)
        assert alone[0].tolist() == together[i].tolist()


def test_of_two_roofs_the_one_that_is_not_forbidden_is_taken() -> None:
    points, normals = (np.repeat(part, 4, axis=0) for part in rings(1, 4))
    chords = np.zeros((4, 4, 4), bool)
    chords[[1, 3], 0, 2] = chords[[2, 3], 1, 3] = True
    corners, exists = best_triangulations(points, normals, chords, None)
    assert exists.tolist() == [True, True, True, False]
    assert (3, 1) in sides(corners[1])
    assert (2, 0) in sides(corners[2])


def test_a_forbidden_triangle_is_left_out() -> None:
    points, normals = rings(1, 4)
    chords = np.zeros((1, 4, 4), bool)
    (free,), _ = best_triangulations(points, normals, chords, None)
    first = sorted(free[0].tolist())

    def is_forbidden(i: IntArray, k: IntArray, j: IntArray) -> BoolArray:
        i, k, j = np.broadcast_arrays(i, k, j)
        return np.asarray((np.sort(np.stack([i, k, j]), axis=0) == np.reshape(first, (3, 1, 1))).all(axis=0)[None])

    (other,), exists = best_triangulations(points, normals, chords, is_forbidden)
    assert exists.all()
    assert first not in np.sort(other, axis=1).tolist()
