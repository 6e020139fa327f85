"""Bridges: strips of surface that join two boundary loops which face each other across a gap.

Both rims become one loop that runs around the strip, so that the strip is triangulated, refined, faired and checked
like every other fill. Where the rims face each other all around, as at a cut tube, an edge from one to the other is
walked there and back, as to an island. Where outer borders of two pieces face each other along a part of them only, as
at a torn sheet, a rib across the gap at either end of that stretch makes a hole of what lies between
(`quadpatch.filling.ribs`).
"""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.filling.facing import Facing, look_across
from quadpatch.filling.facing_stretches import facing_stretches
from quadpatch.filling.ribs import Rib, Ribs, RibSide, make_clear_rib
from quadpatch.mesh.holes import Hole
from quadpatch.mesh.normals import length
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Vertices
from quadpatch_rules.hole_selection import MAX_NEW_VERTICES

BridgeShape = Literal["ring", "strip"]

# The fill of a strip is as unsure as that of a hole so many times as wide as the gap: a strip is held at two sides, a
# disc all around. On bands taken out of scans, expected errors come out right by this (`benchmarks/bridges.py`).
WIDTH_OF_STRIP = 2.0
# Borders of which less than this share faces the other rim are joined along the stretch that does.
WHOLE_SHARE = 0.6
# The way from one rim to the other by an island between them is at most so many times as long as the straight one; the
# island lies this near to the tangent planes of both, in lengths of that way, and faces as they do (cosine).
_LONGEST_WAY = 1.5
_MOST_HEIGHT = 0.35
_LEAST_AGREEMENT = 0.5

# Why two loops can't be joined: a stable code, and a sentence for people.
Refusal = tuple[str, str]
_TOUCHING = "bridge_touches", "the two rims share a vertex: a strip between them would be pinched there"
_FLIPPED = (
    "bridge_flipped",
    "the two rims run the same way where they are nearest: the surface of one side is turned over against the other",
)
_APART = "bridge_apart", "the two rims face each other nowhere along three edges, or as far as the gap is wide"


@dataclass(frozen=True)
class Bridge:
    """Two loops that are joined.

    Attributes
    ----------
    holes : (Hole, Hole)
        In the order that was asked for; the strip counts with the first.
    loop : (n,) int64
        Runs around the strip, with the surface on its left.
    facing : Facing
    ribs : list of Rib
        At the ends of a strip; none where both loops are joined all around.
    """

    holes: tuple[Hole, Hole]
    loop: IntArray
    facing: Facing
    ribs: list[Rib] = field(default_factory=list)

    @property
    def shape(self) -> BridgeShape:
        """`ring`: both loops are closed by it; `strip`: a stretch of each is joined, and the rest stays open."""
        return "strip" if self.ribs else "ring"

    @property
    def gap(self) -> float:
        """Mean distance between the rims, in mesh units."""
        return self.facing.gap

    @property
    def width(self) -> float:
        """Diameter of the holes whose fills are as unsure as the strip, in mesh units."""
        return WIDTH_OF_STRIP * self.gap

    def has_between(self, points: Vertices, normals: FloatArray) -> bool:
        """Whether a loop lies in the gap and faces as the rims do, by its points (n, 3) and its normals (n, 3)."""
        ways = np.zeros(len(points))
        for rim, sight in zip(self.facing.rims, self.facing.sights, strict=True):
            if not sight.faces.any():
                return False
            seen = np.flatnonzero(sight.faces)
            distance, at = cKDTree(rim.points[seen]).query(points)
            at = seen[at]
            across = np.maximum(sight.distance[at], np.finfo(np.float64).tiny)
            height = np.abs(np.einsum("ij,ij->i", points - rim.points[at], rim.normals[at]))
            agreement = np.einsum("ij,ij->i", normals, rim.normals[at]).mean()
            if (height > _MOST_HEIGHT * across).any() or agreement < _LEAST_AGREEMENT:
                return False
            ways += distance / across
        return bool((ways <= _LONGEST_WAY).all())


def make_bridges(
    mesh: TriangleMesh, holes: list[Hole], pairs: list[tuple[int, int]]
) -> tuple[list[Bridge], dict[int, Refusal]]:
    """Join pairs of loops of a mesh.

    Parameters
    ----------
    mesh : TriangleMesh
    holes : list of Hole
        All of the mesh, by id.
    pairs : list of (int, int)
        Ids of loops with manifold rims, each named once.

    Returns
    -------
    bridges : list of Bridge
    refused : dict of int to (str, str)
        Loops that can't be joined, by id: a stable code and a sentence for people.
    """
    bridges, refused = list[Bridge](), dict[int, Refusal]()
    next_vertex = len(mesh.vertices)
    for first, second in pairs:
        made = make_bridge(mesh, holes[first], holes[second], next_vertex)
        if isinstance(made, Bridge):
            bridges.append(made)
            next_vertex += sum(len(rib.vertices) for rib in made.ribs)
        else:
            code, reason = made
            refused |= dict.fromkeys((first, second), (code, f"no bridge {first}:{second}: {reason}"))
    return bridges, refused


def ribs_of(bridges: list[Bridge]) -> Ribs:
    """Put the ribs of some bridges together, in their order."""
    owned = [(number, rib) for number, bridge in enumerate(bridges) for rib in bridge.ribs]
    owner = np.array([number for number, _ in owned], np.int64)
    vertices = np.concatenate([np.zeros((0, 3)), *(rib.vertices for _, rib in owned)])
    triangles = np.concatenate([np.zeros((0, 3), np.int64), *(rib.triangles for _, rib in owned)])
    n_vertices, n_triangles = (
        [len(rows) for rows in table]
        for table in ([rib.vertices for _, rib in owned], [rib.triangles for _, rib in owned])
    )
    return Ribs(vertices, triangles, np.repeat(owner, n_vertices), np.repeat(owner, n_triangles))


def make_bridge(mesh: TriangleMesh, first: Hole, second: Hole, next_vertex: int) -> Bridge | Refusal:
    """Join two loops of a mesh, or say why they can't be joined.

    Parameters
    ----------
    mesh : TriangleMesh
    first, second : Hole
        With manifold rims.
    next_vertex : int
        Number of the first new vertex of its ribs.

    Returns
    -------
    Bridge or (str, str)
        A stable code and a sentence for people where there is no bridge.
    """
    if touch(first, second):
        return _TOUCHING
    facing = look_across(mesh, first.loop, second.loop)
    if not facing.runs_opposite:
        return _FLIPPED
    n_vertices = _expected_vertices(facing)
    if n_vertices > MAX_NEW_VERTICES:
        dense = f"a strip as dense as its rims takes about {n_vertices} new vertices"
        return "too_many_vertices", f"{dense}, over {MAX_NEW_VERTICES}"
    if shape_of(facing, first, second) == "ring":
        return Bridge((first, second), _ring(facing, first.loop, second.loop), facing)
    stretches = facing_stretches(facing)
    if stretches is None:
        return _APART
    loop, ribs = _between_ribs(mesh, facing, (first.loop, second.loop), stretches, next_vertex)
    return Bridge((first, second), loop, facing, ribs)


def touch(first: Hole, second: Hole) -> bool:
    """Whether two loops share a vertex."""
    return len(np.intersect1d(first.loop, second.loop)) > 0


def shape_of(facing: Facing, first: Hole, second: Hole) -> BridgeShape:
    """Tell whether loops are joined all around: outer borders are where most of each faces the other, others always."""
    is_part = facing.share < WHOLE_SHARE and (first.is_border or second.is_border)
    return "strip" if is_part else "ring"


def _expected_vertices(facing: Facing) -> int:
    """Estimate the new vertices that a strip will have: equilateral triangles as large as the rims' edges."""
    longer = max(rim.lengths[sight.faces].sum() for rim, sight in zip(facing.rims, facing.sights, strict=True))
    edge = np.mean([rim.edge for rim in facing.rims])
    return round(float(longer * facing.gap / (np.sqrt(0.75) * edge**2)))


def _ring(facing: Facing, first: IntArray, second: IntArray) -> IntArray:
    """Join two loops by an edge between the vertices that are nearest to each other: (n_first + n_second + 2,)."""
    one, other, sight = *facing.rims, facing.sights[0]
    distance = length(other.points[sight.nearest] - one.points)
    i = int(np.where(sight.faces | ~sight.faces.any(), distance, np.inf).argmin())
    j = int(sight.nearest[i])
    return np.concatenate([first[: i + 1], np.roll(second, -j), second[j : j + 1], first[i:]])


def _between_ribs(
    mesh: TriangleMesh, facing: Facing, loops: tuple[IntArray, IntArray], stretches: tuple[IntArray, IntArray], n: int
) -> tuple[IntArray, list[Rib]]:
    """Lay a rib at either end of two stretches: the loop between them, and the ribs; n is the next new vertex."""
    here, there = stretches
    edge = float(np.mean([rim.edge for rim in facing.rims]))
    ribs, cuts = list[Rib](), list[tuple[int, int]]()
    for a, b, is_forward in ((here[::-1], there, True), (here, there[::-1], False)):
        one, other = (
            RibSide(loop[at], rim.normals[at]) for loop, at, rim in zip(loops, (a, b), facing.rims, strict=True)
        )
        rib, places = make_clear_rib(mesh, (one, other), edge, n, is_forward=is_forward)
        ribs.append(rib)
        cuts.append(places)
        n += len(rib.vertices)
    # From the rim edge that one rib takes to the one that the other takes.
    (at_end, at_start), (at_begin, at_stop) = cuts
    here = here[at_begin + 1 : len(here) - 1 - at_end]
    there = there[at_start + 1 : len(there) - 1 - at_stop]
    end, begin = (rib.inner[1:-1] for rib in ribs)
    around = [loops[0][here], end, loops[1][there], begin[::-1]]
    return np.concatenate(around), ribs
