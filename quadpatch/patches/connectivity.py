"""Connectivity: which patch, and which place in its grid, every vertex falls in."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.patches.ray_visibility import LEAST_FACING
from quadpatch.types import BoolArray, FloatArray, IntArray, Patches, Vertices

# A vertex belongs to the surface that a patch shows if it lies within this many bins of it.
_TOLERANCE_BINS = 1.0
# Bins around a vertex that must have seen the surface, by bilinear weight.
_LEAST_SEEN = 0.5
# Vertices looked up at once: bounds the memory where many patches overlap.
_CHUNK = 20_000


@dataclass(frozen=True)
class Connectivity:
    """Pairs of a vertex and a patch that shows it.

    Attributes
    ----------
    vertex, patch : (c,) int64
        Sorted by vertex, then by patch.
    row, column : (c,) float64
        Place in the grid in bins; bin (i, j) has its centre at row i, column j. Between -0.5 and N - 0.5.
    """

    vertex: IntArray
    patch: IntArray
    row: FloatArray
    column: FloatArray


def vertices_in_patches(vertices: Vertices, vertex_normals: FloatArray, patches: Patches) -> Connectivity:
    """Find all patches that show a vertex.

    A patch shows a vertex if it lies over its square, within one bin of the surface that the patch sees there, and
    its normal looks along z.

    Parameters
    ----------
    vertices : (n, 3) float64
    vertex_normals : (n, 3) float64
        Unit normals; a vertex with a zero normal is in no patch.
    patches : Patches

    Returns
    -------
    Connectivity
    """
    if len(patches) == 0 or len(vertices) == 0:
        return _joined([])
    tolerance = _TOLERANCE_BINS * patches.length / patches.resolution
    highest = float(np.abs(patches.heights).max()) + tolerance
    # The corner of the box over a patch that holds all surface it can see.
    radius = float(np.hypot(patches.length * np.sqrt(0.5), highest))
    anchors = cKDTree(patches.origins)
    # Loop over chunks, not vertices.
    found = []
    for start in range(0, len(vertices), _CHUNK):
        vertex, patch = _near(cKDTree(vertices[start : start + _CHUNK]), anchors, radius)
        found.append(_shown(vertices, vertex_normals, patches, vertex + start, patch))
    return _joined(found)


def vertices_in_balls(vertices: Vertices, vertex_normals: FloatArray, patches: Patches) -> Connectivity:
    """Find all patches whose ball holds a vertex: the paper's connectivity, which needs no surface in the patch.

    A patch holds a vertex if it lies over its square, in the ball around its seed that goes through the corners of the
    square, and its normal looks along z.

    Parameters
    ----------
    vertices : (n, 3) float64
    vertex_normals : (n, 3) float64
        Unit normals; a vertex with a zero normal is in no patch.
    patches : Patches

    Returns
    -------
    Connectivity
    """
    if len(patches) == 0 or len(vertices) == 0:
        return _joined([])
    anchors, found = cKDTree(patches.origins), []
    # Loop over chunks, not vertices.
    for start in range(0, len(vertices), _CHUNK):
        tree = cKDTree(vertices[start : start + _CHUNK])
        vertex, patch = _near(tree, anchors, patches.length * np.sqrt(0.5))
        found.append(_over(vertices, vertex_normals, patches, vertex + start, patch)[0])
    return _joined(found)


def merged(one: Connectivity, other: Connectivity, n_patches: int) -> Connectivity:
    """Merge the connectivity of the same vertices in two sets of patches, of which the first has `n_patches`."""
    both = _joined([one, Connectivity(other.vertex, other.patch + n_patches, other.row, other.column)])
    order = np.lexsort((both.patch, both.vertex))
    return Connectivity(both.vertex[order], both.patch[order], both.row[order], both.column[order])


def bilinear(maps: FloatArray, connectivity: Connectivity, seen: BoolArray | None = None) -> FloatArray:
    """Read maps at the places of a connectivity, interpolating between bin centres.

    Parameters
    ----------
    maps : (n_patches, N, N) float64
    connectivity : Connectivity
    seen : (n_patches, N, N) bool, optional
        Bins that count; the weights of the others go to their neighbours. NaN where none of the four counts.

    Returns
    -------
    (c,) float64
        Constant beyond the outermost bin centres.
    """
    if seen is None:
        return _gather(maps, connectivity)
    weight = _gather(seen.astype(np.float64), connectivity)
    total = _gather(np.where(seen, maps, 0.0), connectivity)
    mean: FloatArray = np.divide(total, weight, out=np.full(len(total), np.nan), where=weight > 0)
    return mean


def _gather(maps: FloatArray, connectivity: Connectivity) -> FloatArray:
    last = maps.shape[-1] - 1
    row, column = np.clip(connectivity.row, 0, last), np.clip(connectivity.column, 0, last)
    top, left = np.floor(row).astype(np.int64), np.floor(column).astype(np.int64)
    down, right = row - top, column - left
    bottom, far = np.minimum(top + 1, last), np.minimum(left + 1, last)
    patch = connectivity.patch
    upper = maps[patch, top, left] * (1 - right) + maps[patch, top, far] * right
    lower = maps[patch, bottom, left] * (1 - right) + maps[patch, bottom, far] * right
    return np.asarray(upper * (1 - down) + lower * down)


def _near(vertices: cKDTree, anchors: cKDTree, radius: float) -> tuple[IntArray, IntArray]:
    """Pairs (k,) of a vertex and an anchor that lie no further apart than a radius; sorted."""
    near = vertices.sparse_distance_matrix(anchors, radius, output_type="ndarray")
    pairs = np.lexsort((near["j"], near["i"]))
    return near["i"][pairs].astype(np.int64), near["j"][pairs].astype(np.int64)


def _shown(
    vertices: Vertices, normals: FloatArray, patches: Patches, vertex: IntArray, patch: IntArray
) -> Connectivity:
    """Keep the pairs whose vertex lies on what the patch shows."""
    candidates, height = _over(vertices, normals, patches, vertex, patch)
    surface = bilinear(patches.heights, candidates, patches.seen)
    is_close = np.abs(height - surface) <= _TOLERANCE_BINS * patches.length / patches.resolution
    is_seen = _gather(patches.seen.astype(np.float64), candidates) >= _LEAST_SEEN
    # A comparison with NaN is false: where no bin saw anything there is nothing to be close to.
    kept = np.flatnonzero(is_close & is_seen)
    return Connectivity(candidates.vertex[kept], candidates.patch[kept], candidates.row[kept], candidates.column[kept])


def _over(
    vertices: Vertices, normals: FloatArray, patches: Patches, vertex: IntArray, patch: IntArray
) -> tuple[Connectivity, FloatArray]:
    """Keep the pairs whose vertex lies over the square and looks along z; with the heights of the vertices."""
    is_facing = np.einsum("ij,ij->i", normals[vertex], patches.frames[patch, 2]) > LEAST_FACING
    vertex, patch = vertex[is_facing], patch[is_facing]
    local = np.einsum("nij,nj->ni", patches.frames[patch], vertices[vertex] - patches.origins[patch])
    is_over = np.abs(local[:, :2]).max(axis=1, initial=0.0) <= patches.length / 2
    vertex, patch, local = vertex[is_over], patch[is_over], local[is_over]
    bins = local[:, :2] * (patches.resolution / patches.length) + (patches.resolution - 1) / 2
    return Connectivity(vertex, patch, bins[:, 1], bins[:, 0]), local[:, 2]


def _joined(parts: list[Connectivity]) -> Connectivity:
    none, nowhere = np.zeros(0, dtype=np.int64), np.zeros(0)
    return Connectivity(
        np.concatenate([none, *(part.vertex for part in parts)]),
        np.concatenate([none, *(part.patch for part in parts)]),
        np.concatenate([nowhere, *(part.row for part in parts)]),
        np.concatenate([nowhere, *(part.column for part in parts)]),
    )
