"""Holes cut into undamaged surface, where it is known what belongs into them."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.boundary import boundary_loops, on_boundary
from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.edge_survey import survey_edges
from quadpatch.mesh.measures import used_vertices
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.topology import components, order_of, touching
from quadpatch.processes import usable_threads
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles

# The rim of a cut lies so much outside the disk of vertices that it takes, in mean edge lengths.
_RIM_EDGES = 1.0


@dataclass(frozen=True)
class MeshWithHoles:
    """What holes took from a mesh.

    Attributes
    ----------
    mesh : TriangleMesh
        All vertices, and the triangles that remain.
    removed : (n_vertices,) bool
    cut_away : (n_triangles,) bool
        Triangles of the whole mesh that were taken.
    loops : list of (n_loop,) int64
        Rims of the holes.
    """

    mesh: TriangleMesh
    removed: BoolArray
    cut_away: BoolArray
    loops: list[IntArray]


@dataclass(frozen=True)
class Spacing:
    """Lengths that cuts go by, in mesh units.

    Attributes
    ----------
    edge_length : float
        Mean of the mesh.
    margin : float
        Surface left between a hole and any other rim.
    most : int or None
        At most so many holes.
    """

    edge_length: float
    margin: float
    most: int | None = None


class UncutSurface:
    """A mesh that holes are cut into, several times over: what every try asks for is computed once.

    Parameters
    ----------
    mesh : TriangleMesh
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        self.mesh = mesh
        self._known_distance = -1.0
        self._to_boundary: FloatArray = np.zeros(0)

    @cached_property
    def tree(self) -> cKDTree:
        """Of the vertices; it is built quickly, since few holes ask it."""
        return cKDTree(self.mesh.vertices, balanced_tree=False, compact_nodes=False)

    @cached_property
    def _by_corner(self) -> tuple[IntArray, IntArray]:
        """Triangles (3 n_triangles,) ordered by the vertex at a corner, and where those of each vertex begin."""
        corners, n = self.mesh.triangles.ravel(), len(self.mesh.vertices)
        return order_of(corners, n) // 3, np.concatenate([[0], np.cumsum(np.bincount(corners, minlength=n))])

    def triangles_at(self, vertices: IntArray) -> Triangles:
        """Triangles (k, 3) with a corner among some vertices."""
        triangle, begin = self._by_corner
        which = [triangle[start:end] for start, end in zip(begin[vertices], begin[vertices + 1], strict=True)]
        return self.mesh.triangles[np.unique(np.concatenate(which))]

    def facing(self, disk: IntArray, centre: int) -> IntArray:
        """Those of some vertices (k,), ascending, whose normals are within a right angle of a centre's among them."""
        used, local = np.unique(self.triangles_at(disk), return_inverse=True)
        normals = vertex_normals(self.mesh.vertices[used], local.reshape(-1, 3))
        faces = normals @ normals[np.searchsorted(used, centre)] > 0
        return np.intersect1d(disk, used[faces])

    def is_clear(self, distance: float) -> BoolArray:
        """Vertices (n_vertices,) that a triangle uses and that keep a distance from every boundary edge."""
        mesh = self.mesh
        far = used_vertices(mesh.triangles, len(mesh.vertices))
        rim = np.flatnonzero(on_boundary(mesh))
        if not len(rim):
            return far
        if distance > self._known_distance:
            rim_tree = cKDTree(mesh.vertices[rim])
            nearest = rim_tree.query(mesh.vertices, distance_upper_bound=distance, workers=usable_threads())
            self._to_boundary = np.asarray(nearest[0])
            self._known_distance = distance
        return far & (self._to_boundary > distance)


def cut_holes(surface: UncutSurface, diameter: float, spacing: Spacing, rng: np.random.Generator) -> MeshWithHoles:
    """Cut disks of surface out of a mesh wherever they keep clear of every boundary and of each other.

    Where a cut would come in pieces or have a second rim, as at a fold, none is made: it would be no hole of this
    diameter.

    Parameters
    ----------
    surface : UncutSurface
    diameter : float
        Of the rims, in mesh units.
    spacing : Spacing
    rng : numpy.random.Generator
        Picks the places.
    """
    radius = max(diameter / 2 - _RIM_EDGES * spacing.edge_length, 0.5 * spacing.edge_length)
    removed, mesh = _disks(surface, radius, spacing, rng), surface.mesh
    cut_away = touching(mesh.triangles, removed)
    remaining = TriangleMesh(mesh.vertices, mesh.triangles[~cut_away])
    return MeshWithHoles(remaining, removed, cut_away, new_loops(mesh, cut_away))


def _disks(surface: UncutSurface, radius: float, spacing: Spacing, rng: np.random.Generator) -> BoolArray:
    """Choose the vertices (n,) to take."""
    vertices = surface.mesh.vertices
    if radius <= 0:
        # All vertices were rounded to one place.
        return np.zeros(len(vertices), bool)
    clear = surface.is_clear(radius + spacing.margin)
    removed, n_disks = np.zeros(len(vertices), bool), 0
    for centre in rng.permutation(np.flatnonzero(clear)).tolist():
        if not clear[centre]:
            continue
        reach = 2 * (radius + spacing.margin)
        nearby = np.array(surface.tree.query_ball_point(vertices[centre], reach), np.int64)
        disk = nearby[np.linalg.norm(vertices[nearby] - vertices[centre], axis=1) < radius]
        facing = surface.facing(disk, centre)
        if not len(facing) or not _is_disk(surface.triangles_at(facing)):
            clear[disk] = False
            continue
        clear[nearby] = False
        removed[facing] = True
        n_disks += 1
        if n_disks == spacing.most:
            break
    return removed


def _is_disk(triangles: Triangles) -> bool:
    """Whether triangles (k, 3) are one disk: connected, no edge or vertex crowded, the Euler characteristic 1."""
    used, local = np.unique(triangles, return_inverse=True)
    groups = group_edges(local.reshape(-1, 3), len(used))
    ends = groups.ends()
    at_rim = np.bincount(ends[groups.count == 1].ravel(), minlength=len(used))
    return (
        len(used) - len(ends) + len(triangles) == 1
        and int(groups.count.max()) <= 2
        and bool(np.isin(at_rim, (0, 2)).all())
        and not components(ends, len(used)).any()
    )


def new_loops(mesh: TriangleMesh, cut_away: BoolArray) -> list[IntArray]:
    """Find the manifold loops that a mesh gets where triangles (n_triangles,) are cut away, far from its own boundary.

    Loops that touch a boundary of the mesh itself are left out. Only triangles next to the cuts are looked at.
    """
    beside = used_vertices(mesh.triangles[cut_away], len(mesh.vertices))
    around = touching(mesh.triangles, beside)
    # Edges at the vertices beside the cuts have all their triangles among those around.
    own, cut = (survey_edges(mesh.triangles[part], len(mesh.vertices)) for part in (around, around & ~cut_away))
    marked = replace(cut, on_boundary=beside & ~own.on_boundary)
    boundary = boundary_loops(mesh.triangles[around & ~cut_away], marked)
    pairs = zip(boundary.loops, boundary.is_manifold, strict=True)
    return [loop for loop, is_manifold in pairs if is_manifold]
