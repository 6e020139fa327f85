"""Fills that are kept free of folds and crossings on the way.

Three steps, each of which is checked. The rim is triangulated; triangles that run through surface are forbidden, and
the best triangulation without them is looked for, again and again. It is refined by splits, and by flips that do not
fold it. Last, the new vertices move towards the thin plate, and from there to the fill that was tried first, each of
them as far as no triangle at it folds or crosses: where one does, the way of its vertices is halved.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.filling.fairing import THIN_PLATE, triangles_around
from quadpatch.filling.faults import Faults, Folds, find_faults
from quadpatch.filling.fill import fair_refined
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.refinement import Refined, refine, relax
from quadpatch.filling.rim_neighbourhood import RimNeighbourhood
from quadpatch.filling.triangulation import Forbidden
from quadpatch.mesh.distance import nearest_points
from quadpatch.mesh.intersections import heights, touching_boxes
from quadpatch.mesh.normals import length, unit
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.topology import edge_keys
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Triangulations that are tried for one rim.
_MAX_TRIANGULATIONS = 64
# Times that the ways of vertices are halved; at the end of them a thousandth is left.
_MAX_HALVINGS = 10
# From this one on, the neighbours of a triangle that folds or crosses are held back with it.
_WIDER_FROM = 3
# A fill stays within the bounding box of its rim, made wider on each side by this share of its diagonal.
_MARGIN = 0.5
# A triangle that becomes lower than this share of its longest edge has collapsed.
_LEAST_HEIGHT = 0.02
# A vertex is drawn to the first fill where that is not farther away than this many edge lengths.
_NEAR = 1.0
# The surface at the ends of a chord, within this share of it, is its own.
_CHORD_END = 0.01


def fill_constrained(
    filled: FilledMesh, loops: list[IntArray], chosen: IntArray, obstacles: Triangles | None = None
) -> FilledMesh:
    """Fill some loops one after the other; each fill keeps clear of those before it.

    Parameters
    ----------
    filled : FilledMesh
        With the fills that were tried first. Those of the other loops are surface that may not be run into.
    loops : list of (n_loop,) int64
        All of them.
    chosen : (k,) int64
        Positions of those that are filled.
    obstacles : (m, 3) int64, optional
        Triangles of the file that the mesh leaves out, not to be run into either.

    Returns
    -------
    FilledMesh
        With the chosen fills alone. A loop for which no triangulation is free of crossings is in `unfilled`.
    """
    n = filled.n_measured_triangles
    part = _Part.of(filled.without(chosen), [loops[i] for i in chosen], obstacles)
    local, unfilled = part.filled, []
    for i, loop in zip(chosen.tolist(), part.loops, strict=True):
        first = TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[n:][filled.triangle_hole == i])
        fill = _OneHole(local, loop, i, part.obstacles, first).fill()
        if fill is None:
            unfilled.append(i)
        else:
            local = fill
    others = np.setdiff1d(np.arange(len(loops)), chosen)
    return part.put_back(local.without(others), filled, unfilled)


@dataclass(frozen=True)
class _Part:
    """The surface that some fills may run into, in vertices of its own: what follows costs as little as that is large.

    Attributes
    ----------
    filled : FilledMesh
    loops : list of (n_loop,) int64
        Those to be filled.
    obstacles : (m, 3) int64
    used : (n,) int64
        The vertices' indices in the whole.
    """

    filled: FilledMesh
    loops: list[IntArray]
    obstacles: Triangles
    used: IntArray

    @classmethod
    def of(cls, whole: FilledMesh, loops: list[IntArray], obstacles: Triangles | None) -> "_Part":
        vertices, triangles, n = whole.mesh.vertices, whole.mesh.triangles, whole.n_measured_triangles
        low, high = (np.array([bound(vertices[loop], axis=0) for loop in loops]) for bound in (np.min, np.max))
        margin = _MARGIN * np.linalg.norm(high - low, axis=1, keepdims=True)
        beyond = np.zeros((0, 3), np.int64) if obstacles is None else obstacles
        every = np.concatenate([triangles, beyond])
        near = touching_boxes(low - margin, high + margin, TriangleMesh(vertices, every))
        # What the fairing reads may lie outside of a small box.
        near[triangles_around(triangles[:n], np.concatenate(loops), len(vertices), 3)] = True
        chosen = np.flatnonzero(near)
        used, local = np.unique(every[chosen], return_inverse=True)
        local = local.reshape(-1, 3)
        new = chosen[(chosen >= n) & (chosen < len(triangles))]
        n_measured = int((chosen < n).sum())
        is_new_vertex = used >= whole.n_measured_vertices
        filled = replace(
            whole,
            mesh=TriangleMesh(vertices[used], local[: n_measured + len(new)]),
            n_measured_vertices=int((~is_new_vertex).sum()),
            n_measured_triangles=n_measured,
            triangle_hole=whole.triangle_hole[new - n],
            vertex_hole=whole.vertex_hole[used[is_new_vertex] - whole.n_measured_vertices],
        )
        return cls(filled, [np.searchsorted(used, loop) for loop in loops], local[n_measured + len(new) :], used)

    def put_back(self, fills: FilledMesh, whole: FilledMesh, unfilled: list[int]) -> FilledMesh:
        """Put fills of the part behind the measured surface of the whole."""
        n_local, n = fills.n_measured_vertices, whole.n_measured_vertices
        new_vertices = fills.mesh.vertices[n_local:]
        to_whole = np.concatenate([self.used[:n_local], n + np.arange(len(new_vertices))])
        vertices = np.concatenate([whole.mesh.vertices[:n], new_vertices])
        new = to_whole[fills.mesh.triangles[fills.n_measured_triangles :]]
        triangles = np.concatenate([whole.mesh.triangles[: whole.n_measured_triangles], new])
        return replace(
            whole,
            mesh=TriangleMesh(vertices, triangles),
            triangle_hole=fills.triangle_hole,
            vertex_hole=fills.vertex_hole,
            unfilled=unfilled,
        )


class _OneHole:
    """One loop to be filled, and the surface around it."""

    def __init__(
        self, filled: FilledMesh, loop: IntArray, position: int, obstacles: Triangles, first: TriangleMesh
    ) -> None:
        self._filled, self._position, self._obstacles, self._first = filled, position, obstacles, first
        self._near = RimNeighbourhood.of(filled.measured, [loop])
        vertices = filled.measured.vertices
        self._is_single = np.array_equal(vertices, vertices.astype(np.float32))

    def fill(self) -> FilledMesh | None:
        patch = self._triangulation()
        if patch is None:
            return None
        near = self._near
        refined = refine(patch, near.edges, near.adjacent_triangles)
        if self._faults(refined).crossings[self._position]:
            refined = refine(patch, near.edges, flip=False)
        refined = self._moved(
            refined, fair_refined(refined, near.adjacent_triangles, THIN_PLATE, uniform=True).vertices
        )
        refined = self._moved(refined, self._turned_outwards(refined))
        if not self._holds(refined):
            return self._with(patch)
        denser = refine(refined, near.edges, near.adjacent_triangles)
        for start in (relax(denser, near.adjacent_triangles, near.edges, near.adjacent_triangles), denser):
            if self._holds(start):
                refined = start
                break
        plate = self._moved(refined, fair_refined(refined, near.adjacent_triangles, THIN_PLATE).vertices)
        return self._with(self._moved(plate, self._nearest_on_first(plate)))

    def _nearest_on_first(self, patch: Refined) -> Vertices:
        """Give the points (n, 3) of the first fill that lie nearest to the new vertices, where they are near."""
        points, new = patch.vertices.copy(), np.flatnonzero(patch.is_new)
        if not len(self._first.triangles) or not len(new):
            return points
        nearest = nearest_points(points[new] + self._near.centre, self._first) - self._near.centre
        is_near = np.linalg.norm(nearest - points[new], axis=1) <= _NEAR * patch.spacing[new]
        points[new[is_near]] = nearest[is_near]
        return points

    def _turned_outwards(self, patch: Refined) -> Vertices:
        """Give places (n, 3) for new vertices whose triangles fold at the rim: beyond it, where the surface points."""
        points, filled, folds = patch.vertices.copy(), self._with(patch), self._faults(patch).folds
        vertices, triangles = filled.mesh.vertices, filled.mesh.triangles
        pairs, edges = np.sort(folds.pairs, axis=1), folds.edges
        at_rim = pairs[:, 0] < filled.n_measured_triangles
        (measured, new), edges = pairs[at_rim].T, edges[at_rim]
        is_opposite = (triangles[new][:, :, None] != edges[:, None]).all(axis=2)
        apex = patch.triangles[new - len(self._filled.mesh.triangles)][is_opposite]
        behind = triangles[measured][(triangles[measured][:, :, None] != edges[:, None]).all(axis=2)]
        start, along = vertices[edges[:, 0]], unit(vertices[edges[:, 1]] - vertices[edges[:, 0]])
        inwards, height = vertices[behind] - start, vertices[triangles[new][is_opposite]] - start
        inwards, height = (rows - np.einsum("ij,ij->i", rows, along)[:, None] * along for rows in (inwards, height))
        outwards = vertices[edges].mean(axis=1) - length(height)[:, None] * unit(inwards) - self._near.centre
        is_new = patch.is_new[apex]
        points[apex[is_new]] = outwards[is_new]
        return points

    def _triangulation(self) -> Refined | None:
        """Find the triangulation of least turns among those without crossings; None where none was found."""
        forbidden = Forbidden(self._near.edges)
        for attempt in range(_MAX_TRIANGULATIONS):
            patch, unfilled = self._near.triangulate(forbidden)
            if unfilled:
                return None
            crossing = self._new(self._faults(patch).crossing_triangles, patch)
            if not len(crossing):
                return patch
            if attempt == 0:
                forbidden = forbidden.with_edges(self._blocked_chords())
            forbidden = replace(forbidden, triangles=np.concatenate([forbidden.triangles, patch.triangles[crossing]]))
        return None

    def _blocked_chords(self) -> IntArray:
        """Chords (n, 2) of the loop that run through surface; a guess, since rays may miss what they graze."""
        (loop,) = self._near.loops
        first, second = np.triu_indices(len(loop), 2)
        points = self._near.vertices[loop]
        size = np.linalg.norm(points[second] - points[first], axis=1)
        # The first vertex and the last are joined by a rim edge; one that is walked twice comes back to its vertices.
        is_chord = (size > 0) & (second - first < len(loop) - 1)
        first, second, size = (rows[is_chord] for rows in (first, second, size))
        start, chord = points[first], points[second] - points[first]
        surface = np.concatenate([self._filled.mesh.triangles, self._obstacles])
        scene = RayScene(TriangleMesh(self._filled.mesh.vertices - self._near.centre, surface))
        hit, distance = scene.cast(start + _CHORD_END * chord, chord, float(size.max(initial=0.0)))
        blocked = (hit >= 0) & (distance < (1 - 2 * _CHORD_END) * size)
        return np.stack([loop[first[blocked]], loop[second[blocked]]], axis=1)

    def _moved(self, patch: Refined, target: Vertices) -> Refined:
        """Move new vertices towards their targets (n, 3), each as far as nothing at it folds, crosses or collapses.

        What folds before may stay folded.
        """
        is_low = heights(patch.vertices, patch.triangles) < _LEAST_HEIGHT
        before = self._faults(patch).folds
        share = np.ones(len(patch.vertices))
        for halving in range(_MAX_HALVINGS):
            moved = _between(patch, target, share)
            collapsed = np.flatnonzero(~is_low & (heights(moved.vertices, moved.triangles) < _LEAST_HEIGHT))
            faulty = np.union1d(self._new(_faulty_triangles(self._faults(moved), before), moved), collapsed)
            if not len(faulty):
                return moved
            held = _corners(patch, faulty)
            if halving >= _WIDER_FROM:
                held = _corners(patch, np.flatnonzero(held[patch.triangles].any(axis=1)))
            share[held] /= 2
        return patch

    def _holds(self, patch: Refined) -> bool:
        return not len(self._faults(patch).doubtful_triangles)

    def _faults(self, patch: Refined) -> Faults:
        return find_faults(self._with(patch), np.array([self._position]), self._obstacles)

    def _with(self, patch: Refined) -> FilledMesh:
        """Put a fill of the loop behind the others, in the precision of the measured coordinates.

        Fills that keep clear of surface by little would not do so in a file of single precision otherwise.
        """
        fill = self._near.filled(patch, [])
        if self._is_single:
            new = fill.mesh.vertices[fill.n_measured_vertices :]
            fill = fill.with_vertices(new.astype(np.float32).astype(np.float64))
        chosen = np.array([self._position])
        return self._filled.with_fills(fill.as_part_of(chosen, self._filled), chosen)

    def _new(self, triangles: IntArray, patch: Refined) -> IntArray:
        """Triangles of the patch among those of the mesh that ends with it."""
        first = len(self._filled.mesh.triangles)
        return triangles[triangles >= first] - first


def _faulty_triangles(faults: Faults, before: Folds) -> IntArray:
    """Triangles (n,) that cross others, or fold where they did not before and the measured surface does not."""
    pairs, n = faults.folds.pairs, 1 + int(max(faults.folds.pairs.max(initial=0), before.pairs.max(initial=0)))
    is_new = ~faults.folds.is_tolerated & ~np.isin(edge_keys(pairs, n), edge_keys(before.pairs, n))
    return np.union1d(pairs[is_new], faults.crossing_triangles)


def _between(patch: Refined, target: Vertices, share: FloatArray) -> Refined:
    return replace(patch, vertices=patch.vertices + share[:, None] * (target - patch.vertices))


def _corners(patch: Refined, triangles: IntArray) -> BoolArray:
    corners = np.zeros(len(patch.vertices), bool)
    corners[patch.triangles[triangles]] = True
    return corners
