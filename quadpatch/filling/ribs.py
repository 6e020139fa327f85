"""Ribs: narrow bands of triangles across the gap between two rims, one at either end of a strip that joins them.

A strip between two outer borders has two ends that no measured surface bounds. There a rib continues the surface of
both sides by cubic curves. With a rib at either end, what is left of the gap is a hole with a closed rim, which is
filled like any other. Until then a rib counts as measured.
"""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.intersections import crossing_pairs, touching_boxes
from quadpatch.mesh.normals import triangle_normals
from quadpatch.mesh.topology import compacted
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Rim edges that are tried on either side, from the open end inwards, and the least cosine between the normals of a rib
# and those of its rims.
_PLACES = 8
_LEAST_FACING = 0.3
# Least angle between a rib and the rim behind it, in radians.
_LEAST_ROOM = 0.35


@dataclass(frozen=True)
class Ribs:
    """The ribs of some bridges.

    Attributes
    ----------
    vertices : (n, 3) float64
        New ones; they count behind those of the mesh.
    triangles : (m, 3) int64
    vertex_bridge, triangle_bridge : (n,), (m,) int64
        Which bridge each of them belongs to.
    """

    vertices: Vertices
    triangles: Triangles
    vertex_bridge: IntArray
    triangle_bridge: IntArray

    def added_to(self, mesh: TriangleMesh) -> TriangleMesh:
        """Put the ribs behind the surface of a mesh."""
        if not len(self.triangles):
            return mesh
        return TriangleMesh(
            np.concatenate([mesh.vertices, self.vertices]), np.concatenate([mesh.triangles, self.triangles])
        )

    def told_apart(self, filled: FilledMesh, loop_of_bridge: IntArray) -> FilledMesh:
        """Count ribs among what was invented, where they stand at the end of the measured surface.

        Parameters
        ----------
        filled : FilledMesh
        loop_of_bridge : (n_bridges,) int64
            Position of each bridge's loop. The ribs of loops without a fill are left out.
        """
        if not len(self.triangles):
            return filled
        whole = replace(
            filled,
            n_measured_vertices=filled.n_measured_vertices - len(self.vertices),
            n_measured_triangles=filled.n_measured_triangles - len(self.triangles),
            vertex_hole=np.concatenate([loop_of_bridge[self.vertex_bridge], filled.vertex_hole]),
            triangle_hole=np.concatenate([loop_of_bridge[self.triangle_bridge], filled.triangle_hole]),
        )
        return whole.without(np.setdiff1d(loop_of_bridge, filled.triangle_hole))


@dataclass(frozen=True)
class RibEnd:
    """Where a rib begins or ends, on one of the rims.

    Attributes
    ----------
    outer, inner : int
        Vertices of the rim edge that it joins: the one at the open end of the strip, the one inside.
    normals : (2, 3) float64
        Of the surface at both.
    beyond : int
        The vertex of the rim that follows the inner one.
    """

    outer: int
    inner: int
    normals: FloatArray
    beyond: int = -1


@dataclass(frozen=True)
class RibSide:
    """Where a rib may begin or end on one of the rims.

    Attributes
    ----------
    vertices : (n,) int64
        Of the rim, from the open end of the strip inwards.
    normals : (n, 3) float64
        Of the surface there.
    """

    vertices: IntArray
    normals: FloatArray

    def end(self, position: int) -> RibEnd:
        """Take the rim edge at a position."""
        outer, inner, beyond = self.vertices[position : position + 3].tolist()
        return RibEnd(outer, inner, self.normals[position : position + 2], beyond)


@dataclass(frozen=True)
class Rib:
    """One rib.

    Attributes
    ----------
    vertices : (n, 3) float64
        New ones, those of the outer curve first.
    triangles : (m, 3) int64
    inner : (k,) int64
        Vertices of the inner curve, from the first rim to the second.
    """

    vertices: Vertices
    triangles: Triangles
    inner: IntArray


def make_clear_rib(
    mesh: TriangleMesh, sides: tuple[RibSide, RibSide], edge: float, n_vertices: int, *, is_forward: bool
) -> tuple[Rib, tuple[int, int]]:
    """Lay a rib as near to the open end of a strip as it neither runs through surface nor folds.

    Parameters
    ----------
    mesh : TriangleMesh
    sides : pair of RibSide
    edge, n_vertices, is_forward
        See `make_rib`.

    Returns
    -------
    rib : Rib
        That at the open end, where none is clear.
    places : (int, int)
        Positions of its outer vertices on both sides.
    """
    first, second = sides
    counts = [range(min(len(side.vertices) // 2, _PLACES)) for side in sides]
    surroundings = _surroundings(mesh, np.concatenate([side.vertices[: _PLACES + 1] for side in sides]))
    for i, j in sorted(product(*counts), key=lambda place: (sum(place), abs(place[0] - place[1]))):
        ends = first.end(i), second.end(j)
        tried = make_rib(mesh.vertices, ends, edge, len(mesh.vertices), is_forward=is_forward)
        if _is_clear(mesh, tried, surroundings, ends):
            return make_rib(mesh.vertices, ends, edge, n_vertices, is_forward=is_forward), (i, j)
    return make_rib(mesh.vertices, (first.end(0), second.end(0)), edge, n_vertices, is_forward=is_forward), (0, 0)


def _surroundings(mesh: TriangleMesh, vertices: IntArray) -> Triangles:
    """Triangles (n, 3) of a mesh in the box around some of its vertices, made wider by its own size."""
    low, high = mesh.vertices[vertices].min(axis=0), mesh.vertices[vertices].max(axis=0)
    margin = np.linalg.norm(high - low)
    return mesh.triangles[touching_boxes((low - margin)[None], (high + margin)[None], mesh)]


def _is_clear(mesh: TriangleMesh, rib: Rib, surroundings: Triangles, ends: tuple[RibEnd, RibEnd]) -> bool:
    """Whether a rib, whose new vertices follow those of the mesh, runs through nothing and leaves room for the fill."""
    points = np.concatenate([mesh.vertices, rib.vertices])
    facing = triangle_normals(points, rib.triangles) @ np.concatenate([end.normals for end in ends]).mean(axis=0)
    following = points[rib.inner[1]], points[rib.inner[-2]]
    rooms = [_room(points, end, at) for end, at in zip(ends, following, strict=True)]
    if (facing < _LEAST_FACING).any() or min(rooms) < _LEAST_ROOM:
        return False
    used, local = compacted(np.concatenate([rib.triangles, surroundings]), len(points))
    pairs = crossing_pairs(TriangleMesh(points[used], local), len(rib.triangles))
    return not (pairs < len(rib.triangles)).any()


def _room(points: Vertices, end: RibEnd, following: FloatArray) -> float:
    """Angle at the inner vertex, seen along the normal, that a rib leaves between itself and the rim; in radians."""
    normal, here = end.normals[1], points[end.inner]
    x = points[end.outer] - here
    x = x - (x @ normal) * normal
    y = np.cross(normal, x)
    of_rib, of_rim = (float(np.arctan2(way @ y, way @ x)) for way in (following - here, points[end.beyond] - here))
    # The rib turns one way or the other from its own edge; the rim follows behind it.
    return (of_rim if of_rib >= 0 else -of_rim) % (2 * np.pi) - abs(of_rib)


def make_rib(points: Vertices, ends: tuple[RibEnd, RibEnd], edge: float, n_vertices: int, *, is_forward: bool) -> Rib:
    """Lay a rib across a gap.

    Parameters
    ----------
    points : (n_points, 3) float64
        Of the mesh.
    ends : pair of RibEnd
    edge : float
        Wanted length of its edges, in mesh units.
    n_vertices : int
        Number of the first new vertex.
    is_forward : bool
        Whether the first rim runs outwards, to the open end, with the surface on its left.
    """
    first, second = ends
    gap = float(np.linalg.norm(points[second.outer] - points[first.outer]))
    count = max(round(gap / edge) - 1, 0)
    curves = [
        _curve(points[start], points[end], first.normals[k], second.normals[k], count)
        for k, (start, end) in enumerate(((first.outer, second.outer), (first.inner, second.inner)))
    ]
    new = n_vertices + np.arange(2 * count).reshape(2, count)
    outer = np.concatenate([[first.outer], new[0], [second.outer]])
    inner = np.concatenate([[first.inner], new[1], [second.inner]])
    triangles = np.concatenate(
        [
            np.stack([outer[:-1], inner[:-1], inner[1:]], axis=1),
            np.stack([outer[:-1], inner[1:], outer[1:]], axis=1),
        ]
    )
    return Rib(np.concatenate(curves), triangles if is_forward else triangles[:, ::-1], inner)


def _curve(
    start: FloatArray, end: FloatArray, start_normal: FloatArray, end_normal: FloatArray, count: int
) -> Vertices:
    """Points (count, 3) inside a cubic curve (Hermite) that leaves and arrives in the planes of two normals.

    Where these are those of a round surface, the curve is as near to the arc of a circle as a cubic can be.
    """
    chord = end - start
    leaves, arrives = (_in_plane(chord, normal) for normal in (start_normal, end_normal))
    s = (np.arange(1, count + 1) / (count + 1))[:, None]
    return np.asarray(
        (2 * s**3 - 3 * s**2 + 1) * start
        + (s**3 - 2 * s**2 + s) * leaves
        + (3 * s**2 - 2 * s**3) * end
        + (s**3 - s**2) * arrives
    )


def _in_plane(chord: FloatArray, normal: FloatArray) -> FloatArray:
    """Turn a chord (3,) into the plane of a normal: the velocity of a cubic curve there."""
    inside = chord - (chord @ normal) * normal
    size = float(np.linalg.norm(chord))
    cosine = float(np.linalg.norm(inside)) / max(size, np.finfo(float).tiny)
    # The velocity 4 r tan(t / 4) for an arc of angle t, whose chord is 2 r sin(t / 2) and turned by half of t.
    return np.asarray(inside / max(cosine, np.finfo(float).tiny) * 2 / (1 + cosine))
