"""Distances from points to a triangle mesh, by libigl."""

import igl
import numpy as np

from quadpatch.mesh.topology import compacted
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Vertices


def distance_to_mesh(points: Vertices, mesh: TriangleMesh) -> FloatArray:
    """Measure how far points (n, 3) are from the nearest triangle: (n,) float64, in mesh units.

    Infinite where the mesh has no triangle.
    """
    return nearest_triangles(points, mesh)[0]


def nearest_triangles(points: Vertices, mesh: TriangleMesh) -> tuple[FloatArray, IntArray]:
    """Find the nearest triangle of each point (n, 3).

    Returns
    -------
    distance : (n,) float64
        In mesh units; infinite where the mesh has no triangle.
    triangle : (n,) int64
        -1 where the mesh has no triangle.
    """
    if not len(mesh.triangles) or not len(points):
        return np.full(len(points), np.inf), np.full(len(points), -1)
    squared, triangle, _ = _nearest(points, mesh)
    return np.asarray(np.sqrt(squared)), np.asarray(triangle, np.int64)


class DistanceTree:
    """Distances to one mesh, asked for many times: its tree of bounding boxes is built once.

    Parameters
    ----------
    mesh : TriangleMesh
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        used, self._triangles = compacted(mesh.triangles, len(mesh.vertices))
        self._vertices = mesh.vertices[used]
        self._tree = igl.AABB()
        if len(self._triangles):
            self._tree.init(self._vertices, self._triangles)

    def distance(self, points: Vertices) -> FloatArray:
        """Measure how far points (n, 3) are from the nearest triangle, as `distance_to_mesh` does."""
        if not len(self._triangles) or not len(points):
            return np.full(len(points), np.inf)
        squared = self._tree.squared_distance(self._vertices, self._triangles, np.ascontiguousarray(points))[0]
        return np.asarray(np.sqrt(squared))


def nearest_points(points: Vertices, mesh: TriangleMesh) -> Vertices:
    """Find the nearest point (n, 3) of a mesh, which has triangles, to each of some points (n, 3)."""
    return np.asarray(_nearest(points, mesh)[2])


def project(points: Vertices, mesh: TriangleMesh) -> tuple[FloatArray, IntArray, Vertices]:
    """Find distance (n,), nearest triangle (n,) and nearest point (n, 3) of a mesh, which has triangles."""
    squared, triangle, places = _nearest(points, mesh)
    return np.asarray(np.sqrt(squared)), np.asarray(triangle, np.int64), np.asarray(places)


def _nearest(points: Vertices, mesh: TriangleMesh) -> tuple[FloatArray, IntArray, FloatArray]:
    """Squared distances (n,), triangles (n,) and places (n, 3)."""
    used, local = compacted(mesh.triangles, len(mesh.vertices))
    found = igl.point_mesh_squared_distance(np.ascontiguousarray(points), mesh.vertices[used], local)
    return found[0], found[1], found[2]
