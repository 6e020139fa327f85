"""The geometric answer: holes closed, refined and faired.

It is the floor that learning must beat, and the carrier of the new vertices.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.filling.fairing import THIN_PLATE, Energy, fair, triangles_around
from quadpatch.filling.filled_mesh import FilledMesh, rim_diagonals
from quadpatch.filling.refinement import Refined, refine, relax
from quadpatch.filling.triangulation import EdgeSet, triangulate_loops
from quadpatch.mesh.averages import mean_by
from quadpatch.mesh.boundary import directed_edges
from quadpatch.mesh.normals import triangle_normals, unit, vertex_normals
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles

# The minimum variation surface asks for the Laplacian at the rim and at one ring of vertices outside it, and that for
# all triangles around these.
_RINGS = 2


# What the thin plate is compared with to see how far two sensible answers lie apart.
SECOND_OPINION = Energy(plate=1.0, variation=0.4)

# Fill and thin plate of one hole further apart than this share of its width: something ran away.
RUNAWAY_SHARE = 0.2


@dataclass(frozen=True)
class ClosedMesh:
    """Holes triangulated and refined, not faired to their end: what every energy starts from.

    Attributes
    ----------
    mesh : TriangleMesh
        The input.
    used : (n_local,) int64
        Input vertices next to a hole.
    centre : (3,) float64
        Origin of the local coordinates: far-away scans would lose digits without it.
    around : (k, 3) int64
        Input triangles next to a hole, in local vertices.
    plate : Refined
        The thin plate, in local vertices and coordinates.
    gap : (n_holes,) float64
        Mean distance between the plate and a slightly smoother surface, in mesh units: how far two sensible answers lie
        apart says how uncertain a hole is.
    rim_turn : (n_holes,) float64
        Mean length of the difference between the unit normals of neighbouring rim vertices: how rough or bent the
        surface is there.
    unfilled : list of int
    """

    mesh: TriangleMesh
    used: IntArray
    centre: FloatArray
    around: Triangles
    plate: Refined
    gap: FloatArray
    rim_turn: FloatArray
    unfilled: list[int]

    @property
    def n_holes(self) -> int:
        """Number of loops."""
        return len(self.gap)


def close_holes(mesh: TriangleMesh, loops: list[IntArray]) -> ClosedMesh:
    """Triangulate and refine boundary loops, and lay a thin plate over each.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        Simple loops with the surface on their left, as `boundary_loops` gives them.
    """
    near = _surroundings(mesh, loops)
    patch, unfilled = _close(near.vertices, near.around, near.loops, near.taken)
    # A first, crumpled fairing; its bulge makes room for more vertices, and its shape better weights.
    patch = _faired(patch, near.around, THIN_PLATE, uniform=True)
    patch = relax(refine(patch, near.taken), near.around, near.taken)
    plate = _faired(patch, near.around, THIN_PLATE)
    apart = _apart(_faired(plate, near.around, SECOND_OPINION), plate)
    gap = _mean_by_hole(plate, apart, len(loops))
    return ClosedMesh(mesh, near.used, near.centre, near.around, plate, gap, _rim_turn(near), unfilled)


def close_flat(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    """Triangulate and refine boundary loops and leave it at that: the closing that the paper starts from.

    New vertices lie on the flat triangles that span the rim.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        Simple loops with the surface on their left, as `boundary_loops` gives them.

    Returns
    -------
    FilledMesh
        Its gap and rim turn are NaN: nothing is known of its error.
    """
    near = _surroundings(mesh, loops)
    patch, unfilled = _close(near.vertices, near.around, near.loops, near.taken)
    unknown = np.full(len(loops), np.nan)
    return _appended(ClosedMesh(mesh, near.used, near.centre, near.around, patch, unknown, unknown, unfilled), patch)


def triangulate_holes(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    """Triangulate boundary loops, without new vertices: the plainest of all fills.

    Takes and returns what `close_flat` does.
    """
    near = _surroundings(mesh, loops)
    patch, unfilled = _triangulated(near.vertices, near.around, near.loops, near.taken)
    unknown = np.full(len(loops), np.nan)
    return _appended(ClosedMesh(mesh, near.used, near.centre, near.around, patch, unknown, unknown, unfilled), patch)


def fair_holes(closed: ClosedMesh, energy: Energy) -> FilledMesh:
    """Fair all holes by one energy.

    Returns
    -------
    FilledMesh
        The input's vertices and triangles are its bit-exact prefix.
    """
    return _appended(closed, _fair_patch(closed, energy))


@dataclass(frozen=True)
class _Surroundings:
    """The measured surface next to the holes, in vertices and coordinates of its own (see `ClosedMesh`)."""

    used: IntArray
    centre: FloatArray
    vertices: FloatArray
    around: Triangles
    loops: list[IntArray]
    taken: EdgeSet


def _surroundings(mesh: TriangleMesh, loops: list[IntArray]) -> _Surroundings:
    """Cut out what the filling reads: nothing in it looks further than two rings from a rim."""
    rim = np.unique(np.concatenate([np.zeros(0, np.int64), *loops]))
    near = triangles_around(mesh.triangles, rim, len(mesh.vertices), _RINGS)
    used, local = np.unique(mesh.triangles[near], return_inverse=True)
    around = local.reshape(-1, 3)
    centre = mesh.vertices[used].mean(axis=0) if len(used) else np.zeros(3)
    local_loops = [np.searchsorted(used, loop) for loop in loops]
    return _Surroundings(
        used, centre, mesh.vertices[used] - centre, around, local_loops, EdgeSet(directed_edges(around))
    )


def _appended(closed: ClosedMesh, patch: Refined) -> FilledMesh:
    """Put a fill in local vertices behind the mesh's own."""
    mesh, n_local = closed.mesh, len(closed.used)
    n_input = len(mesh.vertices)
    to_mesh = np.concatenate([closed.used, n_input + np.arange(len(patch.vertices) - n_local)])
    vertex_hole = np.zeros(len(patch.vertices), np.int64)
    vertex_hole[patch.triangles] = patch.hole[:, None]
    vertices = np.concatenate([mesh.vertices, patch.vertices[n_local:] + closed.centre])
    triangles = np.concatenate([mesh.triangles, to_mesh[patch.triangles]])
    return FilledMesh(
        TriangleMesh(vertices, triangles),
        n_input,
        len(mesh.triangles),
        patch.hole,
        vertex_hole[n_local:],
        closed.gap,
        closed.rim_turn,
        closed.unfilled,
    )


def _close(vertices: FloatArray, around: Triangles, loops: list[IntArray], taken: EdgeSet) -> tuple[Refined, list[int]]:
    """Triangulate and refine all loops."""
    patch, unfilled = _triangulated(vertices, around, loops, taken)
    return refine(patch, taken), unfilled


def _triangulated(
    vertices: FloatArray, around: Triangles, loops: list[IntArray], taken: EdgeSet
) -> tuple[Refined, list[int]]:
    edges = directed_edges(around)
    flat = triangulate_loops(loops, vertices, _rim_normals(vertices, around, loops), taken)
    found = [(i, triangles) for i, triangles in enumerate(flat) if triangles is not None]
    unfilled = [i for i, triangles in enumerate(flat) if triangles is None]
    triangles = np.concatenate([np.zeros((0, 3), np.int64), *(t for _, t in found)])
    hole = np.repeat(np.array([i for i, _ in found], np.int64), [len(t) for _, t in found])
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    count = np.bincount(edges.ravel(), minlength=len(vertices))
    spacing = np.bincount(edges.ravel(), np.repeat(lengths, 2), minlength=len(vertices)) / np.maximum(count, 1)
    return Refined(vertices, triangles, hole, spacing, len(vertices)), unfilled


def _rim_normals(vertices: FloatArray, around: Triangles, loops: list[IntArray]) -> list[FloatArray]:
    """Look up the unit normals of the faces at the rim edges of every loop; a bridge lies between its neighbours'."""
    normals = triangle_normals(vertices, around)
    edges = directed_edges(around)
    keys = edges[:, 0] * np.int64(len(vertices)) + edges[:, 1]
    order = np.argsort(keys)
    found = []
    for loop in loops:
        wanted = loop * np.int64(len(vertices)) + np.roll(loop, -1)
        at = order[np.searchsorted(keys, wanted, sorter=order).clip(max=len(keys) - 1)]
        of_loop = normals[at // 3]
        bridge = keys[at] != wanted
        if bridge.any():
            of_loop[bridge] = 0.0
            between = np.roll(of_loop, 1, axis=0) + np.roll(of_loop, -1, axis=0)
            of_loop[bridge] = unit(between[bridge])
        found.append(of_loop)
    return found


def _rim_turn(near: _Surroundings) -> FloatArray:
    normals = vertex_normals(near.vertices, near.around)
    turns = [np.linalg.norm(normals[loop] - normals[np.roll(loop, -1)], axis=1).mean() for loop in near.loops]
    return np.array(turns, np.float64)


def _fair_patch(closed: ClosedMesh, energy: Energy) -> Refined:
    """Fair twice, since the weights depend on the shape."""
    plate, around, n_holes = closed.plate, closed.around, closed.n_holes
    faired = _faired(_faired(plate, around, energy), around, energy)
    hole = _hole_of_new(plate)
    new = hole >= 0
    furthest = np.zeros(n_holes)
    np.maximum.at(furthest, hole[new], _apart(faired, plate)[new])
    # Curvature carried on from a ragged rim can run away; such a hole takes the thin plate.
    runaway = furthest > RUNAWAY_SHARE * rim_diagonals(
        plate.vertices, plate.triangles, plate.hole, plate.n_measured, n_holes
    )
    vertices = np.where((new & runaway[hole])[:, None], plate.vertices, faired.vertices)
    return replace(faired, vertices=vertices)


def _apart(one: Refined, other: Refined) -> FloatArray:
    """Distance (n,) between the places of every vertex."""
    return np.asarray(np.linalg.norm(one.vertices - other.vertices, axis=1))


def _hole_of_new(patch: Refined) -> IntArray:
    """Hole (n,) of every new vertex, -1 for measured ones."""
    hole = np.full(len(patch.vertices), -1)
    hole[patch.triangles] = patch.hole[:, None]
    hole[: patch.n_measured] = -1
    return hole


def _mean_by_hole(patch: Refined, values: FloatArray, n_holes: int) -> FloatArray:
    """Mean (n_holes,) of values (n,) over the new vertices of each hole; 0 without any."""
    hole = _hole_of_new(patch)
    new = hole >= 0
    return mean_by(hole[new], values[new], n_holes)


def _faired(patch: Refined, around: Triangles, energy: Energy, *, uniform: bool = False) -> Refined:
    triangles = np.concatenate([around, patch.triangles])
    return replace(patch, vertices=fair(patch.vertices, triangles, patch.is_new, energy, uniform=uniform))
