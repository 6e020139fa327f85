"""Edges and connected components."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from quadpatch.types import IntArray, Triangles


def directed_edges(triangles: Triangles) -> IntArray:
    """Directed edges of all triangles, (3 n_triangles, 2) int64; edge ``3 t + k`` runs from corner k of triangle t."""
    return triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)


def edge_keys(edges: IntArray, n_vertices: int) -> IntArray:
    """One int64 for every edge, the same in both directions; ``n_vertices`` squared must fit 63 bits."""
    start, end = edges[:, 0], edges[:, 1]
    return np.minimum(start, end) * np.int64(n_vertices) + np.maximum(start, end)


def components(links: IntArray, n: int) -> IntArray:
    """Find the connected component of each of n things that some links (k, 2) join, (n,) int64, counted from 0."""
    if not len(links):
        return np.arange(n, dtype=np.int64)
    # Short integers, where they do: scipy would look for the largest one and copy.
    short: NDArray[np.int32] | IntArray = links.astype(np.int32) if n <= np.iinfo(np.int32).max else links
    graph = coo_array((np.ones(len(links), np.int8), (short[:, 0], short[:, 1])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], np.int64)


def face_components(faces: IntArray, n_vertices: int) -> IntArray:
    """Find the connected component, over shared vertices, of each face (n, k), (n,) int64, counted from 0."""
    n_faces, n_corners = faces.shape
    links = np.stack([np.repeat(np.arange(n_faces), n_corners), n_faces + faces.ravel()], axis=1)
    labels = components(links, n_faces + n_vertices)[:n_faces]
    return np.asarray(np.unique(labels, return_inverse=True)[1], np.int64)
