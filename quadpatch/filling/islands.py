"""Islands: loose pieces of surface that lie in a hole.

An island that faces the way of the surface around its hole belongs to that surface: what is missing is the ring
between two rims. The rims are joined by an edge that is walked there and back, as is usual for polygons with holes:
that makes one loop of them.
"""

from collections.abc import Set
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.filling.bridges import Bridge, Refusal
from quadpatch.mesh.holes import Hole
from quadpatch.mesh.loops import by_length, laid_out
from quadpatch.mesh.normals import cross, length, normals_at
from quadpatch.mesh.pieces import find_pieces
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices

# Least cosine between the normals at both rims.
LEAST_AGREEMENT = 0.5
# An island may lie so far above or below the rim of its hole, in diameters of the hole.
MOST_HEIGHT = 0.15
# Of the holes that one island lies in, one around the other; the facts of a mesh hold no more.
MOST_HOSTS = 16
# Corners of islands that are compared with edges of a rim at once, at most.
_PAIRS_AT_A_TIME = 1_000_000


@dataclass(frozen=True)
class JoinedRims:
    """Rims to be filled, islands included.

    Attributes
    ----------
    loops : list of (n_loop,) int64
        One for each chosen hole that is no island, longest rim first, and behind them those around bridges; an edge to
        an island, or across the gap of a bridge, is walked twice, so its vertices come twice.
    chosen : list of Hole
        Whose loops these are.
    host_of : dict of int to int
        Id of the hole that each island was joined to, by the id of the island's own border.
    bridges : dict of int to Bridge
        By the id of the loop among `chosen` that the bridge starts from.
    refused : dict of int to (str, str)
        Loops that were to be joined by a bridge and can't be, by id: a stable code, and a sentence for people.
    """

    loops: list[IntArray]
    chosen: list[Hole]
    host_of: dict[int, int]
    bridges: dict[int, Bridge] = field(default_factory=dict)
    refused: dict[int, Refusal] = field(default_factory=dict)


def join_islands(
    mesh: TriangleMesh, holes: list[Hole], chosen: list[Hole], bridged: Set[int] = frozenset()
) -> JoinedRims:
    """Join the borders of islands to the rims of the holes that they lie in.

    Parameters
    ----------
    mesh : TriangleMesh
    holes : list of Hole
        All of the mesh.
    chosen : list of Hole
        Those that are to be filled.
    bridged : set of int
        Ids of loops that are joined otherwise.
    """
    found = hosts_of(mesh, holes, chosen, most=1)
    host_of = {island: hosts[0] for island, hosts in found.items() if island not in bridged}
    islands: dict[int, list[IntArray]] = {}
    for island, host in host_of.items():
        islands.setdefault(host, []).append(holes[island].loop)
    # The quad mesh depends on the order of the vertices: how holes are numbered must not decide what the model makes.
    other_holes = sorted((hole for hole in chosen if hole.id not in host_of), key=lambda hole: -hole.perimeter)
    loops = [loop_around(mesh.vertices, hole.loop, islands.get(hole.id, [])) for hole in other_holes]
    return JoinedRims(loops, other_holes, host_of)


def hosts_of(mesh: TriangleMesh, holes: list[Hole], hosts: list[Hole], most: int = MOST_HOSTS) -> dict[int, list[int]]:
    """Find the holes that islands lie in.

    Parameters
    ----------
    mesh : TriangleMesh
    holes : list of Hole
        All of the mesh, by id.
    hosts : list of Hole
        Those of them in which islands are looked for.
    most : int
        For each island, the narrowest hosts, at most so many.

    Returns
    -------
    dict of int to list of int
        Ids of the hosts, the narrowest first, by the id of the island's border; the first that is filled is the one
        that it is joined to.
    """
    if len(holes) < 2 or not hosts:
        return {}
    centres = loop_centres(mesh.vertices, [hole.loop for hole in holes])
    tree, diameters = cKDTree(centres), np.array([hole.diameter for hole in holes])
    ids = np.array([hole.id for hole in hosts])
    # Most holes have no other loop near them.
    n_near = tree.query_ball_point(centres[ids], diameters[ids] / 2, return_length=True)
    hosts = [hosts[i] for i in np.flatnonzero(n_near > 1).tolist()]
    is_open = np.array([hole.is_manifold for hole in holes])
    found: dict[int, list[int]] = {}
    sides: _Sides | None = None
    # Host by host: of thousands of loops one around the other, all pairs at once would not fit into memory.
    for hole in sorted(hosts, key=lambda hole: hole.diameter):
        near = np.sort(np.array(tree.query_ball_point(centres[hole.id], hole.diameter / 2), np.int64))
        near = near[is_open[near] & (diameters[near] < hole.diameter)]
        if not len(near):
            continue
        sides = sides or _Sides.of(mesh, holes, centres)
        for island in near[sides.may_lie_in(hole.id, near)].tolist():
            if _lies_in(mesh.vertices, sides.normals[hole.id], hole.loop, holes[island].loop):
                found.setdefault(island, []).append(hole.id)
                is_open[island] = len(found[island]) < most
    return found


@dataclass(frozen=True)
class _Sides:
    """Which way loops face and run.

    Attributes
    ----------
    piece : (n,) int64
        Connected piece of the mesh that each loop belongs to.
    normals : (n, 3) float64
        Mean normal at each loop; not of unit length.
    areas : (n, 3) float64
        Vector area of each loop, twice.
    """

    piece: IntArray
    normals: FloatArray
    areas: FloatArray

    @classmethod
    def of(cls, mesh: TriangleMesh, holes: list[Hole], centres: FloatArray) -> "_Sides":
        counts = np.array([len(hole.loop) for hole in holes])
        at_rims = normals_at(mesh.vertices, mesh.triangles, np.concatenate([hole.loop for hole in holes]))
        means = np.add.reduceat(at_rims, np.cumsum(counts) - counts, axis=0) / counts[:, np.newaxis]
        return cls(
            find_pieces(mesh, []).of_vertex[[hole.loop[0] for hole in holes]],
            means,
            loop_vector_areas(mesh.vertices, [hole.loop for hole in holes], centres),
        )

    def may_lie_in(self, rim: int, islands: IntArray) -> BoolArray:
        """Whether islands (n,) belong to other pieces, face the way of a rim, and run as islands do."""
        own, others = self.normals[rim], self.normals[islands]
        sizes = np.linalg.norm(own) * np.linalg.norm(others, axis=1)
        agree = (others @ own > LEAST_AGREEMENT * sizes) & (sizes > 0)
        # A rim runs clockwise around its hole, the border of an island counter-clockwise around its surface.
        runs_rightly = (self.areas[rim] @ own < 0) & (self.areas[islands] @ own > 0)
        return np.asarray(agree & runs_rightly & (self.piece[islands] != self.piece[rim]))


def loop_centres(vertices: Vertices, loops: list[IntArray]) -> FloatArray:
    """Mean of the vertices of each loop, (n_loops, 3)."""
    points, centres = vertices[np.concatenate(loops)], np.zeros((len(loops), 3))
    for members, places in by_length(laid_out(loops)[0]):
        centres[members] = points[places].mean(axis=1)
    return centres


def loop_vector_areas(vertices: Vertices, loops: list[IntArray], centres: FloatArray) -> FloatArray:
    """Vector area of each loop, twice: (n_loops, 3)."""
    points, areas = vertices[np.concatenate(loops)], np.zeros((len(loops), 3))
    for members, places in by_length(laid_out(loops)[0]):
        spokes = points[places] - centres[members][:, np.newaxis]
        areas[members] = cross(spokes, np.roll(spokes, -1, axis=1)).sum(axis=1)
    return areas


def _lies_in(vertices: Vertices, normal: FloatArray, rim: IntArray, island: IntArray) -> bool:
    """Whether an island lies within a rim, seen along the rim's normal, and near its height."""
    centre = vertices[rim].mean(axis=0)
    z = normal / np.linalg.norm(normal)
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    axes = np.stack([x / np.linalg.norm(x), np.cross(z, x / np.linalg.norm(x)), z], axis=1)
    outer, inner = (vertices[rim] - centre) @ axes, (vertices[island] - centre) @ axes
    slack = MOST_HEIGHT * float(np.linalg.norm(np.ptp(outer, axis=0)))
    level = (inner[:, 2] > outer[:, 2].min() - slack) & (inner[:, 2] < outer[:, 2].max() + slack)
    return bool(level.all() and _is_inside(outer[:, :2], inner[:, :2]).all())


def _is_inside(polygon: FloatArray, points: FloatArray) -> BoolArray:
    """Whether points (n, 2) lie inside a polygon (k, 2), by the parity of the edges to the right of them."""
    n_parts = 1 + len(points) * len(polygon) // _PAIRS_AT_A_TIME
    return np.concatenate([_has_odd_parity(polygon, part) for part in np.array_split(points, n_parts)])


def _has_odd_parity(polygon: FloatArray, points: FloatArray) -> BoolArray:
    start, end = polygon[None], np.roll(polygon, -1, axis=0)[None]
    spans = (start[..., 1] > points[:, None, 1]) != (end[..., 1] > points[:, None, 1])
    rise = np.where(spans, end[..., 1] - start[..., 1], 1.0)
    at = start[..., 0] + (points[:, None, 1] - start[..., 1]) / rise * (end[..., 0] - start[..., 0])
    inside: BoolArray = (spans & (at > points[:, None, 0])).sum(axis=1) % 2 == 1
    return inside


def loop_around(vertices: Vertices, rim: IntArray, islands: list[IntArray]) -> IntArray:
    """Join a rim to islands by short edges: (n_rim + n_islands + 2 per island,) int64.

    The nearest island comes first, as in the algorithm of Prim: the edge to another one may start at it, and would
    run through it otherwise.
    """
    if not islands:
        return rim
    members = np.concatenate(islands)
    owner = np.repeat(np.arange(len(islands)), [len(island) for island in islands])
    starts = np.searchsorted(owner, np.arange(len(islands)))
    waiting = np.ones(len(members), bool)
    loop, joined, gap = rim, rim, np.full(len(members), np.inf)
    while waiting.any():
        gap = np.minimum(gap, cKDTree(vertices[joined]).query(vertices[members])[0])
        at = int(np.where(waiting, gap, np.inf).argmin())
        joined = islands[owner[at]]
        j = at - int(starts[owner[at]])
        waiting &= owner != owner[at]
        i = _nearest_free(vertices, loop, members[at])
        loop = np.concatenate([loop[: i + 1], np.roll(joined, -j), joined[j : j + 1], loop[i:]])
    return loop


def _nearest_free(vertices: Vertices, loop: IntArray, other: int) -> int:
    """Find the position in a loop next to a vertex, where no other edge begins: the order of two would be open."""
    distance = length(vertices[loop] - vertices[other])
    _, position, count = np.unique(loop, return_inverse=True, return_counts=True)
    free = count[position] == 1
    return int(np.where(free if free.any() else True, distance, np.inf).argmin())
