"""Connectivity of quads or triangles by a walk from polygon to polygon.

The walk starts at one polygon and goes on over its edges, first come, first served. For each edge it says whether a
polygon lies beyond, and for each further corner of that polygon whether its vertex is new, follows from the edges that
still wait, or must be named. Vertices are numbered as the walk meets them, so that only their order is lost. A mesh
that is no manifold takes more names; every list of polygons can be coded.

The walk also says from which three earlier vertices the place of a new one is predicted: p + q - r, across the edge
that was crossed (parallelogram prediction).

References
----------
S. Gumhold, W. Strasser, "Real time compression of triangle mesh connectivity", SIGGRAPH 1998; C. Touma, C. Gotsman,
"Triangle mesh compression", Graphics Interface 1998.
"""

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from quadpatch.errors import ReadError
from quadpatch.types import IntArray

# How the vertex of a corner is told.
NEW, AFTER, BEFORE, NAMED = range(4)
KINDS = 4


@dataclass
class Walk:
    """Polygons in the order of the walk, with vertices numbered as it meets them.

    Attributes
    ----------
    polygons : list of list of int
    crossed : list of int
        1 for every edge with a polygon beyond, 0 for the others, in the order of the walk.
    kinds : list of int
        NEW, AFTER, BEFORE or NAMED for every corner that the crossed edge does not tell.
    names : list of int
        Vertices of corners that are NAMED.
    predictors : list of (int, int, int)
        For each vertex p, q, r; all -1 for the first one.
    """

    polygons: list[list[int]] = field(default_factory=list)
    crossed: list[int] = field(default_factory=list)
    kinds: list[int] = field(default_factory=list)
    names: list[int] = field(default_factory=list)
    predictors: list[tuple[int, int, int]] = field(default_factory=list)


@dataclass
class _Border:
    """Edges behind which no polygon is known yet, each in the direction of the polygon that would lie there."""

    waiting: dict[tuple[int, int], tuple[int, int]] = field(default_factory=dict)
    queue: deque[tuple[int, int]] = field(default_factory=deque)
    ends: dict[int, list[int]] = field(default_factory=dict)
    starts: dict[int, list[int]] = field(default_factory=dict)

    def add(self, polygon: list[int], number: int, crossed: tuple[int, int] | None) -> None:
        """Close the edges that a polygon fills, and let its others wait but for the one that was crossed."""
        n = len(polygon)
        for side in range(n):
            edge = (polygon[side], polygon[(side + 1) % n])
            if edge == crossed:
                continue
            if edge in self.waiting:
                self.remove(edge)
            elif edge[::-1] not in self.waiting:
                self._push(edge[::-1], (number, side))

    def _push(self, edge: tuple[int, int], origin: tuple[int, int]) -> None:
        self.waiting[edge] = origin
        self.queue.append(edge)
        self.ends.setdefault(edge[0], []).append(edge[1])
        self.starts.setdefault(edge[1], []).append(edge[0])

    def remove(self, edge: tuple[int, int]) -> None:
        del self.waiting[edge]
        self.ends[edge[0]].remove(edge[1])
        self.starts[edge[1]].remove(edge[0])

    def pop(self) -> tuple[tuple[int, int], tuple[int, int]] | None:
        """Take the edge that has waited longest, with the polygon and side that it belongs to."""
        while self.queue:
            edge = self.queue.popleft()
            if edge in self.waiting:
                origin = self.waiting[edge]
                self.remove(edge)
                return edge, origin
        return None

    def guesses(self, corners: list[int], *, is_last: bool) -> tuple[int, int]:
        """Vertices that the next corner may have: after the newest corner, and before the first; -1 for none."""
        after, before = self.ends.get(corners[-1]), self.starts.get(corners[0]) if is_last else None
        return after[0] if after else -1, before[0] if before else -1


def encode_polygons(polygons: IntArray) -> tuple[Walk, IntArray, IntArray]:
    """Walk over polygons.

    Parameters
    ----------
    polygons : (n, k) int64
        Different corners each.

    Returns
    -------
    walk : Walk
    polygon_order : (n,) int64
        Number of the polygon that each of the walk's was.
    vertex_order : (n_vertices,) int64
        Number of the vertex that each of the walk's was.
    """
    rows = polygons.tolist()
    n_corners = polygons.shape[1] if len(rows) else 0
    by_edge: dict[tuple[int, int], list[int]] = {}
    for number, row in enumerate(rows):
        for side in range(n_corners):
            by_edge.setdefault((row[side], row[(side + 1) % n_corners]), []).append(number)
    walk, border = Walk(), _Border()
    to_walk: dict[int, int] = {}
    original: list[int] = []
    order: list[int] = []
    is_done = np.zeros(len(rows), bool)
    next_root = 0
    while len(order) < len(rows):
        found = border.pop()
        if found is None:
            while is_done[next_root]:
                next_root += 1
            number, corners = next_root, list(rows[next_root])
        else:
            edge = (original[found[0][0]], original[found[0][1]])
            candidates = [i for i in by_edge.get(edge, ()) if not is_done[i]]
            walk.crossed.append(int(bool(candidates)))
            if not candidates:
                continue
            number = candidates[0]
            corners = _rotated(rows[number], edge)
        _tell(corners, found is not None, (walk, border), (to_walk, original))
        _place(walk, border, [to_walk[corner] for corner in corners], found)
        is_done[number] = True
        order.append(number)
    return walk, np.array(order, np.int64), np.array(original, np.int64)


def decode_polygons(walk: Walk, n_polygons: int, n_corners: int) -> None:
    """Rebuild `polygons` and `predictors` of a walk from its other lists.

    Raises
    ------
    ReadError
        If these are not what a walk over so many polygons leaves.
    """
    border = _Border()
    crossed, kinds, names = iter(walk.crossed), iter(walk.kinds), iter(walk.names)
    try:
        while len(walk.polygons) < n_polygons:
            found = border.pop()
            if found is not None and not next(crossed):
                continue
            corners = list(found[0]) if found else []
            while len(corners) < n_corners:
                corners.append(_told(corners, found, n_corners, (walk, border, next(kinds), names)))
            if len(set(corners)) < n_corners:
                raise ReadError("a polygon has the same corner twice")
            _place(walk, border, corners, found)
    except StopIteration:
        raise ReadError("the connectivity ends too early") from None
    if any(next(rest, None) is not None for rest in (crossed, kinds, names)):
        raise ReadError("the connectivity does not end where it should")


def _rotated(corners: list[int], edge: tuple[int, int]) -> list[int]:
    """Start with an edge of the polygon."""
    n = len(corners)
    first = next(i for i in range(n) if (corners[i], corners[(i + 1) % n]) == edge)
    return corners[first:] + corners[:first]


def _tell(
    corners: list[int], is_crossed: bool, state: tuple[Walk, _Border], numbers: tuple[dict[int, int], list[int]]
) -> None:
    """Say which vertices the corners of a polygon have; the first two follow from an edge that was crossed."""
    (walk, border), (to_walk, original) = state, numbers
    told = [to_walk[corner] for corner in corners[:2]] if is_crossed else []
    for corner in corners[len(told) :]:
        vertex = to_walk.get(corner, -1)
        guesses = border.guesses(told, is_last=len(told) == len(corners) - 1) if is_crossed else (-1, -1)
        if vertex < 0:
            kind = NEW
            vertex = to_walk[corner] = len(original)
            original.append(corner)
            walk.predictors.append((-1, -1, -1))
        elif vertex in guesses:
            kind = AFTER if vertex == guesses[0] else BEFORE
        else:
            kind = NAMED
            walk.names.append(vertex)
        walk.kinds.append(kind)
        told.append(vertex)


def _told(corners: list[int], found: object, n_corners: int, state: tuple[Walk, _Border, int, "object"]) -> int:
    """Find the vertex of the next corner."""
    walk, border, kind, names = state
    if kind == NEW:
        walk.predictors.append((-1, -1, -1))
        return len(walk.predictors) - 1
    if kind == NAMED:
        vertex = int(next(names))  # type: ignore[call-overload]
    elif found is None:
        raise ReadError("the first polygon of a piece follows from no edge")
    else:
        vertex = border.guesses(corners, is_last=len(corners) == n_corners - 1)[kind - AFTER]
    if not 0 <= vertex < len(walk.predictors):
        raise ReadError("a polygon names a vertex that is not there")
    return vertex


def _place(
    walk: Walk, border: _Border, corners: list[int], found: tuple[tuple[int, int], tuple[int, int]] | None
) -> None:
    """Append a polygon, told from its crossed edge on, and predict its new vertices.

    A quad is turned so that the edge it was reached over lies opposite to the side of the quad it was reached from:
    x then runs on from quad to quad.
    """
    origin = None if found is None else (walk.polygons[found[1][0]], found[1][1])
    _predict(walk, corners, origin)
    if origin is not None and len(corners) == 4:
        turn = (origin[1] + 2) % 4
        corners = corners[4 - turn :] + corners[: 4 - turn]
    border.add(corners, len(walk.polygons), None if found is None else found[0])
    walk.polygons.append(corners)


def _predict(walk: Walk, corners: list[int], origin: tuple[list[int], int] | None) -> None:
    """Predict new vertices: parallelograms with what is known, across the crossed edge."""
    first_new = len(walk.predictors)
    while first_new and walk.predictors[first_new - 1] == (-1, -1, -1):
        first_new -= 1
    n = len(corners)
    for vertex in range(max(first_new, 1), len(walk.predictors)):
        place = corners.index(vertex)
        after, before = corners[(place + 1) % n], corners[place - 1]
        if origin is None:
            walk.predictors[vertex] = (vertex - 1,) * 3
        elif n == 3:
            walk.predictors[vertex] = (before, after, origin[0][(origin[1] + 2) % 3])
        elif after < vertex and before < vertex:
            walk.predictors[vertex] = (before, after, corners[(place + 2) % 4])
        else:
            # Corner 2 lies beyond corner 1, which is the first end of the other quad's side; corner 3 beyond corner 0.
            beyond = origin[0][(origin[1] + (3 if place == 2 else 2)) % 4]
            near = corners[1 if place == 2 else 0]
            walk.predictors[vertex] = (near, near, beyond)
