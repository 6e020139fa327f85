"""Places on a scan where there is room for calibration holes."""

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.types import IntArray, TriangleMesh, Vertices

# Places that are tried for each one that is looked for.
_TRIES = 30


def pick_sites(mesh: TriangleMesh, rim: IntArray, room: float, most: int, rng: np.random.Generator) -> Vertices:
    """Pick places (k, 3) on the surface that keep clear of rims and of each other."""
    corners = mesh.triangles[rng.integers(len(mesh.triangles), size=_TRIES * most), 0]
    candidates = mesh.vertices[corners]
    candidates = candidates[cKDTree(mesh.vertices[rim]).query(candidates)[0] > room]
    taken = np.zeros((0, 3))
    for place in candidates:
        if (np.linalg.norm(taken - place, axis=1) > 2 * room).all():
            taken = np.concatenate([taken, place[np.newaxis]])
        if len(taken) == most:
            break
    return taken
