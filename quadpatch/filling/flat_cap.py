"""Plane patches over planar rims: the ends of tubes, cut-off bases.

A rim is projected onto the plane of its vector area, triangulated there by ear clipping (manifold3d), and refined to
the spacing of its vertices. All decisions are taken in the plane, so a patch has exactly the area that its rim encloses
there and never folds, and new vertices lie on the plane.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.refinement import Refined, flip_to_delaunay, refine
from quadpatch.filling.triangulation import EdgeSet
from quadpatch.mesh.normals import cross
from quadpatch.mesh.topology import directed_edges
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Wanted edge length in that of the rim: refinement splits rather too much, and in a plane there is no shape to follow.
# With 1.3 one of 100 round caps has an angle under 21.5 degrees, with 1 under 19.1.
_COARSENING = 1.3

# Rounds in which new vertices move; the smallest angle hardly changes after these.
_ROUNDS = 10

# Areas that differ by this share of a rim's own are equal.
_AREA_SLACK = 1e-9


@dataclass(frozen=True)
class _Plane:
    """A plane in space: `axes` (3, 3) holds two directions along it and its normal, which the patch faces."""

    origin: FloatArray
    axes: FloatArray

    def project(self, points: Vertices) -> FloatArray:
        """Coordinates (n, 2) in the plane."""
        return np.asarray((points - self.origin) @ self.axes[:2].T)

    def lift(self, flat: FloatArray) -> Vertices:
        """Points (n, 3) of the plane."""
        return np.asarray(self.origin + flat @ self.axes[:2])


def flat_caps(mesh: TriangleMesh, caps: Sequence[Sequence[IntArray]]) -> FilledMesh:
    """Close planar rims by plane patches.

    Parameters
    ----------
    mesh : TriangleMesh
    caps : list of lists of (n_loop,) int64
        The rims of each patch: the outer one first, then those that it leaves open within. Simple loops with the
        surface on their left, as `boundary_loops` gives them.

    Returns
    -------
    FilledMesh
        `unfilled` holds the positions of caps whose rims cross in their plane, or enclose no area there. Gap and rim
        turn are NaN: nothing is known of the true surface.
    """
    existing = _edges_between(mesh, caps)
    vertices, triangles, vertex_hole, triangle_hole = [mesh.vertices], [mesh.triangles], [], []
    unfilled, n_vertices = [], len(mesh.vertices)
    for i, loops in enumerate(caps):
        patch = _cap(mesh.vertices, loops, existing)
        if patch is None:
            unfilled.append(i)
            continue
        new, corners = patch
        rim = np.concatenate(loops)
        to_mesh = np.concatenate([rim, n_vertices + np.arange(len(new))])
        vertices.append(new)
        triangles.append(to_mesh[corners])
        vertex_hole += [i] * len(new)
        triangle_hole += [i] * len(corners)
        n_vertices += len(new)
        existing = np.concatenate([existing, directed_edges(triangles[-1])])
    unknown = np.full(len(caps), np.nan)
    return FilledMesh(
        TriangleMesh(np.concatenate(vertices), np.concatenate(triangles)),
        len(mesh.vertices),
        len(mesh.triangles),
        np.array(triangle_hole, np.int64),
        np.array(vertex_hole, np.int64),
        unknown,
        unknown,
        unfilled,
    )


def _edges_between(mesh: TriangleMesh, caps: Sequence[Sequence[IntArray]]) -> IntArray:
    """Edges (n, 2) of the mesh whose ends both lie on rims."""
    on_rim = np.zeros(len(mesh.vertices), bool)
    for loops in caps:
        on_rim[np.concatenate(loops)] = True
    edges = directed_edges(mesh.triangles[on_rim[mesh.triangles].sum(axis=1) >= 2])
    return edges[on_rim[edges].all(axis=1)]


def _cap(vertices: Vertices, loops: Sequence[IntArray], existing: IntArray) -> tuple[Vertices, Triangles] | None:
    """Close the rims of one cap: its new vertices (n, 3), and triangles of the rims' vertices followed by the new."""
    rim = np.concatenate(loops)
    plane = _plane_of(vertices, loops)
    if plane is None:
        return None
    flat = plane.project(vertices[rim])
    triangles = _triangulate(flat, [len(loop) for loop in loops])
    if triangles is None:
        return None
    spacing = _COARSENING * np.concatenate([_spacing(vertices[loop]) for loop in loops])
    patch = Refined(_as_3d(flat), triangles, np.zeros(len(triangles), np.int64), spacing, len(rim))
    existing_edges = EdgeSet(_local_edges(rim, existing))
    patch = _relaxed(
        refine(_without_chords(patch, existing_edges, [len(loop) for loop in loops]), existing_edges), existing_edges
    )
    return plane.lift(patch.vertices[len(rim) :, :2]), patch.triangles


def _plane_of(vertices: Vertices, loops: Sequence[IntArray]) -> _Plane | None:
    """Find the plane of the rims, facing away from the surface; None where they enclose no area."""
    rim = np.concatenate(loops)
    origin = vertices[rim].mean(axis=0)
    parts = [cross(vertices[loop] - origin, np.roll(vertices[loop], -1, axis=0) - origin) for loop in loops]
    vector_area = -np.concatenate(parts).sum(axis=0)
    size = np.linalg.norm(vector_area)
    if not size > 0:
        return None
    normal = vector_area / size
    # The axis that is closest to the plane gives a first direction in it.
    first = np.eye(3)[np.abs(normal).argmin()]
    first -= (first @ normal) * normal
    first /= np.linalg.norm(first)
    return _Plane(origin, np.stack([first, np.cross(normal, first), normal]))


def _triangulate(flat: FloatArray, counts: list[int]) -> Triangles | None:
    """Triangulate rims (n, 2), laid end to end, without new vertices; None where they cross."""
    import manifold3d  # noqa: PLC0415  most repairs have no flat cap

    # A patch runs along its rims the other way than the surface does.
    turned = [np.arange(end - 1, end - 1 - count, -1) for count, end in zip(counts, np.cumsum(counts), strict=True)]
    found = manifold3d.triangulate([np.ascontiguousarray(flat[part]) for part in turned], allow_convex=False)
    triangles = np.concatenate(turned)[np.asarray(found, np.int64).reshape(-1, 3)]
    if len(triangles) != len(flat) + 2 * (len(counts) - 1) - 2:
        return None
    areas = _areas(flat, triangles)
    enclosed = sum(_areas_of_polygon(flat[part]) for part in turned)
    if (areas < -_AREA_SLACK * enclosed).any():
        return None
    return triangles


def _areas(flat: FloatArray, triangles: Triangles) -> FloatArray:
    """Signed areas (m,) of triangles in the plane."""
    a, b, c = (flat[triangles[:, k], :2] for k in range(3))
    return np.asarray(((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2)


def _areas_of_polygon(flat: FloatArray) -> float:
    x, y = flat.T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


def _spacing(points: Vertices) -> FloatArray:
    """Mean length (n,) of the two rim edges at each vertex."""
    lengths = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    return np.asarray((lengths + np.roll(lengths, 1)) / 2)


def _as_3d(flat: FloatArray) -> Vertices:
    return np.concatenate([flat, np.zeros((len(flat), 1))], axis=1)


def _local_edges(rim: IntArray, existing: IntArray) -> IntArray:
    """Edges (n, 2) that exist between vertices of a rim already, by their positions on it."""
    ends = existing[np.isin(existing, rim).all(axis=1)]
    order = np.argsort(rim)
    return np.asarray(order[np.searchsorted(rim, ends, sorter=order)])


def _without_chords(patch: Refined, existing_edges: EdgeSet, counts: list[int]) -> Refined:
    """Split chords along edges that exist already, which would give those a third face, in their middles."""
    n, starts = len(patch.vertices), np.cumsum(counts) - counts
    after = np.arange(n) + 1
    after[starts + counts - 1] = starts
    edges = np.sort(directed_edges(patch.triangles), axis=1)
    on_rim = EdgeSet(np.stack([np.arange(n), after], axis=1))
    chords = np.unique(edges[existing_edges.contains(edges) & ~on_rim.contains(edges)], axis=0)
    for a, b in chords.tolist():
        patch = _split(patch, a, b)
    return patch


def _split(patch: Refined, a: int, b: int) -> Refined:
    """Put a vertex into the middle of an edge."""
    has_both = (patch.triangles == a).any(axis=1) & (patch.triangles == b).any(axis=1)
    new = len(patch.vertices)
    halves = [np.where(patch.triangles[has_both] == end, new, patch.triangles[has_both]) for end in (a, b)]
    hole = patch.hole[has_both]
    return replace(
        patch,
        vertices=np.concatenate([patch.vertices, patch.vertices[[a, b]].mean(axis=0)[None]]),
        triangles=np.concatenate([patch.triangles[~has_both], *halves]),
        hole=np.concatenate([patch.hole[~has_both], hole, hole]),
        spacing=np.append(patch.spacing, patch.spacing[[a, b]].mean()),
    )


def _relaxed(patch: Refined, existing_edges: EdgeSet) -> Refined:
    """Move new vertices to the centroids of the triangles around them and flip edges, in turns.

    L. Chen, "Mesh smoothing schemes based on optimal Delaunay triangulations", International Meshing Roundtable 2004:
    in the plane, centroids give better shapes than the mean of the neighbours.
    """
    if not patch.is_new.any():
        return patch
    for _ in range(_ROUNDS):
        patch = flip_to_delaunay(replace(patch, vertices=_moved(patch, _centroids(patch))), existing_edges)
    return patch


def _centroids(patch: Refined) -> Vertices:
    """Centroid (n, 3) of the triangles around each vertex."""
    corners, n = patch.triangles.ravel(), len(patch.vertices)
    areas = np.abs(_areas(patch.vertices, patch.triangles))
    moments = np.repeat(areas[:, None] * patch.vertices[patch.triangles].mean(axis=1), 3, axis=0)
    area_sums = np.bincount(corners, np.repeat(areas, 3), minlength=n)
    sums = np.stack([np.bincount(corners, moments[:, k], minlength=n) for k in range(3)], axis=1)
    return np.asarray(sums / np.maximum(area_sums, 1e-300)[:, None])


def _moved(patch: Refined, target: Vertices) -> Vertices:
    """Move new vertices where that turns no triangle over: in a bay of the rim, the mean may lie outside."""
    moves: BoolArray = patch.is_new.copy()
    while True:
        vertices = np.where(moves[:, None], target, patch.vertices)
        turned = patch.triangles[_areas(vertices, patch.triangles) <= 0]
        if not moves[turned].any():
            return vertices
        moves[turned] = False
