"""Joining vertices that a file repeats.

STL repeats every vertex for every triangle, and exporters repeat vertices along seams, so the edges there look like
boundaries. Only vertices on boundary edges are joined, and only where their coordinates are the same bits (0.0 and
-0.0 are one number): what lies inside a surface, or merely close by, is left as measured.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices


@dataclass(frozen=True)
class Weld:
    """A welded mesh and the way back to its file.

    Attributes
    ----------
    mesh : TriangleMesh
        Vertices in the order in which the file first names them; triangles in the file's order, without those whose
        corners are not three different vertices.
    to_file : (n_welded,) int64
        First file vertex of each welded vertex.
    from_file : (n_file,) int64
        Welded vertex of each file vertex.
    """

    mesh: TriangleMesh
    to_file: IntArray
    from_file: IntArray


def weld(scan_vertices: Vertices, scan_triangles: Triangles) -> Weld:
    """Join the vertices of boundary edges that lie at bit-identical positions.

    Parameters
    ----------
    scan_vertices : (n_file, 3) float64
        In mesh units; finite.
    scan_triangles : (m, 3) int64
    """
    proper = _without_degenerate(scan_triangles)
    first = np.arange(len(scan_vertices), dtype=np.int64)
    candidates = np.flatnonzero(_on_boundary(proper, len(scan_vertices)))
    first[candidates] = candidates[first_of_equal(scan_vertices[candidates])]
    is_first = first == np.arange(len(first))
    from_file = (np.cumsum(is_first) - 1)[first]
    to_file = np.flatnonzero(is_first)
    mesh = TriangleMesh(scan_vertices[to_file], _without_degenerate(from_file[proper]))
    return Weld(mesh, to_file, from_file)


def _without_degenerate(triangles: Triangles) -> Triangles:
    a, b, c = triangles.T
    proper = (a != b) & (b != c) & (c != a)
    return triangles if proper.all() else triangles[proper]


def _on_boundary(triangles: Triangles, n_vertices: int) -> BoolArray:
    """Vertices of edges that exactly one triangle has, (n_vertices,)."""
    starts = triangles.ravel()
    ends = triangles[:, [1, 2, 0]].ravel()
    keys = np.minimum(starts, ends) * n_vertices + np.maximum(starts, ends)
    keys.sort()
    differs = keys[1:] != keys[:-1]
    alone = np.ones(len(keys), dtype=bool)
    alone[1:] &= differs
    alone[:-1] &= differs
    result = np.zeros(n_vertices, dtype=bool)
    result[keys[alone] // n_vertices] = True
    result[keys[alone] % n_vertices] = True
    return result


def first_of_equal(points: FloatArray) -> IntArray:
    """Find the first point that equals each point.

    Parameters
    ----------
    points : (n, 3) float64
        Or any other rows of three finite numbers.

    Returns
    -------
    (n,) int64
        Positions in `points`.
    """
    order = _grouping_order(points)
    begins = np.ones(len(points), dtype=bool)
    begins[1:] = _neighbours_differ(points, order)
    # Both orders are stable, so the first of a group is also the first of the file.
    group = np.cumsum(begins) - 1
    result = np.zeros(len(points), dtype=np.int64)
    result[order] = order[begins][group]
    return result


def _grouping_order(points: FloatArray) -> IntArray:
    """Stable order that puts equal points side by side, (n,) int64.

    Sorting one hash is three times faster than sorting three coordinates; where two different points share a hash,
    their coordinates decide after all.
    """
    # Adding 0.0 turns -0.0 into 0.0, so equal numbers have equal bits.
    bits = (points.T + 0.0).view(np.uint64)
    hashes = np.zeros(len(points), dtype=np.uint64)
    for axis in range(3):
        hashes = (hashes ^ bits[axis]) * np.uint64(0x9E3779B97F4A7C15)
        hashes ^= hashes >> np.uint64(29)
    order = np.argsort(hashes, kind="stable")
    in_order = hashes[order]
    if ((in_order[1:] == in_order[:-1]) & _neighbours_differ(points, order)).any():
        order = np.lexsort(points.T)
    return np.asarray(order, dtype=np.int64)


def _neighbours_differ(points: FloatArray, order: IntArray) -> BoolArray:
    """Whether each point of an order lies elsewhere than the one before it, (n - 1,)."""
    differs = np.zeros(max(len(order) - 1, 0), dtype=bool)
    for axis in range(3):
        column = points[:, axis][order]
        differs |= column[1:] != column[:-1]
    return differs
