"""Patterned sheets that a dictionary learns well, for tests of trainings."""

import numpy as np

from quadpatch.types import TriangleMesh
from training.procedural import sheet_triangles


def wall(seed: int, n: int = 100, period: float = 12.0, depth: float = 2.0) -> TriangleMesh:
    """A sheet of n by n vertices about one unit apart, with bumps whose places follow from the seed."""
    rng = np.random.default_rng(seed)
    x, y = (axis.ravel() + rng.uniform(-0.2, 0.2, n * n) for axis in np.meshgrid(np.arange(n), np.arange(n)))
    shift = rng.uniform(0, 100, 2)
    z = depth * np.sin(2 * np.pi * (x + shift[0]) / period) * np.sin(2 * np.pi * (y + shift[1]) / period)
    return TriangleMesh(np.stack([x, y, z], axis=1), sheet_triangles(n))
