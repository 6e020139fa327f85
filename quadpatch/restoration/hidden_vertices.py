"""Measured vertices that are hidden and restored, so that it is known how wrong a restoration is.

What is hidden must be as hard to restore as what is missing. The *depth* of a missing vertex is how many edges it is
from the nearest measured one. Some measured vertices are hidden one by one, among neighbours that are missing at the
same rate as anywhere; where missing vertices lie deeper, whole neighbourhoods are hidden too. Errors are then weighed
so that each class of depth counts as much as it does among the missing vertices.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.restoration.least_squares import adjacency
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Share of the measured vertices that may be hidden: few, or they would be harder to restore than the missing ones.
HIDDEN_SHARE = 0.08
MOST_HIDDEN = 6000
# With fewer hidden vertices an error says nothing.
FEWEST_HIDDEN = 40
# Neighbourhoods that are drawn; those over the budget are left out.
_NEIGHBOURHOODS = 64
# Deeper vertices count as of this depth.
_DEEPEST = 32


@dataclass(frozen=True)
class HiddenVertices:
    """Measured vertices that a restoration is tried on.

    Attributes
    ----------
    vertices : (h,) int64
    weight : (h,) float64
        Sums to 1; by the share of the class of their depth among the missing vertices.
    """

    vertices: IntArray
    weight: FloatArray

    def with_missing(self, missing: BoolArray) -> BoolArray:
        """(n,) bool, True for hidden and for missing vertices."""
        both = missing.copy()
        both[self.vertices] = True
        return both


@dataclass(frozen=True)
class Trial:
    """Hidden vertices, restored beside the missing ones.

    Attributes
    ----------
    hidden : HiddenVertices
    missing : (n,) bool
        The hidden ones among them.
    placed : dict
        Vertices (n, 3) by the way they were placed.
    """

    hidden: HiddenVertices
    missing: BoolArray
    placed: dict[str, Vertices]

    def errors(self, vertices: Vertices, surface: TriangleMesh) -> FloatArray:
        """Distances (h,) of restored hidden vertices (of all, (n, 3)) to a mesh that holds the true ones."""
        return distance_to_mesh(np.ascontiguousarray(vertices[self.hidden.vertices]), surface)

    def rms(self, errors: FloatArray) -> float:
        """Weighted root mean square of some errors (h,)."""
        return float(np.sqrt((self.hidden.weight * errors**2).sum()))


def depths(triangles: Triangles, missing: BoolArray) -> IntArray:
    """Count of edges (n,) from each vertex to the nearest measured one: 0 where measured, at most 32."""
    neighbours = adjacency(triangles, len(missing))
    depth = np.where(missing, _DEEPEST, 0)
    reached = ~missing
    # Loop over depths, not vertices.
    for level in range(1, _DEEPEST):
        front = (neighbours @ reached.astype(np.float64) > 0) & ~reached
        if not front.any():
            break
        depth[front] = level
        reached = reached | front
    return depth


def hide(triangles: Triangles, missing: BoolArray, rng: np.random.Generator) -> HiddenVertices | None:
    """Choose measured vertices that are as hard to restore as the missing ones.

    Parameters
    ----------
    triangles : (m, 3) int64
    missing : (n,) bool
    rng : numpy.random.Generator

    Returns
    -------
    HiddenVertices or None
        None where too few vertices are measured.
    """
    neighbours = adjacency(triangles, len(missing))
    measured = np.flatnonzero(~missing & (neighbours.sum(axis=1) > 0))
    budget = int(min(HIDDEN_SHARE * len(measured), MOST_HIDDEN))
    if budget < FEWEST_HIDDEN:
        return None
    depth = depths(triangles, missing)
    wanted = _classes(depth[missing])
    deep = depth[missing & (depth > 1)]
    hidden = np.zeros(len(missing), bool)
    # Loop over neighbourhoods, not vertices.
    for levels in rng.choice(deep, _NEIGHBOURHOODS).tolist() if len(deep) else []:
        ball = _ball(neighbours, int(rng.choice(measured)), levels) & ~missing
        if (hidden | ball).sum() <= budget // 2:
            hidden |= ball
    left = measured[~hidden[measured]]
    hidden[rng.choice(left, min(budget - budget // 2, len(left)), replace=False)] = True
    vertices = np.flatnonzero(hidden)
    found = _classes(depths(triangles, missing | hidden)[vertices])
    share = np.bincount(wanted, minlength=8) / max(len(wanted), 1)
    weight = share[found] / np.maximum(np.bincount(found, minlength=8), 1)[found]
    if not weight.sum() > 0:
        weight = np.ones(len(vertices))
    return HiddenVertices(vertices, np.asarray(weight / weight.sum()))


def _classes(depth: IntArray) -> IntArray:
    """Classes of depth: 1, 2 to 3, 4 to 7 and so on, counted from 0."""
    return np.asarray(np.log2(np.maximum(depth, 1)), np.int64)


def _ball(neighbours: "sparse.csr_array[np.float64]", centre: int, depth: int) -> BoolArray:
    """Vertices (n,) less than `depth` edges away from one: hidden together, they put it at that depth."""
    inside = np.zeros(neighbours.shape[0])
    inside[centre] = 1.0
    for _ in range(depth - 1):
        inside = np.asarray(inside + neighbours @ inside > 0, np.float64)
    return np.asarray(inside > 0)
