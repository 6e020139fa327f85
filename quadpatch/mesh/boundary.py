"""Boundary loops of a triangle mesh.

An edge with exactly one face is a boundary edge. Boundary edges keep the direction of their face, so every loop
runs with the surface on its left.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.cycles import plain_cycles
from quadpatch.mesh.edge_survey import EdgeSurvey, survey_edges
from quadpatch.mesh.loops import laid_out
from quadpatch.mesh.measures import once_per_mesh
from quadpatch.mesh.topology import directed_edges, edge_keys, with_marked_edge
from quadpatch.types import BoolArray, IntArray, TriangleMesh, Triangles


@dataclass(frozen=True)
class Boundary:
    """All boundary loops of a mesh.

    Attributes
    ----------
    loops : list of (n_loop,) int64
        Vertex indices of each simple loop: no vertex comes twice.
    is_manifold : list of bool
        False where a loop touches an edge with three or more faces, or where the faces around it disagree about
        the direction; such a rim has no one surface to be continued.
    """

    loops: list[IntArray]
    is_manifold: list[bool]


def boundary_loops(triangles: Triangles, survey: EdgeSurvey | None = None) -> Boundary:
    """Find the simple boundary loops of a mesh.

    A walk that comes back to a vertex (two holes that share a corner) is cut there, so every loop is simple. Where
    several fans of faces meet in one vertex, a walk goes on along another fan than it came by: it follows the hole
    between two fans, not the rim of a flap that hangs on its tips.

    Parameters
    ----------
    triangles : (n_triangles, 3) int64
        Vertex indices, counter-clockwise seen from outside.
    survey : EdgeSurvey, optional
        Of these triangles, where that was made before.

    Returns
    -------
    Boundary
        Loops in the order of their lowest vertex index, each starting there. Empty for a closed mesh.
    """
    survey = survey or survey_edges(triangles, int(triangles.max(initial=-1)) + 1)
    edges, is_bad = _boundary_edges(triangles, survey)
    # An edge from a vertex to itself bounds nothing.
    edges = edges[edges[:, 0] != edges[:, 1]]
    plain = plain_cycles(edges)
    edges = edges[~plain.is_plain]
    walks, chains = _walk(edges, _exits(triangles, edges))
    simple = [_from_lowest(loop) for walk in walks for loop in _simple_loops(walk)]
    # A chain that can't be closed in the direction of its faces: the faces around it disagree.
    loops = [*plain.cycles, *simple, *(_from_lowest(chain) for chain in chains)]
    if not loops:
        return Boundary([], [])
    starts, vertices = laid_out(loops)[0][:-1], np.concatenate(loops)
    is_manifold = ~np.logical_or.reduceat(is_bad[vertices], starts)
    is_manifold[len(loops) - len(chains) :] = False
    order = np.lexsort((vertices[starts + 1], vertices[starts])).tolist()
    return Boundary([loops[i] for i in order], is_manifold[order].tolist())


def _from_lowest(loop: IntArray) -> IntArray:
    first = int(np.argmin(loop))
    return np.roll(loop, -first) if first else loop


def boundary_edges(triangles: Triangles) -> IntArray:
    """Find the directed edges that have exactly one face, (b, 2) int64, in the order of `directed_edges`."""
    return _boundary_edges(triangles, survey_edges(triangles, int(triangles.max(initial=-1)) + 1))[0]


def boundary_vertices(triangles: Triangles) -> IntArray:
    """Find the vertices of edges that have exactly one face, (n,) int64, ascending."""
    return np.flatnonzero(survey_edges(triangles, int(triangles.max(initial=-1)) + 1).on_boundary)


@once_per_mesh
def on_boundary(mesh: TriangleMesh) -> BoolArray:
    """Tell the vertices (n_vertices,) of edges that have exactly one face."""
    return survey_edges(mesh.triangles, len(mesh.vertices)).on_boundary


def _boundary_edges(triangles: Triangles, survey: EdgeSurvey) -> tuple[IntArray, BoolArray]:
    """Directed boundary edges (b, 2), and of every vertex whether faces overlap or disagree around it.

    Only edges between vertices that the survey marks are sorted.
    """
    n_vertices = len(survey.on_boundary)
    marked = survey.on_boundary | survey.on_crowded
    near = triangles[with_marked_edge(triangles, marked)]
    edges = directed_edges(near)
    edges = edges[marked[edges].all(axis=1)]
    _, edge, n_faces = np.unique(edge_keys(edges, max(n_vertices, 1)), return_inverse=True, return_counts=True)
    boundary = edges[n_faces[edge] == 1]
    arrivals, departures = (np.bincount(boundary[:, k], minlength=n_vertices) for k in (1, 0))
    return boundary, np.asarray((arrivals != departures) | survey.on_crowded)


def _exits(triangles: Triangles, edges: IntArray) -> dict[tuple[int, int], int]:
    """Where to go on at vertices with several fans: for each edge that arrives, the end of the edge to leave by."""
    starts, counts = np.unique(edges[:, 0], return_counts=True)
    pinched = starts[counts > 1]
    touching = triangles[np.isin(triangles, pinched).any(axis=1)] if len(pinched) else triangles[:0]
    third = {(t[k], t[k - 2]): t[k - 1] for t in touching.tolist() for k in range(3)}
    fans: dict[int, list[tuple[int, int]]] = {}
    for start, end in edges[np.isin(edges[:, 1], pinched)].tolist():
        fans.setdefault(end, []).append((_end_of_fan(third, start, end), start))
    exits = {}
    for at, found in fans.items():
        found.sort()
        for (_, arrives), (leaves, _) in zip(found, [*found[1:], found[0]], strict=True):
            exits[arrives, at] = leaves
    return exits


def _end_of_fan(third: dict[tuple[int, int], int], start: int, at: int) -> int:
    """Turn around `at`, from the face of the edge (start, at) on, to the last vertex of that fan."""
    turned = {start}
    while (start, at) in third and third[start, at] not in turned:
        start = third[start, at]
        turned.add(start)
    return start


def _walk(edges: IntArray, exits: dict[tuple[int, int], int]) -> tuple[list[list[int]], list[IntArray]]:
    """Follow boundary edges head to tail: a Python loop over vertices of boundaries that touch others."""
    # The ends to go on to, highest first; a dict finds and drops any one of them, and the last one, in constant time.
    following: dict[int, dict[int, None]] = {}
    for start, end in edges[np.lexsort((-edges[:, 1], edges[:, 0]))].tolist():
        following.setdefault(start, {})[end] = None
    closed: list[list[int]] = []
    chains: list[IntArray] = []
    # Chains that can't close begin where more edges leave than arrive: walk those first, or they would eat loops.
    n_vertices = int(edges.max(initial=-1)) + 1
    surplus = np.bincount(edges[:, 0], minlength=n_vertices) - np.bincount(edges[:, 1], minlength=n_vertices)
    starts = np.repeat(np.arange(n_vertices), np.maximum(surplus, 0)).tolist()
    for start in [*starts, *sorted(following)]:
        while following.get(start):
            walk = _walk_from(start, following, exits)
            if walk[-1] == start:
                closed.append(walk[:-1])
            else:
                chains.append(np.array(list(dict.fromkeys(walk)), np.int64))
    return closed, chains


def _walk_from(start: int, following: dict[int, dict[int, None]], exits: dict[tuple[int, int], int]) -> list[int]:
    """Use up edges from a vertex on, until the first one would come again or none is left."""
    first = _last(following[start])
    walk, before, at = [start], -1, start
    while following.get(at):
        leaving = following[at]
        wanted = exits.get((before, at))
        if at == start and wanted == first:
            break
        after = wanted if wanted is not None and wanted in leaving else _last(leaving)
        del leaving[after]
        walk.append(after)
        before, at = at, after
    return walk


def _last(leaving: dict[int, None]) -> int:
    """Return the last key; `reversed` would pass over all keys that were deleted at the end, time and again."""
    end, _ = leaving.popitem()
    leaving[end] = None
    return end


def _simple_loops(walk: list[int]) -> list[IntArray]:
    """Cut a closed walk at every vertex that it passes twice."""
    loops: list[IntArray] = []
    stack: list[int] = []
    on_stack: dict[int, int] = {}
    for vertex in [*walk, walk[0]]:
        if vertex in on_stack:
            at = on_stack[vertex]
            loops.append(np.array(stack[at:], np.int64))
            for gone in stack[at:]:
                del on_stack[gone]
            del stack[at:]
        on_stack[vertex] = len(stack)
        stack.append(vertex)
    return [loop for loop in loops if len(loop) >= 3]
