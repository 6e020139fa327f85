"""Filling many holes in parts, which processes share.

Holes that read each other's surroundings stay together. The parts follow from the mesh and its holes alone, so the
fills are the same whatever the number of processes.

Tested in `tests/quadpatch/filling/test_parts.py`.
"""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, replace
from functools import partial
from itertools import zip_longest

import numpy as np

from quadpatch.filling.fairing import triangles_around
from quadpatch.filling.fill import ClosedMesh, close_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.region import Region
from quadpatch.mesh.loops import cut_at, laid_out
from quadpatch.mesh.topology import compacted, components
from quadpatch.processes import ProcessPool
from quadpatch.progress import Fraction, no_fraction
from quadpatch.types import IntArray, TriangleMesh, Triangles

# How boundary loops of a mesh that are closed are faired, and what is told the done fraction.
Fill = Callable[[ClosedMesh, list[IntArray], Fraction], FilledMesh]

# A hole of n edges gets about as many new vertices as n squared. Parts of this many cost no more than all at once do.
_PART_WORK = 40_000
# Holes whose second rings of triangles touch are filled together. Where that joins too many, those whose first rings
# touch: other rims, three edges away at least, are in none of a fill's equations, but move with the rims let go.
_NEIGHBOURS = (2, 1)
_LARGEST_GROUP = 10 * _PART_WORK
# Closed holes of a part are up to 15 MB: no more of them wait for each helper until it is known how to fill.
_CLOSED_AHEAD = 4
# Rings of triangles around a part: leaving one ring out reads three, and finds new loops by the ring behind them.
_RINGS = 4


@dataclass(frozen=True)
class _Part:
    """Some holes, and the surface around them.

    Attributes
    ----------
    loops : (k,) int64
        Positions of the loops.
    local : list of (n_loop,) int64
        The loops, in vertices of the region.
    region : Region
    """

    loops: IntArray
    local: list[IntArray]
    region: Region

    @classmethod
    def of(cls, near: Region, loops: list[IntArray], chosen: IntArray) -> "_Part":
        """Cut some loops (k,) out of a region."""
        region, local = surroundings(near.mesh, [loops[i] for i in chosen])
        return cls(chosen, local, replace(region, whole=near.whole, vertices=near.vertices[region.vertices]))


def surroundings(mesh: TriangleMesh, loops: list[IntArray]) -> tuple[Region, list[IntArray]]:
    """Cut out what fills of some loops read; the same loops in the vertices of that region.

    Fills made there are those of the whole mesh, bit for bit.
    """
    rim, starts = np.concatenate(loops), laid_out(loops)[0]
    near = triangles_around(mesh.triangles, rim, len(mesh.vertices), _RINGS)
    used, triangles = compacted(mesh.triangles[near], len(mesh.vertices))
    region = Region(TriangleMesh(mesh.vertices[used], triangles), mesh, used)
    return region, cut_at(region.local(rim), starts)


@dataclass(frozen=True)
class _Work:
    """A part to be filled. Pickled, it is sent with its holes closed, once they are, where a helper has begun that.

    Attributes
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
    begun : Future, ClosedMesh or None
        Its holes, closed, as far as that has been begun.
    """

    mesh: TriangleMesh
    loops: list[IntArray]
    begun: "Future[ClosedMesh] | ClosedMesh | None"

    def known(self) -> ClosedMesh | None:
        """Wait for what has been begun; None if nothing has."""
        return self.begun.result() if isinstance(self.begun, Future) else self.begun

    def __reduce__(self) -> "tuple[type[_Work], tuple[object, ...]]":
        """Send what is known."""
        closed = self.known()
        return _Work, (self.mesh if closed is None else closed.mesh, self.loops, closed)


class FillInParts:
    """A fill of boundary loops, in parts where there are many of them.

    Helpers close the holes of the first parts at once: that does not depend on how they are filled.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
    pool : ProcessPool
    """

    def __init__(self, mesh: TriangleMesh, loops: list[IntArray], pool: ProcessPool) -> None:
        self._mesh, self._loops, self._pool = mesh, loops, pool
        self._parts: list[_Part] = []
        number = _part_of_each(mesh.triangles, loops)
        if number.any():
            near, local = surroundings(mesh, loops)
            self._parts = [_Part.of(near, local, np.flatnonzero(number == i)) for i in range(int(number.max()) + 1)]
        ahead = self._parts[: _CLOSED_AHEAD * len(pool.process_ids)]
        self._closings = [pool.submit(close_holes, part.region.mesh, part.local) for part in ahead]

    def begin(self, fill: Fill) -> None:
        """Let helpers begin to fill parts; the function is pickled."""
        self._fill = fill
        if self._parts:
            work = [
                _Work(part.region.mesh, part.local, None if closing is None or closing.cancel() else closing)
                for part, closing in zip_longest(self._parts, self._closings)
            ]
            self._shared = self._pool.begin(partial(_fill, fill), work)

    def finish(self, reach: Fraction = no_fraction) -> FilledMesh:
        """Fill what has not been filled yet; `reach` is told the done fraction."""
        if not self._parts:
            return self._fill(close_holes(self._mesh, self._loops), self._loops, reach)
        return _joined(self._mesh, self._parts, self._shared.finish(reach))


def _fill(fill: Fill, work: _Work) -> FilledMesh:
    return fill(work.known() or close_holes(work.mesh, work.loops), work.loops, no_fraction)


def _part_of_each(triangles: Triangles, loops: list[IntArray]) -> IntArray:
    """Choose the part (n_loops,) of each loop, counted from 0: of about the same work, neighbours in one of them."""
    work = np.array([len(loop) ** 2 for loop in loops], np.float64)
    n_parts = int(work.sum() // _PART_WORK)
    if n_parts < 2:
        return np.zeros(len(loops), np.int64)
    wider, closer = (_groups(triangles, loops, n_rings) for n_rings in _NEIGHBOURS)
    is_too_large = np.bincount(wider, work)[wider] > _LARGEST_GROUP
    group = np.where(is_too_large, wider.max() + 1 + closer, wider)
    # Groups in the order of their first loops.
    _, first, group = np.unique(group, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    group = rank[group]
    of_group = np.bincount(group, work)
    middle = np.cumsum(of_group) - of_group / 2
    part = (middle * n_parts / work.sum()).astype(np.int64).clip(max=n_parts - 1)
    # A large group leaves parts without a loop.
    return np.unique(part, return_inverse=True)[1][group]


def _groups(triangles: Triangles, loops: list[IntArray], n_rings: int) -> IntArray:
    """Find the groups of loops whose rings of triangles touch: the number (n_loops,) of each."""
    rim, starts = np.concatenate(loops), laid_out(loops)[0]
    n_vertices = int(triangles.max()) + 1
    near = triangles[triangles_around(triangles, rim, n_vertices, n_rings)]
    used, local = compacted(near, n_vertices)
    at_vertex = components(local[:, [0, 1, 1, 2]].reshape(-1, 2), len(used))
    return np.asarray(at_vertex[np.searchsorted(used, rim[starts[:-1]])])


def _joined(mesh: TriangleMesh, parts: list[_Part], fills: list[FilledMesh]) -> FilledMesh:
    """Put the fills of all parts behind a mesh, one part after the other."""
    n_loops = sum(len(part.loops) for part in parts)
    disagreement, rim_variation = np.zeros(n_loops), np.zeros(n_loops)
    weights = None
    vertices, triangles, n_vertices = [mesh.vertices], [mesh.triangles], len(mesh.vertices)
    for part, fill in zip(parts, fills, strict=True):
        new = fill.mesh.vertices[fill.n_measured_vertices :]
        to_whole = np.concatenate([part.region.vertices, n_vertices + np.arange(len(new))])
        vertices.append(new)
        triangles.append(to_whole[fill.mesh.triangles[fill.n_measured_triangles :]])
        n_vertices += len(new)
        disagreement[part.loops], rim_variation[part.loops] = fill.disagreement, fill.rim_variation
        if fill.energy_weights is not None:
            weights = np.zeros((n_loops, fill.energy_weights.shape[1])) if weights is None else weights
            weights[part.loops] = fill.energy_weights
    holes = [(part.loops[f.triangle_hole], part.loops[f.vertex_hole]) for part, f in zip(parts, fills, strict=True)]
    return FilledMesh(
        TriangleMesh(np.concatenate(vertices), np.concatenate(triangles)),
        len(mesh.vertices),
        len(mesh.triangles),
        np.concatenate([of_triangle for of_triangle, _ in holes]),
        np.concatenate([of_vertex for _, of_vertex in holes]),
        disagreement,
        rim_variation,
        sorted(int(part.loops[i]) for part, f in zip(parts, fills, strict=True) for i in f.unfilled),
        weights,
    )
