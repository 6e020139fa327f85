"""Distances from points to a triangle mesh; the one place that imports libigl."""

import igl
import numpy as np

from quadpatch.types import FloatArray, TriangleMesh, Vertices


def distance_to_mesh(points: Vertices, mesh: TriangleMesh) -> FloatArray:
    """Measure how far points (n, 3) are from the nearest triangle: (n,) float64, in mesh units.

    Infinite where the mesh has no triangle.
    """
    if not len(mesh.triangles) or not len(points):
        return np.full(len(points), np.inf)
    used, local = np.unique(mesh.triangles, return_inverse=True)
    squared, _, _ = igl.point_mesh_squared_distance(
        np.ascontiguousarray(points), mesh.vertices[used], local.reshape(-1, 3)
    )
    return np.asarray(np.sqrt(squared))
