"""The geometric answer: every chosen hole closed, refined and faired.

It is the floor that learning must beat, and the carrier of the new vertices.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.filling.fairing import PLATE_LENGTH, fair, triangles_around
from quadpatch.filling.refinement import Refined, refine, relax
from quadpatch.filling.triangulation import EdgeSet, triangulate_loops
from quadpatch.mesh.boundary import directed_edges
from quadpatch.mesh.normals import triangle_normals
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles

# The minimum variation surface takes position, slope and curvature from three rings of vertices, and the
# Laplacian of the third needs the triangles around it.
_RINGS = 4

# Fill and thin plate of one hole further apart than this share of its width: something ran away.
RUNAWAY_SHARE = 0.2


@dataclass(frozen=True)
class FilledMesh:
    """A mesh with its holes closed: measured vertices and triangles first, unchanged, invented ones behind them.

    Attributes
    ----------
    mesh : TriangleMesh
    n_measured_vertices, n_measured_triangles : int
    triangle_hole : (n_invented_triangles,) int64
        Position in the list of loops of every invented triangle's hole.
    vertex_hole : (n_invented_vertices,) int64
    gap : (n_loops,) float64
        Mean distance between this fill and the thin plate through the same rim, in mesh units: how far two
        sensible answers lie apart is how uncertain the hole is.
    unfilled : list of int
        Positions of loops that could not be closed without giving an edge a third face.
    """

    mesh: TriangleMesh
    n_measured_vertices: int
    n_measured_triangles: int
    triangle_hole: IntArray
    vertex_hole: IntArray
    gap: FloatArray
    unfilled: list[int]

    @property
    def invented_triangles(self) -> BoolArray:
        """(n_triangles,) bool, True = invented."""
        return np.arange(len(self.mesh.triangles)) >= self.n_measured_triangles

    @property
    def invented_vertices(self) -> BoolArray:
        """(n_vertices,) bool, True = invented."""
        return np.arange(len(self.mesh.vertices)) >= self.n_measured_vertices

    def with_vertices(self, invented: FloatArray) -> "FilledMesh":
        """Return the same mesh with other positions (n_invented_vertices, 3) of the invented vertices."""
        vertices = np.concatenate([self.mesh.vertices[: self.n_measured_vertices], invented])
        return replace(self, mesh=TriangleMesh(vertices, self.mesh.triangles))


def fill_holes(mesh: TriangleMesh, loops: list[IntArray]) -> FilledMesh:
    """Close boundary loops with a faired surface.

    Parameters
    ----------
    mesh : TriangleMesh
    loops : list of (n_loop,) int64
        Simple loops with the surface on their left, as `boundary_loops` gives them.

    Returns
    -------
    FilledMesh
        The input's vertices and triangles are its bit-exact prefix.
    """
    if not loops:
        none = np.zeros(0, np.int64)
        return FilledMesh(mesh, len(mesh.vertices), len(mesh.triangles), none, none, np.zeros(0), [])
    rim = np.unique(np.concatenate(loops))
    # Nothing below looks further than four rings from a rim: work on that part alone.
    near = triangles_around(mesh.triangles, rim, len(mesh.vertices), _RINGS)
    used, local = np.unique(mesh.triangles[near], return_inverse=True)
    around = local.reshape(-1, 3)
    vertices = mesh.vertices[used]
    centre = vertices.mean(axis=0)
    local_loops = [np.searchsorted(used, loop) for loop in loops]
    taken = EdgeSet(directed_edges(around))
    patch, unfilled = _close(vertices - centre, around, local_loops, taken)
    patch, gap = _fair_patch(patch, around, taken, len(loops))
    n_local, n_input = len(used), len(mesh.vertices)
    to_mesh = np.concatenate([used, n_input + np.arange(len(patch.vertices) - n_local)])
    vertex_hole = np.zeros(len(patch.vertices), np.int64)
    vertex_hole[patch.triangles] = patch.hole[:, None]
    return FilledMesh(
        TriangleMesh(
            np.concatenate([mesh.vertices, patch.vertices[n_local:] + centre]),
            np.concatenate([mesh.triangles, to_mesh[patch.triangles]]),
        ),
        n_input,
        len(mesh.triangles),
        patch.hole,
        vertex_hole[n_local:],
        gap,
        unfilled,
    )


def _close(vertices: FloatArray, around: Triangles, loops: list[IntArray], taken: EdgeSet) -> tuple[Refined, list[int]]:
    """Triangulate and refine all loops."""
    edges = directed_edges(around)
    flat = triangulate_loops(loops, vertices, _rim_normals(vertices, around, loops), taken)
    found = [(i, triangles) for i, triangles in enumerate(flat) if triangles is not None]
    unfilled = [i for i, triangles in enumerate(flat) if triangles is None]
    triangles = np.concatenate([np.zeros((0, 3), np.int64), *(t for _, t in found)])
    hole = np.repeat(np.array([i for i, _ in found], np.int64), [len(t) for _, t in found])
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    count = np.bincount(edges.ravel(), minlength=len(vertices))
    spacing = np.bincount(edges.ravel(), np.repeat(lengths, 2), minlength=len(vertices)) / np.maximum(count, 1)
    return refine(Refined(vertices, triangles, hole, spacing, len(vertices)), taken), unfilled


def _rim_normals(vertices: FloatArray, around: Triangles, loops: list[IntArray]) -> list[FloatArray]:
    """Unit normals of the faces at the rim edges of every loop."""
    normals = triangle_normals(vertices, around)
    edges = directed_edges(around)
    keys = edges[:, 0] * np.int64(len(vertices)) + edges[:, 1]
    order = np.argsort(keys)
    found = []
    for loop in loops:
        wanted = loop * np.int64(len(vertices)) + np.roll(loop, -1)
        found.append(normals[order[np.searchsorted(keys, wanted, sorter=order)] // 3])
    return found


def _fair_patch(patch: Refined, around: Triangles, taken: EdgeSet, n_holes: int) -> tuple[Refined, FloatArray]:
    """Fair a first, crumpled triangulation; its bulge makes room for more vertices, and its shape better weights."""
    patch = _faired(patch, around, plate_length=0.0, uniform=True)
    patch = relax(refine(patch, taken), around, taken)
    plate = _faired(patch, around, plate_length=0.0)
    faired = _faired(plate, around, plate_length=PLATE_LENGTH)
    faired = _faired(faired, around, plate_length=PLATE_LENGTH)
    apart = np.linalg.norm(faired.vertices - plate.vertices, axis=1)
    hole = np.full(len(patch.vertices), -1)
    hole[patch.triangles] = patch.hole[:, None]
    hole[: patch.n_measured] = -1
    # Curvature carried on from a ragged rim can run away; such a hole takes the thin plate.
    furthest = np.zeros(n_holes)
    np.maximum.at(furthest, hole[hole >= 0], apart[hole >= 0])
    runaway = furthest > RUNAWAY_SHARE * _hole_widths(plate, n_holes)
    keep = (hole >= 0) & runaway[hole]
    vertices = np.where(keep[:, None], plate.vertices, faired.vertices)
    count = np.bincount(hole[hole >= 0], minlength=n_holes)
    gap = np.bincount(hole[hole >= 0], apart[hole >= 0], minlength=n_holes) / np.maximum(count, 1)
    return replace(faired, vertices=vertices), gap


def _hole_widths(patch: Refined, n_holes: int) -> FloatArray:
    """Diagonal of the bounding box of every hole's rim, (n_holes,)."""
    corners = patch.triangles.ravel()
    hole = np.repeat(patch.hole, 3)
    on_rim = corners < patch.n_measured
    low, high = np.full((n_holes, 3), np.inf), np.full((n_holes, 3), -np.inf)
    np.minimum.at(low, hole[on_rim], patch.vertices[corners[on_rim]])
    np.maximum.at(high, hole[on_rim], patch.vertices[corners[on_rim]])
    return np.linalg.norm(np.where(np.isfinite(high - low), high - low, 0.0), axis=1)


def _faired(patch: Refined, around: Triangles, *, plate_length: float, uniform: bool = False) -> Refined:
    triangles = np.concatenate([around, patch.triangles])
    return replace(patch, vertices=fair(patch.vertices, triangles, patch.is_new, plate_length, uniform=uniform))
