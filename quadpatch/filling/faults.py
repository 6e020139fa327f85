"""Faults of a fill: edges at which it folds over, and triangles that run through other surface."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.intersections import box_contacts, crossing_pairs, heights
from quadpatch.mesh.normals import triangle_normals
from quadpatch.mesh.topology import compacted, neighbouring_triangles, touching
from quadpatch.processes import ProcessPool, Shared
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles

# Two triangles whose normals differ by more fold over each other.
FOLD_ANGLE_DEG = 150.0
# Normals of triangles lower than this share of their longest edge are too unsure to call a fold wrong.
UNSURE_HEIGHT = 1e-3
# A wrong fill is worse than a right one with any number of doubtful edges.
_WRONG = 1_000_000_000
# New triangles that are searched for crossings together, where there are many.
_PART_TRIANGLES = 15_000
# Triangles of the scan that are compared with the fills together.
_PIECE_TRIANGLES = 250_000


@dataclass(frozen=True)
class Folds:
    """Pairs of neighbouring triangles that turn by more than `FOLD_ANGLE_DEG`, a new one in each.

    Attributes
    ----------
    pairs : (n, 2) int64
        Triangles of the filled mesh.
    edges : (n, 2) int64
        The vertices they share.
    hole : (n,) int64
        Position of the loop that a new one of the two fills.
    is_flat_rim : (n,) bool
        True where the triangle on the measured side has no height, so its normal is noise.
    is_tolerated : (n,) bool
        True there, and where measured surface folds at one of the shared vertices itself.
    is_sliver : (n,) bool
        True where the new triangle is too low to tell.
    """

    pairs: IntArray
    edges: IntArray
    hole: IntArray
    is_flat_rim: BoolArray
    is_tolerated: BoolArray
    is_sliver: BoolArray


@dataclass(frozen=True)
class Faults:
    """What is wrong with the fill of every loop.

    Attributes
    ----------
    folds : Folds
    crossings : (n_loops,) int64
        New triangles that run through measured or new surface.
    crossing_triangles : (n,) int64
        Those, as triangles of the filled mesh.
    crossing_fills : (n, 2) int64
        Pairs of loops whose fills run through each other, each pair once.
    is_invalid : (n_loops,) bool
        True where a fill runs through measured surface or through itself, whatever becomes of the others.
    """

    folds: Folds
    crossings: IntArray
    crossing_triangles: IntArray
    crossing_fills: IntArray
    is_invalid: BoolArray

    @property
    def n_folds(self) -> IntArray:
        """Edges (n_loops,) at which the fill folds over, tolerated ones too."""
        return self._count(np.ones(len(self.folds.hole), bool))

    @property
    def is_doubtful(self) -> BoolArray:
        """Loops (n_loops,) that another fill may suit better.

        Those with any fault but the folds of the measured surface, and but for crossing a fill that is invalid itself.
        """
        pairs = self.crossing_fills[~self.is_invalid[self.crossing_fills].any(axis=1)]
        has_crossing_fill = np.isin(np.arange(len(self.crossings)), pairs)
        return np.asarray((self._count(~self.folds.is_tolerated) > 0) | self.is_invalid | has_crossing_fill)

    @property
    def is_wrong(self) -> BoolArray:
        """Loops (n_loops,) whose fill is no surface to hand out."""
        return self.is_wrong_alone | (self.crossings > 0)

    @property
    def is_wrong_alone(self) -> BoolArray:
        """Loops (n_loops,) whose fill would be wrong without the fills of others too."""
        return (self._count(~self.folds.is_tolerated & ~self.folds.is_sliver) > 0) | self.is_invalid

    @property
    def severity(self) -> IntArray:
        """Order (n_loops,) of fills from good to bad: what makes a fill wrong counts before what makes it doubtful."""
        doubtful = self._count(~self.folds.is_tolerated) + self.crossings
        return np.asarray(np.where(self.is_wrong, _WRONG, 0) + doubtful)

    @property
    def doubtful_triangles(self) -> IntArray:
        """Triangles (n,) of the filled mesh that cross others or fold, but where the measured surface asks for it."""
        folding = self.folds.pairs[~self.folds.is_tolerated].ravel()
        return np.unique(np.concatenate([folding, self.crossing_triangles]))

    def _count(self, which: BoolArray) -> IntArray:
        return np.bincount(self.folds.hole[which], minlength=len(self.crossings))


def find_faults(
    filled: FilledMesh,
    loops: IntArray | None = None,
    obstacles: Triangles | None = None,
    pool: ProcessPool | None = None,
) -> Faults:
    """Look for folds and crossings in the fill of some loops.

    Parameters
    ----------
    filled : FilledMesh
    loops : (n,) int64, optional
        Positions of the loops that are looked at; without, all of them. The fills of others are surface to be run into.
    obstacles : (k, 3) int64, optional
        Triangles of the file that the mesh leaves out, to be run into as well.
    pool : ProcessPool, optional
        Its processes look for crossings.
    """
    n_loops = len(filled.disagreement)
    looked_at = np.ones(n_loops, bool) if loops is None else np.isin(np.arange(n_loops), loops)
    search = _Search.begin(filled, looked_at, obstacles, pool or ProcessPool())
    return Faults(find_folds(filled, looked_at), *search.finish())


def find_folds(filled: FilledMesh, looked_at: BoolArray) -> Folds:
    """Look for folds in the fills of some loops (n_loops,)."""
    vertices, triangles = filled.mesh.vertices, filled.mesh.triangles
    hole = np.full(len(triangles), -1)
    hole[filled.n_measured_triangles :] = filled.triangle_hole
    near = np.flatnonzero(_near(filled, looked_at))
    pairs, edges = neighbouring_triangles(triangles[near])
    pairs = near[pairs]
    normals = np.zeros((len(triangles), 3))
    normals[near] = triangle_normals(vertices, triangles[near])
    turn = np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]])
    folded = turn < np.cos(np.radians(FOLD_ANGLE_DEG))
    pairs, edges = pairs[folded], edges[folded]
    is_new = hole[pairs] >= 0
    unsure = heights(vertices, triangles[pairs.ravel()]).reshape(-1, 2) <= UNSURE_HEIGHT
    turns_itself = np.zeros(len(vertices), bool)
    turns_itself[edges[~is_new.any(axis=1)]] = True
    of_rim = is_new.any(axis=1) & ~is_new.all(axis=1)
    flat_rim = of_rim & (unsure & ~is_new).any(axis=1)
    tolerated = flat_rim | (of_rim & turns_itself[edges].any(axis=1))
    owner = hole[pairs].max(axis=1)
    mine = np.asarray((owner >= 0) & looked_at[owner.clip(0)])
    sliver = (unsure & is_new).any(axis=1)
    return Folds(*(rows[mine] for rows in (pairs, edges, owner, flat_rim, tolerated, sliver)))


def _near(filled: FilledMesh, looked_at: BoolArray) -> BoolArray:
    """Triangles (n,) of some fills, and those that share a vertex with them."""
    triangles = filled.mesh.triangles
    own = np.zeros(len(triangles), bool)
    own[filled.n_measured_triangles :] = looked_at[filled.triangle_hole]
    touched = np.zeros(len(filled.mesh.vertices), bool)
    touched[triangles[own]] = True
    return touching(triangles, touched)


@dataclass(frozen=True)
class _Search:
    """A search for crossings that has begun.

    Attributes
    ----------
    n_loops : int
    mine, owner : (n,) int64
        Triangles of the fills that are looked at, and their loops.
    chosen : list of (k,) int64
        What each part looks at: triangles of some fills and what is near them. Obstacles count behind the filled mesh.
    pairs : Shared
        Finds the crossing pairs of each part.
    """

    n_loops: int
    mine: IntArray
    owner: IntArray
    chosen: list[IntArray]
    pairs: Shared[tuple[TriangleMesh, int], IntArray]

    @classmethod
    def begin(
        cls, filled: FilledMesh, looked_at: BoolArray, obstacles: Triangles | None, pool: ProcessPool
    ) -> "_Search":
        n_loops, n = len(filled.disagreement), filled.n_measured_triangles
        is_mine = looked_at[filled.triangle_hole]
        mine, owner = n + np.flatnonzero(is_mine), filled.triangle_hole[is_mine]
        if not len(mine):
            return cls(n_loops, mine, owner, [], Shared(_crossing_pairs_of, [], []))
        vertices, every = filled.mesh.vertices, filled.mesh.triangles
        if obstacles is not None:
            every = np.concatenate([every, obstacles])
        low, high = _boxes(filled)
        boxes = np.flatnonzero(looked_at & np.isfinite(low[:, 0]))
        touching = partial(box_contacts, low[boxes], high[boxes])
        starts = range(0, len(every), _PIECE_TRIANGLES)
        pieces = [TriangleMesh(vertices, every[at : at + _PIECE_TRIANGLES]) for at in starts]
        contacts = pool.map_in_threads(touching, pieces)
        box, near = np.concatenate([found + np.array([0, at]) for found, at in zip(contacts, starts, strict=True)]).T
        part = _part_of_each(owner, n_loops)
        part_of_contact, chosen, tasks = part[boxes[box]], [], []
        for i in np.unique(part[owner]):
            own = mine[part[owner] == i]
            chosen.append(np.concatenate([own, np.setdiff1d(near[part_of_contact == i], own)]))
            used, local = compacted(every[chosen[-1]], len(vertices))
            tasks.append((TriangleMesh(vertices[used], local), len(own)))
        shared = pool.begin(_crossing_pairs_of, tasks) if len(tasks) > 1 else Shared(_crossing_pairs_of, tasks, [])
        return cls(n_loops, mine, owner, chosen, shared)

    def finish(self) -> tuple[IntArray, IntArray, IntArray, BoolArray]:
        """Find crossings, their triangles, rivals and lost loops, as `Faults` has them."""
        found = [chosen[pairs] for chosen, pairs in zip(self.chosen, self.pairs.finish(), strict=True)]
        pairs = np.concatenate([np.zeros((0, 2), np.int64), *found])
        # What is no fill that is looked at has no loop.
        at = np.searchsorted(self.mine, pairs).clip(max=len(self.mine) - 1)
        is_mine = self.mine[at] == pairs
        crossing, first = np.unique(pairs[is_mine], return_index=True)
        crossings = np.bincount(self.owner[at[is_mine][first]], minlength=self.n_loops)
        loops = np.unique(np.sort(np.where(is_mine, self.owner[at], -1), axis=1), axis=0)
        is_invalid = np.zeros(self.n_loops, bool)
        is_invalid[loops[(loops[:, 0] < 0) & (loops[:, 1] >= 0), 1]] = True
        is_invalid[loops[(loops[:, 0] == loops[:, 1]) & (loops[:, 0] >= 0), 0]] = True
        crossing_fills = loops[(loops[:, 0] >= 0) & (loops[:, 0] < loops[:, 1])]
        return crossings, crossing, crossing_fills, is_invalid


def _part_of_each(owner: IntArray, n_loops: int) -> IntArray:
    """Divide loops, by that of each new triangle (n,), into parts of about as many triangles: the part (n_loops,)."""
    n_parts = max(len(owner) // _PART_TRIANGLES, 1)
    return np.cumsum(np.bincount(owner, minlength=n_loops)) * n_parts // (len(owner) + 1)


def _crossing_pairs_of(task: tuple[TriangleMesh, int]) -> IntArray:
    """Find the crossing pairs of the first so many triangles of a mesh with all of it; others may be among them."""
    return crossing_pairs(*task)


def _boxes(filled: FilledMesh) -> tuple[FloatArray, FloatArray]:
    """Bounding boxes of all fills: lowest and highest corners (n_loops, 3); infinite without a fill."""
    new = filled.mesh.triangles[filled.n_measured_triangles :]
    n_loops = len(filled.disagreement)
    low, high = np.full((n_loops, 3), np.inf), np.full((n_loops, 3), -np.inf)
    corners = filled.mesh.vertices[new]
    np.minimum.at(low, filled.triangle_hole, corners.min(axis=1))
    np.maximum.at(high, filled.triangle_hole, corners.max(axis=1))
    return low, high
