"""Lengths of a mesh."""

import numpy as np

from quadpatch.mesh.topology import directed_edges
from quadpatch.types import TriangleMesh


def mean_edge_length(mesh: TriangleMesh) -> float:
    """Mean edge length, in mesh units; an edge counts once for each of its triangles. 0 without triangles."""
    if not len(mesh.triangles):
        return 0.0
    edges = directed_edges(mesh.triangles)
    return float(np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1).mean())


def diagonal(mesh: TriangleMesh) -> float:
    """Diagonal of the bounding box of all vertices that a triangle uses, in mesh units."""
    if not len(mesh.triangles):
        return 0.0
    return float(np.linalg.norm(np.ptp(mesh.vertices[mesh.triangles].reshape(-1, 3), axis=0)))


def surface_area(mesh: TriangleMesh) -> float:
    """Area of all triangles, in mesh units squared."""
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2


def longest_side(mesh: TriangleMesh) -> float:
    """Longest side of the bounding box of all vertices that a triangle uses, in mesh units; the paper's unit."""
    if not len(mesh.triangles):
        return 0.0
    return float(np.ptp(mesh.vertices[mesh.triangles].reshape(-1, 3), axis=0).max())
