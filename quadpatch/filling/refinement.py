"""Refinement of a hole's triangulation to the density of the surface around it.

A triangle whose centroid lies far from its corners, compared with
the edge lengths at the rim, is split there; after every round, interior edges are flipped until they are locally
Delaunay. All holes are refined at once, so every step is one pass over arrays.

References
----------
P. Liepa, "Filling Holes in Meshes", Eurographics Symposium on Geometry Processing, 2003, section 4.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.filling.triangulation import EdgeSet
from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.normals import cross, length, triangle_normals, unit, vertex_normals
from quadpatch.mesh.smoothing import neighbour_average
from quadpatch.mesh.topology import edge_keys
from quadpatch.types import BoolArray, FloatArray, IntArray, Triangles, Vertices

# Liepa's density factor: larger gives more vertices. With his sqrt(2) a fill has fewer vertices than were lost (0.60 to
# 0.77 of them on scans) and an error 1 to 6 % higher; with 2 it has 1.4 to 2.0 times as many. Beyond, little changes.
DENSITY = 2.0

_MAX_ROUNDS = 24
_MAX_FLIP_PASSES = 40
# An edge counts as Delaunay while cot(alpha) + cot(beta) is above minus this.
_DELAUNAY_SLACK = 1e-9
# Flips that are asked to keep the surface from folding over leave a margin to `faults.FOLD_ANGLE_DEG`.
MOST_TURN_DEG = 135.0


# Grading: wanted edge lengths grow by this factor from vertex to vertex, up to this share of the hole's diameter. With
# them, energies rank as on uniform fills (errors in relation to the best differ by 1 % on scans), at a seventh of the
# vertices where holes are 42 edges wide.
_GROWTH = 1.5
_SHARE_OF_DIAMETER = 0.1


@dataclass(frozen=True)
class Grading:
    """Wanted edge lengths that grow from the rims into the holes: for fills that are measured and thrown away.

    Attributes
    ----------
    finest : (n_holes,) float64
        Mean at the rim, in mesh units.
    coarsest : (n_holes,) float64
        Where they stop to grow.
    """

    finest: FloatArray
    coarsest: FloatArray

    @classmethod
    def of(cls, spacing: FloatArray, vertices: Vertices, loops: list[IntArray]) -> "Grading | None":
        """Grade holes by the wanted edge lengths (n,) at their rims; None if none of them is large for its edges."""
        finest = np.array([spacing[loop].mean() for loop in loops], np.float64)
        extents = np.array([np.ptp(vertices[loop], axis=0) for loop in loops]).reshape(-1, 3)
        coarsest = np.maximum(_SHARE_OF_DIAMETER * length(extents), finest)
        return cls(finest, coarsest) if (coarsest > finest).any() else None

    def grown(self, spacing: FloatArray, hole: IntArray) -> FloatArray:
        """Wanted edge length (k,) at new vertices of some holes (k,) between corners of this mean (k,)."""
        return np.maximum(spacing, np.minimum(_GROWTH * spacing, self.coarsest[hole]))


@dataclass(frozen=True)
class Refined:
    """Triangulations of all holes, being refined.

    Attributes
    ----------
    vertices : (n, 3) float64
        Input vertices first; only those after them are ever added or moved.
    triangles : (m, 3) int64
    hole : (m,) int64
        Position of each triangle's hole in the list of loops.
    spacing : (n,) float64
        Wanted edge length at each vertex; 0 where no hole touches it.
    n_measured : int
        Count of input vertices.
    grading : Grading, optional
        Without, fills are as dense inside as at their rims.
    """

    vertices: Vertices
    triangles: Triangles
    hole: IntArray
    spacing: FloatArray
    n_measured: int
    grading: Grading | None = None

    @property
    def is_new(self) -> BoolArray:
        """(n,) bool, True = added by the refinement."""
        return np.arange(len(self.vertices)) >= self.n_measured


def refine(patch: Refined, existing_edges: EdgeSet, rim: Triangles | None = None, *, flip: bool = True) -> Refined:
    """Split and flip until every triangle is about as large as the surface around its hole is dense.

    Parameters
    ----------
    patch : Refined
    existing_edges : EdgeSet
    rim : (k, 3) int64, optional
        See `flip_to_delaunay`.
    flip : bool
        Without flips the surface stays where it is.
    """
    patch = flip_to_delaunay(patch, existing_edges, rim) if flip else patch
    for _ in range(_MAX_ROUNDS):
        large = _too_large(patch)
        if not large.any():
            break
        patch = _split_at_centroid(patch, large)
        patch = flip_to_delaunay(patch, existing_edges, rim) if flip else patch
    return patch


def _too_large(patch: Refined) -> BoolArray:
    corners = patch.vertices[patch.triangles]
    reach = DENSITY * length(corners - corners.mean(axis=1, keepdims=True))
    wanted = patch.spacing[patch.triangles]
    large: BoolArray = ((reach > wanted) & (reach > wanted.mean(axis=1, keepdims=True))).all(axis=1)
    return large


def _split_at_centroid(patch: Refined, large: BoolArray) -> Refined:
    a, b, c = patch.triangles[large].T
    new = len(patch.vertices) + np.arange(len(a))
    inner = np.concatenate([np.stack(t, axis=1) for t in ((a, b, new), (b, c, new), (c, a, new))])
    corners, hole = patch.triangles[large], patch.hole[large]
    spacing = patch.spacing[corners].mean(axis=1)
    if patch.grading is not None:
        spacing = patch.grading.grown(spacing, hole)
    return replace(
        patch,
        vertices=np.concatenate([patch.vertices, patch.vertices[corners].mean(axis=1)]),
        triangles=np.concatenate([patch.triangles[~large], inner]),
        hole=np.concatenate([patch.hole[~large], np.tile(hole, 3)]),
        spacing=np.concatenate([patch.spacing, spacing]),
    )


def relax(
    patch: Refined, adjacent_triangles: Triangles, existing_edges: EdgeSet, rim: Triangles | None = None
) -> Refined:
    """Slide new vertices along the surface to the mean of their neighbours, and flip again: better shaped triangles.

    Parameters
    ----------
    patch : Refined
    adjacent_triangles : (k, 3) int64
        Triangles of the input next to the holes.
    existing_edges : EdgeSet
    rim : (k, 3) int64, optional
        See `flip_to_delaunay`.
    """
    triangles = np.concatenate([adjacent_triangles, patch.triangles])
    mean = neighbour_average(triangles, len(patch.vertices)) @ patch.vertices
    normals = vertex_normals(patch.vertices, triangles)
    slide = mean - patch.vertices
    slide -= np.einsum("ij,ij->i", slide, normals)[:, None] * normals
    slide[~patch.is_new] = 0
    return flip_to_delaunay(replace(patch, vertices=patch.vertices + slide), existing_edges, rim)


def flip_to_delaunay(patch: Refined, existing_edges: EdgeSet, rim: Triangles | None = None) -> Refined:
    """Flip interior edges until all are locally Delaunay; each pass flips edges that share no triangle.

    Parameters
    ----------
    patch : Refined
    existing_edges : EdgeSet
        Edges that exist already.
    rim : (k, 3) int64, optional
        Triangles of the input next to the holes. With them, no flip makes a turn beyond `MOST_TURN_DEG` or makes one
        sharper.
    """
    triangles = patch.triangles.copy()
    active = np.arange(len(triangles))
    shared = _in_several_holes(patch)
    for _ in range(_MAX_FLIP_PASSES):
        part = triangles[active]
        flipped = _flip_once(part, patch.vertices, existing_edges, shared, rim)
        if not len(flipped):
            break
        triangles[active] = part
        # Edges of one hole never meet triangles of another: a hole without a flip is done.
        busy = np.zeros(int(patch.hole.max()) + 1, bool)
        busy[patch.hole[active[flipped]]] = True
        active = active[busy[patch.hole[active]]]
    return replace(patch, triangles=triangles)


def _in_several_holes(patch: Refined) -> BoolArray:
    """Vertices (n,) on the rims of more than one hole: another one may have the edge between two of them already."""
    last = np.zeros(len(patch.vertices), np.int64)
    last[patch.triangles] = patch.hole[:, None]
    shared = np.zeros(len(patch.vertices), bool)
    shared[patch.triangles[last[patch.triangles] != patch.hole[:, None]]] = True
    return shared


def _flip_once(
    triangles: Triangles, vertices: Vertices, existing_edges: EdgeSet, shared: BoolArray, rim: Triangles | None
) -> IntArray:
    """Flip, in place, edges that are not Delaunay, no two in one triangle; return the triangles that changed."""
    n_vertices = len(vertices)
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    keys = edge_keys(edges, n_vertices)
    order = np.argsort(keys, kind="stable")
    ranked = keys[order]
    twin = np.flatnonzero(ranked[1:] == ranked[:-1])
    left, right = order[twin], order[twin + 1]
    a, b = edges[left].T
    c, d = _opposite(triangles, left), _opposite(triangles, right)
    excess = _cotangent(vertices[a], vertices[c], vertices[b]) + _cotangent(vertices[a], vertices[d], vertices[b])
    bad = np.flatnonzero(excess < -_DELAUNAY_SLACK)
    bad = bad[np.argsort(excess[bad], kind="stable")]
    a, b, c, d, left, right = (row[bad] for row in (a, b, c, d, left, right))
    allowed = _is_unfolded(*(vertices[row] for row in (a, b, c, d))) & (c != d)
    allowed &= ~existing_edges.contains(np.stack([c, d], axis=1)) & ~(shared[c] & shared[d])
    crossing = edge_keys(np.stack([c, d], axis=1), n_vertices)
    allowed &= ranked[np.searchsorted(ranked, crossing).clip(max=max(len(ranked) - 1, 0))] != crossing
    if rim is not None:
        allowed &= _turns_little(np.concatenate([triangles, rim]), vertices, left, right)
    allowed[allowed] = _is_first_everywhere(left[allowed] // 3, right[allowed] // 3, len(triangles))
    first = np.unique(crossing[allowed], return_index=True)[1]
    chosen = np.flatnonzero(allowed)[first]
    a, b, c, d, left, right = (row[chosen] for row in (a, b, c, d, left // 3, right // 3))
    triangles[left] = np.stack([a, d, c], axis=1)
    triangles[right] = np.stack([d, b, c], axis=1)
    return np.concatenate([left, right])


def _opposite(triangles: Triangles, half_edges: IntArray) -> IntArray:
    corners: IntArray = triangles[half_edges // 3, (half_edges % 3 + 2) % 3]
    return corners


def _is_unfolded(a: Vertices, b: Vertices, c: Vertices, d: Vertices) -> BoolArray:
    """Whether the triangles (a, d, c) and (d, b, c), which the flip makes, look the same way."""
    unfolded: BoolArray = np.einsum("ij,ij->i", cross(d - a, c - a), cross(b - d, c - d)) > 0
    return unfolded


def _turns_little(triangles: Triangles, vertices: Vertices, left: IntArray, right: IntArray) -> BoolArray:
    """Whether flips (n,) keep the turns at their five edges within `MOST_TURN_DEG`, or below the sharpest before.

    Flips are given by the two directions of their edges, a to b in a triangle (a, b, c) and back in (b, a, d); edge
    ``3 t + k`` runs from corner k of triangle t.
    """
    groups = group_edges(triangles, len(vertices))
    normals = triangle_normals(vertices, triangles)

    def across(edges: IntArray, step: int) -> FloatArray:
        """Look up the normals beyond the edge that follows each edge in its triangle after so many steps."""
        edges = edges // 3 * 3 + (edges + step) % 3
        start = groups.starts[groups.edge[edges]]
        one, other = groups.order[start], groups.order[start + groups.count[groups.edge[edges]] - 1]
        return np.asarray(normals[np.where(one == edges, other, one) // 3])

    of_cb, of_ac, of_da, of_bd = across(left, 1), across(left, 2), across(right, 1), across(right, 2)
    (a, b), c, d = groups.edges[left].T, _opposite(triangles, left), _opposite(triangles, right)
    abc, bad = normals[left // 3], normals[right // 3]
    adc, dbc = (unit(cross(vertices[p] - vertices[d], vertices[q] - vertices[d])) for p, q in ((c, a), (b, c)))
    before = _least_cosine([(abc, bad), (abc, of_ac), (abc, of_cb), (bad, of_bd), (bad, of_da)])
    after = _least_cosine([(adc, dbc), (adc, of_ac), (adc, of_da), (dbc, of_cb), (dbc, of_bd)])
    return np.asarray(after >= np.minimum(before, np.cos(np.radians(MOST_TURN_DEG))))


def _least_cosine(pairs: list[tuple[FloatArray, FloatArray]]) -> FloatArray:
    return np.asarray(np.min([np.einsum("ij,ij->i", one, other) for one, other in pairs], axis=0))


def _is_first_everywhere(left: IntArray, right: IntArray, n_triangles: int) -> BoolArray:
    """Which of some edges, the most urgent first, come first in both of their triangles."""
    position = np.arange(len(left))
    rank = np.full(n_triangles, len(left))
    # Later writes win: in reverse order the most urgent edge of a triangle stays.
    rank[right[::-1]] = position[::-1]
    rank_left = np.full(n_triangles, len(left))
    rank_left[left[::-1]] = position[::-1]
    rank = np.minimum(rank, rank_left)
    first: BoolArray = (rank[left] == position) & (rank[right] == position)
    return first


def _cotangent(a: Vertices, apex: Vertices, b: Vertices) -> FloatArray:
    u, v = a - apex, b - apex
    cotangent: FloatArray = np.einsum("ij,ij->i", u, v) / np.maximum(length(cross(u, v)), 1e-300)
    return cotangent
