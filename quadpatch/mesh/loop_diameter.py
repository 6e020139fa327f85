"""Diameter of a point set: the largest distance between two of its points.

Tested in `tests/quadpatch/mesh/test_hole_measures.py`.
"""

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from quadpatch.types import FloatArray, Vertices

# Up to here, all pairwise distances of a loop are cheaper than its convex hull.
_SMALL_LOOP = 400

# With more points than this, their hull takes seconds where all of them lie on it.
_MOST_FOR_HULL = 20_000

# With more corners on the hull than this, all pairs of them would take seconds and gigabytes.
_MOST_EXACT = 5000

# Directions that are spread evenly over the half sphere lie within 0.06 of any other one: the extent along the best of
# them is at least cos(0.06) of the diameter.
_N_DIRECTIONS = 1024
_CHUNK = 64
_N_SWEEPS = 8


def loop_diameter(points: Vertices) -> float:
    """Measure the largest distance between two of the points (n, 3).

    Exact for up to 20,000 points whose convex hull has up to 5000 corners; beyond, at most 0.2 % too small, in linear
    time.
    """
    if _SMALL_LOOP < len(points) <= _MOST_FOR_HULL:
        points = hull_corners(points)
    if len(points) > _MOST_EXACT:
        return _diameter_by_directions(points)
    # In pieces: a loop on a ball has every vertex on its hull, and all pairs of a long one would fill the memory.
    pieces = range(0, len(points), _SMALL_LOOP)
    return max(float(_distances(points[i : i + _SMALL_LOOP], points).max()) for i in pieces)


def hull_corners(points: Vertices) -> Vertices:
    """Pick the corners of the convex hull of points (n, 3), in as many dimensions as they span."""
    centred = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    for n_dimensions in (3, 2):
        try:
            return points[ConvexHull(centred @ axes[:n_dimensions].T).vertices]
        except QhullError:
            # The points are flat, or lie on a line.
            continue
    along = centred @ axes[0]
    return points[[int(along.argmin()), int(along.argmax())]]


def _diameter_by_directions(points: Vertices) -> float:
    """Measure between the extreme points of many directions, then between those and all points."""
    ends = []
    for directions in np.array_split(_directions(), _N_DIRECTIONS // _CHUNK):
        along = directions @ points.T
        ends += [along.argmin(axis=1), along.argmax(axis=1)]
    extremes = points[np.unique(np.concatenate(ends))]
    furthest = extremes[np.argsort(-_distances(extremes, extremes).max(axis=1), kind="stable")[:_N_SWEEPS]]
    return float(_distances(furthest, points).max())


def _distances(points: Vertices, others: Vertices) -> FloatArray:
    """Measure the distances (n, m) of points (n, 3) from others (m, 3)."""
    x, y, z = points.T[:, :, None] - others.T[:, None, :]
    return np.asarray(np.sqrt(x * x + y * y + z * z))


def _directions() -> FloatArray:
    """Return unit vectors (1024, 3) along a Fibonacci spiral over the half sphere."""
    i = np.arange(_N_DIRECTIONS)
    z = (i + 0.5) / _N_DIRECTIONS
    angle = np.pi * (1 + np.sqrt(5)) * i
    radius = np.sqrt(1 - z**2)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)
