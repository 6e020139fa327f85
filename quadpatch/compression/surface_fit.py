"""Moves the vertices of a quad mesh so that its subdivision surface lies on a given surface.

Points of the surface pull the nearest points of the subdivision surface, and the subdivision surface is pulled onto the
surface: the first keeps thin parts and borders, the second keeps it from running where there is nothing. Each round is
one linear least-squares solve; the nearest points are found anew for the next.

References
----------
H. Hoppe, T. DeRose, T. Duchamp, M. Halstead, H. Jin, J. McDonald, J. Schweitzer, W. Stuetzle, "Piecewise smooth surface
reconstruction", SIGGRAPH 1994.
"""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from quadpatch.compression.subdivision import Matrix, quad_edges, subdivide
from quadpatch.mesh.distance import nearest_points, project
from quadpatch.types import FloatArray, IntArray, QuadMesh, TriangleMesh, Triangles, Vertices

# Subdivision steps at which the surfaces are compared; two are close to the limit surface.
_LEVELS = 2
_ROUNDS = 8
# At most so many points of the surface pull.
_MOST_SAMPLES = 25_000
# Weight of the subdivision surface's own points beside those of the surface.
_BACKWARD_WEIGHT = 0.3
# Weight of the quad mesh's Laplacian, which decides where nothing else does.
_SMOOTHNESS = 3e-2
_REGULARISATION = 1e-6


def fit_quads(quad_mesh: QuadMesh, surface: TriangleMesh) -> QuadMesh:
    """Fit the subdivision surface of a quad mesh to a surface.

    Parameters
    ----------
    quad_mesh : QuadMesh
        Near the surface.
    surface : TriangleMesh
        Has triangles.

    Returns
    -------
    QuadMesh
        The same quads, vertices moved.
    """
    n = len(quad_mesh.vertices)
    fine = subdivide(quad_mesh.quads, n, _LEVELS)
    triangles = fine.triangles
    used = np.unique(surface.triangles)
    samples = surface.vertices[used[:: max(1, len(used) // _MOST_SAMPLES)]]
    laplacian = _laplacian(quad_mesh)
    smoothness = sp.csr_array(laplacian.T @ laplacian)
    vertices = quad_mesh.vertices
    for _ in range(_ROUNDS):
        points = np.asarray(fine.matrix @ vertices)
        foot = _foot_matrix(samples, TriangleMesh(points, triangles)) @ fine.matrix
        backward = _BACKWARD_WEIGHT * len(samples) / len(points)
        normal = foot.T @ foot + backward * (fine.matrix.T @ fine.matrix)
        scale = float(normal.diagonal().mean())
        normal = normal + scale * (_SMOOTHNESS * smoothness + _REGULARISATION * sp.eye_array(n))
        pull = foot.T @ (samples - foot @ vertices)
        pull += backward * (fine.matrix.T @ (nearest_points(points, surface) - points))
        pull -= scale * _SMOOTHNESS * (smoothness @ vertices)
        vertices = vertices + splu(sp.csc_array(normal)).solve(np.asarray(pull))
    return QuadMesh(vertices, quad_mesh.quads)


def _foot_matrix(points: Vertices, mesh: TriangleMesh) -> Matrix:
    """Rows that give the nearest point of a mesh to each of some points as a mean of its vertices."""
    _, triangle, places = project(points, mesh)
    weights = barycentric(places, mesh.vertices[mesh.triangles[triangle]])
    return weights_matrix(weights, mesh.triangles[triangle], len(mesh.vertices))


def weights_matrix(weights: FloatArray, corners: Triangles, n_vertices: int) -> Matrix:
    """Sparse (n, n_vertices) rows of weights (n, 3) on corners (n, 3)."""
    row: IntArray = np.repeat(np.arange(len(corners)), 3)
    return sp.csr_array((weights.ravel(), (row, corners.ravel())), shape=(len(corners), n_vertices))


def barycentric(points: Vertices, corners: FloatArray) -> FloatArray:
    """Weights (n, 3) of the corners (n, 3, 3) that give points of their triangles; a third each without area."""
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    offset = points - corners[:, 0]
    a, b, c = (np.einsum("ij,ij->i", p, q) for p, q in ((one, one), (one, two), (two, two)))
    d, e = np.einsum("ij,ij->i", offset, one), np.einsum("ij,ij->i", offset, two)
    area = a * c - b * b
    safe = np.where(area > 0, area, 1.0)
    v, w = (c * d - b * e) / safe, (a * e - b * d) / safe
    weights = np.clip(np.stack([1.0 - v - w, v, w], axis=1), 0.0, 1.0)
    weights = np.where((area > 0)[:, np.newaxis], weights, 1.0)
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def _laplacian(quad_mesh: QuadMesh) -> Matrix:
    n = len(quad_mesh.vertices)
    edges, _, _ = quad_edges(quad_mesh.quads, n)
    start, end = np.concatenate([edges[:, 0], edges[:, 1]]), np.concatenate([edges[:, 1], edges[:, 0]])
    weight = 1.0 / np.maximum(np.bincount(start, minlength=n), 1)
    return sp.csr_array(sp.eye_array(n) - sp.csr_array((weight[start], (start, end)), shape=(n, n)))
