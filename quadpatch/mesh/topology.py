"""Edges and connected components."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from quadpatch.types import BoolArray, IntArray, Triangles


def directed_edges(triangles: Triangles) -> IntArray:
    """Directed edges of all triangles, (3 n_triangles, 2) int64; edge ``3 t + k`` runs from corner k of triangle t."""
    return triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)


def edge_keys(edges: IntArray, n_vertices: int) -> IntArray:
    """One int64 for every edge, the same in both directions; ``n_vertices`` squared must fit 63 bits."""
    start, end = edges[:, 0], edges[:, 1]
    return np.minimum(start, end) * np.int64(n_vertices) + np.maximum(start, end)


def order_of(keys: IntArray, bound: int) -> IntArray:
    """Sort keys (n,) of 0 or more and below a bound: positions (n,), those of equal keys in their own order.

    As `numpy.argsort` with ``kind="stable"``. Keys and positions in one number are sorted many times faster.
    """
    bits = max(len(keys) - 1, 0).bit_length()
    if bound.bit_length() + bits > 63:
        return np.argsort(keys, kind="stable")
    packed = (keys << bits) | np.arange(len(keys))
    packed.sort()
    packed &= (1 << bits) - 1
    return packed


def neighbouring_triangles(triangles: Triangles) -> tuple[IntArray, IntArray]:
    """Pairs (n, 2) of triangles with a common edge, and that edge (n, 2); a crowded edge pairs each with the next."""
    edges = directed_edges(triangles)
    n = int(triangles.max(initial=0)) + 1
    keys = edge_keys(edges, n)
    order = order_of(keys, n**2)
    twin = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    return np.stack([order[twin] // 3, order[twin + 1] // 3], axis=1), edges[order[twin]]


def with_marked_edge(triangles: Triangles, marked: BoolArray) -> BoolArray:
    """Which triangles (n_triangles,) have at least two marked corners."""
    a, b, c = (marked[triangles[:, corner]] for corner in range(3))
    return np.asarray((a & b) | (b & c) | (c & a))


def touching(triangles: Triangles, marked: BoolArray) -> BoolArray:
    """Which triangles (m,) have a corner among some vertices."""
    return np.asarray(marked[triangles[:, 0]] | marked[triangles[:, 1]] | marked[triangles[:, 2]])


def edges_found(triangles: Triangles, start: IntArray, end: IntArray, n_vertices: int) -> IntArray:
    """Find edges (n,) among the directed edges of triangles: positions (n,) as `directed_edges` has them, -1 for none.

    Only triangles with two corners among the starts are looked at; the ends have to be among them.
    """
    is_start = np.zeros(n_vertices, bool)
    is_start[start] = True
    near = np.flatnonzero(with_marked_edge(triangles, is_start))
    edges = directed_edges(triangles[near])
    keys = edges[:, 0] * np.int64(n_vertices) + edges[:, 1]
    order = order_of(keys, n_vertices**2)
    wanted = start * np.int64(n_vertices) + end
    if not len(order):
        return np.full(len(wanted), -1)
    at = order[np.searchsorted(keys[order], wanted).clip(max=len(keys) - 1)]
    return np.where(keys[at] == wanted, 3 * near[at // 3] + at % 3, -1)


def compacted(indices: IntArray, n: int) -> tuple[IntArray, IntArray]:
    """Give new numbers to what some indices below n name: the indices (k,), each once, ascending, and all new numbers.

    The same as `numpy.unique` with its inverse, without its sort.
    """
    is_used = np.zeros(n, bool)
    is_used[indices] = True
    used = np.flatnonzero(is_used)
    number = np.empty(n, np.int64)
    number[used] = np.arange(len(used))
    return used, number[indices]


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
