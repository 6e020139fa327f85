"""A part with edges, and masks of missing vertices."""

import numpy as np

from quadpatch.types import BoolArray, TriangleMesh
from tests.quadpatch.shapes import open_grid


def step(n: int = 25) -> TriangleMesh:
    """Fold a grid of n x n vertices along its middle into a right angle: two planes and a sharp edge."""
    flat = open_grid(n)
    x, y = flat.vertices[:, 0], flat.vertices[:, 1]
    return TriangleMesh(np.stack([np.minimum(x, 0.0), y, np.minimum(-x, 0.0)], axis=1), flat.triangles)


def scattered(mesh: TriangleMesh, share: float, seed: int = 0) -> BoolArray:
    """Mark a share of the vertices at random."""
    n = len(mesh.vertices)
    missing = np.zeros(n, bool)
    missing[np.random.default_rng(seed).choice(n, round(share * n), replace=False)] = True
    return missing
