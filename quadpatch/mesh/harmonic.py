"""Harmonic extension: known values of some nodes of a graph, extended over the others.

The unknown values solve the uniform graph Laplace equation, that is, every unknown node holds the mean of its
neighbours. Hence no value leaves the range of the known ones (discrete maximum principle), and one sparse solve
serves all holes at once, because holes are separate components.
"""

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from quadpatch.types import BoolArray, FloatArray, IntArray


def extend_harmonically(edges: IntArray, known: BoolArray, values: FloatArray) -> FloatArray:
    """Spread known node values over the unknown nodes of a graph.

    Parameters
    ----------
    edges : (n_edges, 2) int64
        Pairs of nodes, repeats and both directions allowed.
    known : (n_nodes,) bool
    values : (n_nodes, d) float64
        Ignored where not known.

    Returns
    -------
    (n_nodes, d) float64
        Known values unchanged; NaN in components without any known node.
    """
    n_nodes = len(known)
    result = np.where(known[:, np.newaxis], values, np.nan)
    adjacency = _adjacency(edges, n_nodes)
    n_components, component = connected_components(adjacency, directed=False)
    reached = np.zeros(n_nodes, dtype=bool)
    reached[component[known]] = True
    solved = ~known & reached[component]
    if not solved.any():
        return result
    low = np.full((n_components, values.shape[1]), np.inf)
    high = -low
    np.minimum.at(low, component[known], values[known])
    np.maximum.at(high, component[known], values[known])
    low, high = low[component[solved]], high[component[solved]]
    extended = _solution(adjacency, known, solved, values)
    # Numbers near the largest float64 overflow in the sums, and take the middle of their range.
    extended = np.where(np.isfinite(extended), extended, 0.5 * low + 0.5 * high)
    # Rounding may step over the range of a component by a few units in the last place.
    result[solved] = np.clip(extended, low, high)
    return result


def _solution(adjacency: csr_array, known: BoolArray, solved: BoolArray, values: FloatArray) -> FloatArray:
    """Values (n_solved, d) that are the mean of their neighbours'; NaN where that can't be computed."""
    degree = diags_array(adjacency.sum(axis=1)).tocsr()
    laplacian = csr_array((degree - adjacency)[solved])
    try:
        factors = splu(laplacian[:, solved].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    except RuntimeError:
        # SuperLU's word for a matrix that is singular to its accuracy.
        return np.full((int(solved.sum()), values.shape[1]), np.nan)
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(factors.solve(np.ascontiguousarray(-(laplacian[:, known] @ values[known]))))


def _adjacency(edges: IntArray, n_nodes: int) -> csr_array:
    both = np.concatenate([edges, edges[:, ::-1]])
    matrix = coo_array((np.ones(len(both)), (both[:, 0], both[:, 1])), shape=(n_nodes, n_nodes)).tocsr()
    matrix.sum_duplicates()
    matrix.data[:] = 1.0
    matrix.setdiag(0.0)
    matrix.eliminate_zeros()
    return matrix
