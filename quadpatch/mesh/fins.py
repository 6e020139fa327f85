"""Fins: small scraps of surface that hang on an edge which has two faces without them.

A scan of several views, or a careless union, leaves them behind. The mesh is cut at the edges of three faces and more;
a small component with a free boundary that hangs on such edges is a fin, if the surface is manifold there without it.
Where the surface itself has but one other face at such an edge, the component that continues it most evenly is surface.
Sheets that meet in one edge, none of them small, are no fins: their rims stay non-manifold.
"""

import numpy as np

from quadpatch.mesh.edge_groups import EdgeGroups, group_edges
from quadpatch.mesh.topology import components
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# A fin has at most this share of its piece's faces, and at most so many: a larger scrap may be what the scan is about.
_SHARE, _MOST = 0.01, 200
# In a coarse mesh, one or two faces are more than that.
_SHARE_OF_FEW, _FEW = 0.05, 2


def fin_triangles(vertices: Vertices, triangles: Triangles) -> BoolArray:
    """Find the triangles of fins.

    Parameters
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64
        Welded, without repeated ones.

    Returns
    -------
    (m,) bool
        The same whatever the order of the triangles.
    """
    nothing = np.zeros(len(triangles), dtype=bool)
    if not len(triangles):
        return nothing
    groups = group_edges(triangles, len(vertices))
    if groups.count.max() < 3:
        return nothing
    scrap = components(groups.pairs // 3, len(triangles))
    is_fin = _small_and_free(groups, scrap)
    # Directed edges of crowded edges, in groups.
    crowded = groups.order[np.repeat(groups.count > 2, groups.count)]
    _keep_unresolved(is_fin, scrap[crowded // 3], groups.edge[crowded])
    flatness = _Flatness(vertices, triangles, groups)
    for edge in _by_position(vertices, groups, np.unique(groups.edge[crowded])).tolist():
        _keep_continuation(is_fin, scrap, groups, edge, flatness)
    return is_fin[scrap]


def _small_and_free(groups: EdgeGroups, scrap: IntArray) -> BoolArray:
    """Components that may be fins as far as their size and their edges tell, (n_scraps,) bool."""
    n_scraps = int(scrap.max()) + 1
    size = np.bincount(scrap, minlength=n_scraps)
    triangle = groups.order // 3
    same = groups.edge[groups.order[1:]] == groups.edge[groups.order[:-1]]
    piece = components(np.stack([triangle[:-1][same], triangle[1:][same]], axis=1), len(scrap))
    piece_size = np.zeros(n_scraps, np.int64)
    piece_size[scrap] = np.bincount(piece)[piece]
    few = np.minimum(_FEW, _SHARE_OF_FEW * piece_size)
    limit = np.maximum(np.minimum(_MOST, _SHARE * piece_size), few)
    faces = groups.count[groups.edge].reshape(-1, 3)
    is_free, is_hanging = np.zeros(n_scraps, dtype=bool), np.zeros(n_scraps, dtype=bool)
    is_free[scrap[(faces == 1).any(axis=1)]] = True
    is_hanging[scrap[(faces > 2).any(axis=1)]] = True
    return np.asarray((size <= limit) & is_free & is_hanging)


def _keep_unresolved(is_fin: BoolArray, scrap: IntArray, edge: IntArray) -> None:
    """Strike the candidates at edges that would have three faces even without all of them.

    Parameters
    ----------
    is_fin : (n_scraps,) bool
        Changed in place.
    scrap, edge : (k,) int64
        Component and edge of every directed edge on a crowded edge.
    """
    while True:
        remaining = np.bincount(edge[~is_fin[scrap]], minlength=int(edge.max()) + 1)
        wrong = (remaining[edge] > 2) & is_fin[scrap]
        if not wrong.any():
            return
        is_fin[scrap[wrong]] = False


class _Flatness:
    """How evenly one face continues another one over an edge."""

    def __init__(self, vertices: Vertices, triangles: Triangles, groups: EdgeGroups) -> None:
        self._vertices, self._triangles, self._groups = vertices, triangles, groups

    def sort_key(self, directed: int, other: int) -> tuple[bool, float, tuple[float, ...]]:
        """Rank the face of one directed edge as continuation of the face of another one; the highest is best."""
        edges = self._groups.edges
        agrees = bool(edges[directed, 0] == edges[other, 1])
        apex, away = self._away(directed)
        _, back = self._away(other)
        return agrees, round(-float(away @ back), 9), tuple(apex.tolist())

    def _away(self, directed: int) -> tuple[FloatArray, FloatArray]:
        """Third corner of a face, and the unit vector in its plane that leads away from one of its edges."""
        start, end = self._vertices[self._groups.edges[directed]]
        apex = self._vertices[self._triangles[directed // 3, directed % 3 - 1]]
        along = end - start
        across = (apex - start) * float(along @ along) - along * float(along @ (apex - start))
        length = float(np.linalg.norm(across))
        return apex, across / length if length > 0 else across


def _by_position(vertices: Vertices, groups: EdgeGroups, edges: IntArray) -> IntArray:
    """Sort edges by the position of their middle, so that the result is the same whatever the file's order."""
    middles = vertices[groups.ends()[edges]].sum(axis=1)
    return edges[np.lexsort(middles.T)]


def _keep_continuation(is_fin: BoolArray, scrap: IntArray, groups: EdgeGroups, edge: int, flatness: _Flatness) -> None:
    """Where one face would be left at a crowded edge, keep the candidate that continues it best."""
    start = groups.starts[edge]
    here = groups.order[start : start + groups.count[edge]]
    kept = here[~is_fin[scrap[here // 3]]]
    if len(kept) != 1:
        return
    candidates = [e for e in here.tolist() if is_fin[scrap[e // 3]] and _has_room(is_fin, scrap, groups, e // 3)]
    if candidates:
        best = max(candidates, key=lambda e: flatness.sort_key(e, int(kept[0])))
        is_fin[scrap[best // 3]] = False


def _has_room(is_fin: BoolArray, scrap: IntArray, groups: EdgeGroups, triangle: int) -> bool:
    """Whether no edge gets a third face when the component of a triangle is kept."""
    own = np.flatnonzero(scrap == scrap[triangle])
    edges, added = np.unique(groups.edge.reshape(-1, 3)[own], return_counts=True)
    for edge, n_added in zip(edges.tolist(), added.tolist(), strict=True):
        start = groups.starts[edge]
        here = groups.order[start : start + groups.count[edge]]
        if n_added + int((~is_fin[scrap[here // 3]]).sum()) > 2:
            return False
    return True
