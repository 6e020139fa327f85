"""Pairs of boundary loops that a bridge would join: what is proposed, and never carried out unasked.

Two loops are a pair where most of their rims face each other across a gap that is narrow for their size, and the
normals of both surfaces agree across it. Outer borders may face each other along a part of them only.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.filling.bridges import BridgeShape, shape_of, touch
from quadpatch.filling.facing import Facing, look_from
from quadpatch.filling.islands import loop_centres, loop_vector_areas
from quadpatch.mesh.holes import Hole
from quadpatch.mesh.loops import cut_at, laid_out
from quadpatch.mesh.normals import normals_at, unit
from quadpatch.types import FloatArray, IntArray, TriangleMesh

# Loops of fewer edges are specks of noise.
LEAST_EDGES = 8
# Of loops that are joined all around: least share of each rim that faces the other, and widest gap, in diameters of the
# narrower one, which is at least half as wide as the other.
RING_SHARE = 0.75
RING_GAP = 0.75
_LEAST_RATIO = 0.5
# The centres of such loops are no farther apart than this, in diameters, and their vector areas oppose each other.
_MOST_OFFSET = 1.0
_OPPOSITE = -0.5
# Of borders that are joined along a part: least share of one rim, and widest gap in lengths of that part.
STRIP_SHARE = 0.15
STRIP_GAP = 0.15
# Mean cosine between the normals across the gap, at least.
LEAST_AGREEMENT = 0.5
# Borders that are compared with each other, the widest, and pairs of loops that are looked at in all.
_MOST_BORDERS = 64
_MOST_PAIRS = 2000


@dataclass(frozen=True, slots=True)
class BridgeProposal:
    """Two loops that face each other.

    Attributes
    ----------
    holes : (int, int)
        Their ids, the wider one first.
    shape : str
        `ring`: all around; `strip`: along a part of them.
    gap : float
        Mean distance between the rims, in mesh units.
    share : float
        Of the rim that faces the other one, where it is smaller.
    """

    holes: tuple[int, int]
    shape: BridgeShape
    gap: float
    share: float


def propose_bridges(
    mesh: TriangleMesh, holes: list[Hole], lies_in: Mapping[int, Sequence[int]]
) -> list[BridgeProposal]:
    """Find pairs of loops that face each other; each loop is in one pair at most, the one with the narrowest gap.

    Parameters
    ----------
    mesh : TriangleMesh
    holes : list of Hole
        All of the mesh, widest first.
    lies_in : mapping of int to sequence of int
        Ids of the holes that islands lie in, by the id of the island: these are joined without a bridge.
    """
    eligible = [hole for hole in holes if hole.is_manifold and hole.n_edges >= LEAST_EDGES and hole.kind != "slit"]
    if len(eligible) < 2:
        return []
    candidates = dict.fromkeys([*_around(mesh, eligible), *_beside(eligible)])
    pairs = [(i, j) for i, j in candidates if not _is_island(eligible[i].id, eligible[j].id, lies_in)][:_MOST_PAIRS]
    if not pairs:
        return []
    normals = _Normals.of(mesh, [eligible[i] for i in sorted({i for pair in pairs for i in pair})])
    found = []
    for i, j in pairs:
        first, second = eligible[i], eligible[j]
        if touch(first, second):
            continue
        points = mesh.vertices[first.loop], mesh.vertices[second.loop]
        facing = look_from(points, (normals.of_hole[first.id], normals.of_hole[second.id]))
        shape = shape_of(facing, first, second)
        if _is_pair(facing, shape, second.diameter):
            found.append(BridgeProposal((first.id, second.id), shape, facing.gap, facing.share))
    return _each_once(found, {hole.id: hole.diameter for hole in eligible})


@dataclass(frozen=True)
class _Normals:
    """Normals at the rims of some holes, by id."""

    of_hole: dict[int, FloatArray]

    @classmethod
    def of(cls, mesh: TriangleMesh, holes: list[Hole]) -> "_Normals":
        loops = [hole.loop for hole in holes]
        rows = normals_at(mesh.vertices, mesh.triangles, np.concatenate(loops))
        return cls({hole.id: part for hole, part in zip(holes, cut_at(rows, laid_out(loops)[0]), strict=True)})


def _around(mesh: TriangleMesh, holes: list[Hole]) -> Iterator[tuple[int, int]]:
    """Yield pairs of loops that may face each other all around: near each other, about as wide, and opposite."""
    loops = [hole.loop for hole in holes]
    centres = loop_centres(mesh.vertices, loops)
    areas = unit(loop_vector_areas(mesh.vertices, loops, centres))
    diameters = np.array([hole.diameter for hole in holes])
    for i, near in enumerate(cKDTree(centres).query_ball_point(centres, _MOST_OFFSET * diameters)):
        others: IntArray = np.sort(np.array(near, np.int64))
        others = others[(others > i) & (diameters[others] >= _LEAST_RATIO * diameters[i])]
        for j in others[areas[others] @ areas[i] < _OPPOSITE].tolist():
            yield i, j


def _beside(holes: list[Hole]) -> Iterator[tuple[int, int]]:
    """Yield pairs of outer borders, the widest, whose boxes are near each other."""
    borders = [i for i, hole in enumerate(holes) if hole.is_border][:_MOST_BORDERS]
    for at, i in enumerate(borders):
        for j in borders[at + 1 :]:
            one, other = holes[i], holes[j]
            apart = np.maximum(np.subtract(one.low, other.high), np.subtract(other.low, one.high))
            if (apart <= STRIP_GAP * np.pi * other.diameter).all():
                yield i, j


def _is_island(first: int, second: int, lies_in: Mapping[int, Sequence[int]]) -> bool:
    return first in lies_in.get(second, ()) or second in lies_in.get(first, ())


def _is_pair(facing: Facing, shape: BridgeShape, diameter: float) -> bool:
    if not facing.runs_opposite or facing.agreement < LEAST_AGREEMENT:
        return False
    if shape == "ring":
        return facing.share >= RING_SHARE and facing.gap <= RING_GAP * diameter
    lengths = [rim.lengths[sight.faces].sum() for rim, sight in zip(facing.rims, facing.sights, strict=True)]
    return max(s.share for s in facing.sights) >= STRIP_SHARE and facing.gap <= STRIP_GAP * min(lengths)


def _each_once(found: list[BridgeProposal], diameters: dict[int, float]) -> list[BridgeProposal]:
    """Keep for each loop the proposal with the gap that is narrowest for the loops; in the order of the loops."""
    kept, taken = [], set[int]()
    for proposal in sorted(found, key=lambda one: one.gap / diameters[one.holes[1]]):
        if not taken & set(proposal.holes):
            kept.append(proposal)
            taken |= set(proposal.holes)
    return sorted(kept, key=lambda one: one.holes)
