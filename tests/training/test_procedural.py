import numpy as np
import pytest

from quadpatch.types import TriangleMesh
from training.patterns import PATTERNS
from training.procedural import relief_mesh, reliefs


def edges_and_counts(mesh: TriangleMesh) -> tuple[np.ndarray, np.ndarray]:
    t = mesh.triangles
    ends = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    edges, counts = np.unique(ends, axis=0, return_counts=True)
    return edges, counts


def test_every_pattern_comes_as_often_as_asked_and_each_time_otherwise() -> None:
    made = list(reliefs(2, seed=5, n_side=20))
    assert [relief.pattern for relief in made] == [name for name in sorted(PATTERNS) for _ in range(2)]
    for one, two in zip(made[::2], made[1::2], strict=True):
        assert not np.array_equal(one.mesh.vertices, two.mesh.vertices)


def test_same_seed_same_bits_and_other_seeds_other_ones() -> None:
    one, same, other = (list(reliefs(1, seed, n_side=16)) for seed in (1, 1, 2))
    for a, b, c in zip(one, same, other, strict=True):
        np.testing.assert_array_equal(a.mesh.vertices, b.mesh.vertices)
        assert not np.array_equal(a.mesh.vertices, c.mesh.vertices)


@pytest.mark.parametrize("seed", range(6))
def test_a_sheet_is_one_open_oriented_manifold_with_edges_of_about_one(seed: int) -> None:
    mesh = relief_mesh("waves", np.random.default_rng(seed), 40)
    edges, counts = edges_and_counts(mesh)
    assert set(counts.tolist()) == {1, 2}
    assert (counts == 1).sum() == 4 * 39
    # Each directed edge once: all triangles turn the same way.
    t = mesh.triangles
    directed = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    assert len(np.unique(directed, axis=0)) == len(directed)
    lengths = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)
    assert 0.8 < lengths.mean() < 1.6
    assert len(mesh.vertices) - len(edges) + len(t) == 1
