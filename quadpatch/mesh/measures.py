"""Lengths of a mesh.

A repair asks for the same lengths at several places, and on a large scan each of them is a pass over all triangles: the
bounding box and the edges of a mesh are measured once, and kept as long as the mesh is.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from quadpatch.mesh.passes import Rows, extent, parts_of
from quadpatch.types import BoolArray, FloatArray, TriangleMesh, Triangles

# Lengths that are summed together, and triangles that are looked at together: what is made of them fits into the
# processor's cache.
_SUMMED, _CHUNK = 1 << 16, 1 << 13
# Edges longer than so many mean ones are long.
LONG_EDGE = 8.0

Measure = TypeVar("Measure")


def once_per_mesh(measure: Callable[[TriangleMesh], Measure]) -> Callable[[TriangleMesh], Measure]:
    """Keep what is measured of a mesh as long as the mesh is."""
    known: WeakKeyDictionary[TriangleMesh, Measure] = WeakKeyDictionary()

    @wraps(measure)
    def looked_up(mesh: TriangleMesh) -> Measure:
        if mesh not in known:
            known[mesh] = measure(mesh)
        return known[mesh]

    return looked_up


@dataclass(frozen=True)
class EdgeStatistics:
    """Mean and longest edge of a mesh, in mesh units; an edge counts once for each of its triangles."""

    mean: float
    longest: float


@once_per_mesh
def edge_statistics(mesh: TriangleMesh) -> EdgeStatistics:
    """Measure all edges in one pass; 0 without triangles."""
    if not len(mesh.triangles):
        return EdgeStatistics(0.0, 0.0)
    points, total, longest = Rows(mesh.vertices), 0.0, 0.0
    for part in parts_of(len(mesh.triangles), _SUMMED):
        lengths = _edge_lengths(points, mesh.triangles[part])
        for of_side in lengths.sum(axis=1).tolist():
            total += of_side
        longest = max(longest, float(lengths.max()))
    return EdgeStatistics(total / (3 * len(mesh.triangles)), longest)


def _edge_lengths(points: Rows, triangles: Triangles) -> FloatArray:
    """Lengths (3, m) of the edges of triangles, in mesh units."""
    lengths = np.zeros((3, len(triangles)))
    for part in parts_of(len(triangles), _CHUNK):
        corners = [points.at(triangles[part, corner]) for corner in range(3)]
        for k in range(3):
            edges = corners[(k + 1) % 3] - corners[k]
            lengths[k, part] = np.sqrt(np.einsum("ij,ij->i", edges, edges))
    return lengths


def mean_edge_length(mesh: TriangleMesh) -> float:
    """Mean edge length, in mesh units; an edge counts once for each of its triangles. 0 without triangles."""
    return edge_statistics(mesh).mean


def used_vertices(triangles: Triangles, n_vertices: int) -> BoolArray:
    """Which vertices (n_vertices,) a triangle uses."""
    used = np.zeros(n_vertices, bool)
    used[triangles.ravel()] = True
    return used


@once_per_mesh
def bounding_box(mesh: TriangleMesh) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest corner (3,) of the box of all vertices that a triangle uses; there is a triangle."""
    used = used_vertices(mesh.triangles, len(mesh.vertices))
    return extent(mesh.vertices if used.all() else mesh.vertices[used])


def diagonal(mesh: TriangleMesh) -> float:
    """Diagonal of the bounding box of all vertices that a triangle uses, in mesh units."""
    if not len(mesh.triangles):
        return 0.0
    low, high = bounding_box(mesh)
    return float(np.linalg.norm(high - low))


def surface_area(mesh: TriangleMesh) -> float:
    """Area of all triangles, in mesh units squared."""
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2


def longest_side(mesh: TriangleMesh) -> float:
    """Longest side of the bounding box of all vertices that a triangle uses, in mesh units; the paper's unit."""
    if not len(mesh.triangles):
        return 0.0
    low, high = bounding_box(mesh)
    return float((high - low).max())
