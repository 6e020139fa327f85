"""Minimum-weight triangulation of boundary loops.

Among all triangulations of a loop, dynamic programming finds the one whose largest dihedral angle, with the surface
around the hole counted in, is smallest; equal ones are told apart by their area. The table costs O(n^3) for a loop of n
vertices, so a long loop is divided by chords first (`quadpatch.filling.division`).

References
----------
P. Liepa, "Filling Holes in Meshes", Eurographics Symposium on Geometry Processing, 2003.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from quadpatch.filling.division import RimLoop, divide
from quadpatch.filling.weight_table import best_triangulations
from quadpatch.mesh.loops import by_length, laid_out
from quadpatch.mesh.topology import directed_edges, edge_keys
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Loops of more vertices are divided.
MAX_TABLE_SIZE = 128


@dataclass(frozen=True)
class Forbidden:
    """What a triangulation may not contain.

    Attributes
    ----------
    edges : EdgeSet
        Edges that exist already: a chord along one of them would give it a third face. Others may be forbidden, too.
    triangles : (k, 3) int64
        Vertices of triangles, in any order.
    """

    edges: "EdgeSet"
    triangles: Triangles = field(default_factory=lambda: np.zeros((0, 3), np.int64))

    def with_edges(self, edges: IntArray) -> "Forbidden":
        """Add edges (n, 2) to a copy."""
        return replace(self, edges=self.edges.with_edges(edges))

    def contains(self, first: IntArray, second: IntArray, third: IntArray) -> BoolArray:
        """Whether each triangle, by its corners (broadcast against each other), is forbidden."""
        found = np.zeros(np.broadcast_shapes(first.shape, second.shape, third.shape), bool)
        corners = np.stack(np.broadcast_arrays(first, second, third), axis=-1)
        possible = np.isin(corners, self.triangles).all(axis=-1)
        found[possible] = np.isin(_sorted_rows(corners[possible]), _sorted_rows(self.triangles))
        return found


def _sorted_rows(triangles: Triangles) -> np.ndarray[tuple[int], np.dtype[np.void]]:
    """One value (n,) for the three vertices of each triangle (n, 3), whatever their order."""
    rows = np.ascontiguousarray(np.sort(triangles, axis=1))
    return rows.view([("", np.int64)] * 3).ravel()


def triangulate_loops(
    loops: list[IntArray], vertices: Vertices, rim_normals: list[FloatArray], forbidden: Forbidden
) -> list[Triangles | None]:
    """Triangulate boundary loops without new vertices.

    Parameters
    ----------
    loops : list of (n_loop,) int64
        With the surface on the left of each loop; the triangles close it from the other side.
    vertices : (n_vertices, 3) float64
    rim_normals : list of (n_loop, 3) float64
        Unit normal of the face at each rim edge, from loop vertex i to i + 1.
    forbidden : Forbidden

    Returns
    -------
    list of (n_loop - 2, 3) int64 or None
        Vertex indices; None where every triangulation would contain what is forbidden.
    """
    found = _triangulate(loops, vertices, rim_normals, forbidden)
    # Two holes with two corners in common may want the same chord; the later one has to do without.
    members = np.concatenate([np.zeros(0, np.int64), *loops])
    owner = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    for i in _clashing(found):
        near = np.unique(owner[np.isin(members, loops[i])]).tolist()
        others = [directed_edges(t) for j, t in ((j, found[j]) for j in near if j != i) if t is not None]
        edges = forbidden.edges.among(loops[i]).with_edges(np.concatenate([np.zeros((0, 2), np.int64), *others]))
        found[i] = _triangulate([loops[i]], vertices, [rim_normals[i]], replace(forbidden, edges=edges))[0]
    return found


def _triangulate(
    loops: list[IntArray], vertices: Vertices, rim_normals: list[FloatArray], forbidden: Forbidden
) -> list[Triangles | None]:
    """Triangulate every loop for itself."""
    # Without islands, which are few, no loop passes a vertex twice.
    joining = [_joining_edges(loop) for loop in loops if len(set(loop.tolist())) < len(loop)]
    forbidden = forbidden.with_edges(np.concatenate(joining)) if joining else forbidden
    rims = [RimLoop(loop, normals) for loop, normals in zip(loops, rim_normals, strict=True)]
    parts = [divide(rim, vertices, MAX_TABLE_SIZE, forbidden.edges.contains) for rim in rims]
    flat = [part for of_loop in parts for part in of_loop]
    found = iter(_by_length([p.vertices for p in flat], vertices, [p.normals for p in flat], forbidden))
    pieces = [[next(found) for _ in of_loop] for of_loop in parts]
    return [_joined(p) for p in pieces]


def _joining_edges(loop: IntArray) -> IntArray:
    """Edges (k, 2) that no chord of a loop may repeat: those that join its rims, and those from a vertex to itself."""
    twice = np.unique(loop, return_counts=True)
    ends = twice[0][twice[1] > 1]
    edges = np.stack([loop, np.roll(loop, -1)], axis=1)
    return np.concatenate([edges[np.isin(edges, ends).all(axis=1)], np.stack([ends, ends], axis=1)])


def _joined(parts: list[Triangles | None]) -> Triangles | None:
    """Put the triangulation of a loop together; None where a part is missing, or an edge has three triangles."""
    found = [part for part in parts if part is not None]
    if not found or len(found) < len(parts):
        return None
    triangles = found[0] if len(found) == 1 else np.concatenate(found)
    if len(found) == 1 and len(set(triangles.ravel().tolist())) == len(triangles) + 2:
        # No vertex comes twice: chords that do not cross are all different.
        return triangles
    edges = np.sort(directed_edges(triangles), axis=1)
    return triangles if np.unique(edges, axis=0, return_counts=True)[1].max() <= 2 else None


def _clashing(found: list[Triangles | None]) -> list[int]:
    """Positions of triangulations with a chord that an earlier one has."""
    owned = [(i, triangles) for i, triangles in enumerate(found) if triangles is not None]
    if not owned:
        return []
    owner = np.repeat([i for i, _ in owned], [3 * len(triangles) for _, triangles in owned])
    edges = directed_edges(np.concatenate([triangles for _, triangles in owned]))
    keys = edge_keys(edges, int(edges.max()) + 1)
    # The sort is stable, so the first of several equal keys is that of the first owner.
    _, first, of_edge = np.unique(keys, return_index=True, return_inverse=True)
    return [int(i) for i in np.unique(owner[owner != owner[first[of_edge]]])]


def _by_length(
    loops: list[IntArray], vertices: Vertices, rim_normals: list[FloatArray], forbidden: Forbidden
) -> list[Triangles | None]:
    """Triangulate loops in batches of one length."""
    if not loops:
        return []
    result: list[Triangles | None] = [None] * len(loops)
    laid, laid_normals = np.concatenate(loops), np.concatenate(rim_normals)
    for members, places in by_length(laid_out(loops)[0]):
        batch = laid[places]
        corners, finite = _minimum_weight(vertices[batch], laid_normals[places], batch, forbidden)
        triangles = batch[np.arange(len(batch))[:, np.newaxis, np.newaxis], corners]
        for row in np.flatnonzero(finite).tolist():
            result[members[row]] = triangles[row]
    return result


class EdgeSet:
    """Undirected edges of a mesh among some vertices, for "does this edge exist?" in bulk."""

    def __init__(self, edges: IntArray) -> None:
        # Faster by far than `numpy.unique`, which hashes.
        keys = np.sort(self._key(edges))
        self._keys = keys[np.diff(keys, prepend=-1) != 0]

    def with_edges(self, edges: IntArray) -> "EdgeSet":
        """Add edges (n, 2) to a copy of the set."""
        return EdgeSet(np.concatenate([np.stack([self._keys >> 32, self._keys & 0xFFFFFFFF], axis=1), edges]))

    def among(self, vertices: IntArray) -> "EdgeSet":
        """Leave out edges with an end that is none of some vertices (n,)."""
        edges = np.stack([self._keys >> 32, self._keys & 0xFFFFFFFF], axis=1)
        return EdgeSet(edges[np.isin(edges, vertices).all(axis=1)])

    def contains(self, edges: IntArray) -> BoolArray:
        """Whether each edge (..., 2) is in the set."""
        keys = self._key(edges)
        at = np.searchsorted(self._keys, keys).clip(0, max(len(self._keys) - 1, 0))
        return self._keys[at] == keys if len(self._keys) else np.zeros(keys.shape, bool)

    def chords(self, loops: IntArray) -> BoolArray:
        """Pairs (b, n, n) of loop vertices (b, n), not neighbours on the loop, that an edge joins already."""
        n = loops.shape[1]
        joined = self.contains(np.stack(np.broadcast_arrays(loops[:, :, None], loops[:, None, :]), axis=-1))
        i = np.arange(n)
        joined[:, i, (i + 1) % n] = joined[:, (i + 1) % n, i] = joined[:, i, i] = False
        return joined

    @staticmethod
    def _key(edges: IntArray) -> IntArray:
        start, end = edges[..., 0], edges[..., 1]
        return (np.minimum(start, end) << 32) | np.maximum(start, end)


def _minimum_weight(
    points: FloatArray, rim_normals: FloatArray, loops: IntArray, forbidden: Forbidden
) -> tuple[IntArray, BoolArray]:
    """Triangulate b loops (b, n) of points (b, n, 3) at once: corners (b, n - 2, 3), whether each exists (b,)."""

    def is_forbidden(i: IntArray, k: IntArray, j: IntArray) -> BoolArray:
        return forbidden.contains(loops[:, i], loops[:, k], loops[:, j])

    chords = forbidden.edges.chords(loops)
    return best_triangulations(points, rim_normals, chords, is_forbidden if len(forbidden.triangles) else None)
