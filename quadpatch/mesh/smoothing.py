"""Laplacian smoothing: the low-resolution base surface of a mesh.

Uniform weights, all vertices at once (Jacobi), as one sparse matrix applied again and again. A boundary vertex is
averaged with its neighbours along the boundary only: the rim of an open scan gets smooth as a curve and is not
pulled into the surface, and the base surface still reaches (nearly) to where the scan ends. Vertices that no triangle
uses stay where they are.
"""

import numpy as np
import scipy.sparse

from quadpatch.types import IntArray, TriangleMesh, Triangles


def laplacian_smooth(mesh: TriangleMesh, n_iterations: int) -> TriangleMesh:
    """Move every vertex to the mean of its neighbours, several times.

    Parameters
    ----------
    mesh : TriangleMesh
        Any triangle soup; non-manifold edges are fine.
    n_iterations : int
        0 gives the vertices back unchanged.

    Returns
    -------
    TriangleMesh
        New vertices, the very same triangles.
    """
    average = neighbour_average(mesh.triangles, len(mesh.vertices))
    vertices = mesh.vertices
    for _ in range(n_iterations):
        vertices = np.asarray(average @ vertices)
    return TriangleMesh(vertices, mesh.triangles)


def neighbour_average(triangles: Triangles, n_vertices: int) -> scipy.sparse.csr_array[np.float64]:
    """Build the matrix whose rows average over the neighbours of each vertex.

    Parameters
    ----------
    triangles : (n_triangles, 3) int64
    n_vertices : int

    Returns
    -------
    (n_vertices, n_vertices) sparse float64
        Rows sum to 1.
    """
    edges, counts = _edges(triangles, n_vertices)
    on_boundary = np.zeros(n_vertices, dtype=np.bool_)
    on_boundary[edges[counts == 1].ravel()] = True
    start = np.concatenate([edges[:, 0], edges[:, 1]])
    end = np.concatenate([edges[:, 1], edges[:, 0]])
    along_boundary = np.concatenate([counts, counts]) == 1
    counts_here = along_boundary | ~on_boundary[start]
    start, end = start[counts_here], end[counts_here]
    lonely = np.flatnonzero(np.bincount(start, minlength=n_vertices) == 0)
    start, end = np.concatenate([start, lonely]), np.concatenate([end, lonely])
    weights = 1.0 / np.bincount(start, minlength=n_vertices)
    return scipy.sparse.csr_array((weights[start], (start, end)), shape=(n_vertices, n_vertices))


def _edges(triangles: Triangles, n_vertices: int) -> tuple[IntArray, IntArray]:
    """Undirected edges (n_edges, 2), each once, and how many triangles have it. Edges of no length are left out."""
    ends = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    ends = ends[ends[:, 0] != ends[:, 1]]
    keys, counts = np.unique(ends[:, 0] * np.int64(n_vertices) + ends[:, 1], return_counts=True)
    return np.stack([keys // n_vertices, keys % n_vertices], axis=1), counts
