"""The measured surface next to holes, which is all that filling them reads."""

from collections import Counter
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from quadpatch.filling.fairing import triangles_around
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.refinement import Grading, Refined
from quadpatch.filling.triangulation import EdgeSet, Forbidden, triangulate_loops
from quadpatch.mesh.intersections import LEAST_HEIGHT, heights
from quadpatch.mesh.loops import cut_at, laid_out
from quadpatch.mesh.normals import length, triangle_normals, unit, vertex_normals
from quadpatch.mesh.topology import compacted, directed_edges, edges_found
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles

# The minimum variation surface asks for the Laplacian at the rim and at one ring of vertices outside it, and that for
# all triangles around these.
_RINGS = 2
# Corners of a triangle, from each of them on.
_TURNS = [[0, 1, 2], [1, 2, 0], [2, 0, 1]]
# A loop keeps at least so many vertices.
_SHORTEST_LOOP = 3
_ENDS = 2

# Three vertices that follow each other on a loop.
Corner = tuple[int, int, int]


@dataclass(frozen=True)
class RimNeighbourhood:
    """The measured surface next to holes, in vertices and coordinates of its own.

    Attributes
    ----------
    mesh : TriangleMesh
        The input.
    used : (n_local,) int64
        Input vertices next to a hole.
    centre : (3,) float64
        Origin of the local coordinates: far-away scans would lose digits without it.
    vertices : (n_local, 3) float64
    adjacent_triangles : (k, 3) int64
        Input triangles next to a hole, in local vertices.
    loops : list of (n_loop,) int64
        In local vertices.
    edges : EdgeSet
        Those of the input triangles.
    flat_corners : (j, 3) int64
        Rim vertices that `straightened` took out, each between its neighbours on the rim.
    """

    mesh: TriangleMesh
    used: IntArray
    centre: FloatArray
    vertices: FloatArray
    adjacent_triangles: Triangles
    loops: list[IntArray]
    edges: EdgeSet
    flat_corners: IntArray = field(default_factory=lambda: np.zeros((0, 3), np.int64))

    @classmethod
    def of(cls, mesh: TriangleMesh, loops: list[IntArray]) -> "RimNeighbourhood":
        """Cut out what the filling reads: nothing in it looks further than two rings from a rim."""
        rim = np.concatenate([np.zeros(0, np.int64), *loops])
        near = triangles_around(mesh.triangles, rim, len(mesh.vertices), _RINGS)
        used, adjacent_triangles = compacted(mesh.triangles[near], len(mesh.vertices))
        centre = mesh.vertices[used].mean(axis=0) if len(used) else np.zeros(3)
        local_loops = cut_at(np.searchsorted(used, rim), laid_out(loops)[0])
        edges = EdgeSet(directed_edges(adjacent_triangles))
        return cls(mesh, used, centre, mesh.vertices[used] - centre, adjacent_triangles, local_loops, edges)

    def straightened(self) -> "RimNeighbourhood":
        """Take out of the loops the tips of triangles without a height, which lie on an edge of the next triangle.

        A fill may touch that triangle nowhere but in such a tip, and rounding decides whether it runs through it. So
        the fill is made along the edge, and `with_flat_corners` divides its triangle there.
        """
        turns = self.adjacent_triangles[heights(self.vertices, self.adjacent_triangles) < LEAST_HEIGHT][:, _TURNS]
        a, tip, b = turns.reshape(-1, 3).T
        is_between = (
            np.einsum("ij,ij->i", self.vertices[a] - self.vertices[tip], self.vertices[b] - self.vertices[tip]) < 0
        )
        flat = set(zip(*(row[is_between].tolist() for row in (a, tip, b)), strict=True))
        if not flat:
            return self
        is_tip = np.zeros(len(self.vertices), bool)
        is_tip[tip[is_between]] = True
        loops, taken = list(self.loops), list[Corner]()
        owner = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
        for i in np.unique(owner[is_tip[np.concatenate(loops)]]).tolist():
            loops[i] = _without_flat_corners(loops[i], flat, taken)
        return replace(self, loops=loops, flat_corners=np.array(taken, np.int64).reshape(-1, 3))

    def with_flat_corners(self, patch: Refined) -> Refined:
        """Put the vertices that `straightened` took out back, each on the edge between its neighbours."""
        if not len(self.flat_corners):
            return patch
        is_near = np.zeros(len(patch.vertices), bool)
        is_near[self.flat_corners] = True
        near = np.flatnonzero(is_near[patch.triangles].sum(axis=1) >= _ENDS)
        triangles, hole = patch.triangles[near].tolist(), patch.hole[near].tolist()
        at_edge = {(t[k - 1], t[k]): i for i, t in enumerate(triangles) for k in range(3)}
        # Loops without a fill have no triangle there.
        for a, tip, b in self.flat_corners[::-1].tolist():
            i = at_edge.pop((b, a), None)
            if i is None:
                continue
            (apex,) = set(triangles[i]) - {a, b}
            at_edge |= {(b, tip): i, (tip, a): len(triangles), (a, apex): len(triangles)}
            triangles[i] = [b, tip, apex]
            triangles.append([tip, a, apex])
            hole.append(hole[i])
        rest = np.delete(np.arange(len(patch.triangles)), near)
        return replace(
            patch,
            triangles=np.concatenate([patch.triangles[rest], np.array(triangles, np.int64).reshape(-1, 3)]),
            hole=np.concatenate([patch.hole[rest], np.array(hole, np.int64)]),
        )

    @cached_property
    def triangulation(self) -> tuple[Refined, list[int]]:
        """All loops triangulated as `triangulate` does, with no edge that exists already."""
        return self.triangulate()

    @cached_property
    def grading(self) -> Grading | None:
        """How fills may be graded, see `quadpatch.filling.refinement.Grading`."""
        return Grading.of(self.triangulation[0].spacing, self.vertices, self.loops)

    def triangulate(self, forbidden: Forbidden | None = None) -> tuple[Refined, list[int]]:
        """Triangulate all loops, without new vertices.

        Parameters
        ----------
        forbidden : Forbidden, optional
            In local vertices; without, the edges that exist.

        Returns
        -------
        patch : Refined
        unfilled : list of int
            Positions of loops that have no triangulation.
        """
        at_rims = _rim_normals(self.vertices, self.adjacent_triangles, self.loops)
        rim_normals = cut_at(at_rims, laid_out(self.loops)[0])
        flat = triangulate_loops(self.loops, self.vertices, rim_normals, forbidden or Forbidden(self.edges))
        found = [(i, triangles) for i, triangles in enumerate(flat) if triangles is not None]
        unfilled = [i for i, triangles in enumerate(flat) if triangles is None]
        triangles = np.concatenate([np.zeros((0, 3), np.int64), *(t for _, t in found)])
        hole = np.repeat(np.array([i for i, _ in found], np.int64), [len(t) for _, t in found])
        return Refined(self.vertices, triangles, hole, self._spacing(), len(self.vertices)), unfilled

    def _spacing(self) -> FloatArray:
        """Mean length (n_local,) of the edges at every vertex, save those to flat corners; 0 without any."""
        edges = directed_edges(self.adjacent_triangles)
        edges = edges[~np.isin(edges, self.flat_corners[:, 1]).any(axis=1)]
        lengths = np.linalg.norm(self.vertices[edges[:, 0]] - self.vertices[edges[:, 1]], axis=1)
        count = np.bincount(edges.ravel(), minlength=len(self.vertices))
        total = np.bincount(edges.ravel(), np.repeat(lengths, 2), minlength=len(self.vertices))
        return np.asarray(total / np.maximum(count, 1))

    def rim_variation(self) -> FloatArray:
        """Mean length (n_loops,) of the difference between the unit normals of neighbouring rim vertices."""
        if not self.loops:
            return np.zeros(0)
        starts, following = laid_out(self.loops)
        normals = vertex_normals(self.vertices, self.adjacent_triangles)[np.concatenate(self.loops)]
        turns = np.add.reduceat(length(normals[following] - normals), starts[:-1])
        return np.asarray(turns / np.diff(starts))

    def filled(
        self,
        patch: Refined,
        unfilled: list[int],
        disagreement: FloatArray | None = None,
        rim_variation: FloatArray | None = None,
    ) -> FilledMesh:
        """Put a fill in local vertices behind the mesh's own; without disagreement and variation, they are NaN."""
        mesh, n_local = self.mesh, len(self.used)
        n_input = len(mesh.vertices)
        unknown = np.full(len(self.loops), np.nan)
        to_mesh = np.concatenate([self.used, n_input + np.arange(len(patch.vertices) - n_local)])
        vertex_hole = np.zeros(len(patch.vertices), np.int64)
        vertex_hole[patch.triangles] = patch.hole[:, None]
        vertices = np.concatenate([mesh.vertices, patch.vertices[n_local:] + self.centre])
        triangles = np.concatenate([mesh.triangles, to_mesh[patch.triangles]])
        return FilledMesh(
            TriangleMesh(vertices, triangles),
            n_input,
            len(mesh.triangles),
            patch.hole,
            vertex_hole[n_local:],
            unknown if disagreement is None else disagreement,
            unknown if rim_variation is None else rim_variation,
            unfilled,
        )


def _without_flat_corners(loop: IntArray, flat: set[Corner], taken: list[Corner]) -> IntArray:
    """Take corners out of a loop, and note each between the neighbours that it had then, in one walk after another.

    Where one is taken out, the next one may come to lie between its neighbours. What a loop passes twice stays.
    """
    vertices, twice = loop.tolist(), {vertex for vertex, n in Counter(loop.tolist()).items() if n > 1}
    n_before = -1
    while len(vertices) != n_before:
        n_before = n_left = len(vertices)
        kept: list[int] = []
        for i, vertex in enumerate(vertices):
            following = vertices[i + 1] if i + 1 < n_before else kept[0]
            corner = (kept[-1] if kept else vertices[-1], vertex, following)
            if corner in flat and n_left > _SHORTEST_LOOP and vertex not in twice:
                taken.append(corner)
                n_left -= 1
            else:
                kept.append(vertex)
        vertices = kept
    return np.array(vertices, np.int64)


def _rim_normals(vertices: FloatArray, adjacent_triangles: Triangles, loops: list[IntArray]) -> FloatArray:
    """Look up the unit normals (n, 3) of the faces at the edges of loops that are laid end to end.

    That of an edge that joins two rims lies between its neighbours'.
    """
    _, following = laid_out(loops)
    start = np.concatenate([np.zeros(0, np.int64), *loops])
    at = edges_found(adjacent_triangles, start, start[following], len(vertices))
    normals = triangle_normals(vertices, adjacent_triangles)[at // 3]
    joining = np.flatnonzero(at < 0)
    if len(joining):
        normals[joining] = 0.0
        before = np.empty_like(following)
        before[following] = np.arange(len(following))
        normals[joining] = unit(normals[before[joining]] + normals[following[joining]])
    return normals
