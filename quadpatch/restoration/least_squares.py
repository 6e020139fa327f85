r"""Least-squares meshes: positions of all vertices from those of some, by connectivity alone.

With :math:`L = I - D^{-1} A` the uniform Laplacian (A the adjacency, D the count of neighbours), the missing positions
minimise :math:`\|L x\|^2` over all vertices while the measured ones stay where they are. Every vertex wants to lie at
the mean of its neighbours, so missing vertices are spaced evenly and their surface is as smooth as the graph knows.

References
----------
O. Sorkine, D. Cohen-Or, "Least-squares meshes", Shape Modeling International, 2004.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from quadpatch.errors import StageError
from quadpatch.mesh.topology import components, directed_edges, edge_keys
from quadpatch.types import BoolArray, FloatArray, Triangles


def adjacency(triangles: Triangles, n_vertices: int) -> "sparse.csr_array[np.float64]":
    """Matrix (n_vertices, n_vertices) with 1 for every pair of vertices that share an edge."""
    edges = directed_edges(triangles)
    edges = edges[np.unique(edge_keys(edges, n_vertices), return_index=True)[1]]
    edges = edges[edges[:, 0] != edges[:, 1]]
    start, end = np.concatenate([edges, edges[:, ::-1]]).T
    return sparse.csr_array((np.ones(len(start)), (start, end)), shape=(n_vertices, n_vertices))


def within_reach(triangles: Triangles, missing: BoolArray) -> BoolArray:
    """Missing vertices (n,) of pieces that have a measured vertex too: of others nothing says where they lie."""
    n = len(missing)
    used = np.zeros(n, bool)
    used[triangles.ravel()] = True
    piece = components(directed_edges(triangles), n)
    has_measured = np.zeros(n, bool)
    has_measured[piece[~missing & used]] = True
    return np.asarray(missing & used & has_measured[piece])


def extend_smoothly(triangles: Triangles, missing: BoolArray, values: FloatArray) -> FloatArray:
    """Give missing vertices the values of a least-squares mesh.

    Parameters
    ----------
    triangles : (m, 3) int64
    missing : (n,) bool
        All of them within reach of a measured vertex, see `within_reach`.
    values : (n, d) float64
        Positions, or anything else that is smooth over the surface; never read where missing.

    Returns
    -------
    (n, d) float64
        A copy; the values of measured vertices keep their bits.

    Raises
    ------
    StageError
        If the system is singular in float64.
    """
    result = values.copy()
    if not missing.any():
        return result
    neighbours = adjacency(triangles, len(missing))
    count = np.maximum(neighbours.sum(axis=1), 1.0)
    laplacian = sparse.csr_array(sparse.eye_array(len(missing)) - sparse.diags_array(1.0 / count) @ neighbours)
    # Vertices without a missing one around them add a constant.
    free = sparse.csc_array(laplacian[:, missing])
    right = -(free.T @ (laplacian[:, ~missing] @ values[~missing]))
    try:
        factors = splu(
            sparse.csc_array(free.T @ free),
            permc_spec="MMD_AT_PLUS_A",
            options={"SymmetricMode": True},
            diag_pivot_thresh=0.0,
        )
    except RuntimeError as error:
        raise StageError("the positions of missing vertices can't be computed in float64") from error
    result[missing] = factors.solve(np.ascontiguousarray(right))
    return result
