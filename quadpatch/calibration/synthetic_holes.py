"""Holes cut into undamaged surface, where it is known what belongs into them."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.boundary import boundary_loops, on_boundary
from quadpatch.mesh.edge_survey import survey_edges
from quadpatch.mesh.measures import used_vertices
from quadpatch.mesh.normals import normals_at
from quadpatch.mesh.topology import touching
from quadpatch.processes import usable_threads
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

# The rim of a cut lies so much outside the disk of vertices that it takes, in mean edge lengths.
_RIM_EDGES = 0.7


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
        """Of the vertices."""
        return cKDTree(self.mesh.vertices)

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
    clear = surface.is_clear(radius + spacing.margin)
    centres, disks = [], []
    for centre in rng.permutation(np.flatnonzero(clear)).tolist():
        if not clear[centre]:
            continue
        nearby = np.array(surface.tree.query_ball_point(vertices[centre], 2 * (radius + spacing.margin)))
        distance = np.linalg.norm(vertices[nearby] - vertices[centre], axis=1)
        clear[nearby] = False
        centres.append(centre)
        disks.append(nearby[distance < radius])
        if len(disks) == spacing.most:
            break
    removed = np.zeros(len(vertices), bool)
    if disks:
        disk, sizes = np.concatenate(disks), [len(disk) for disk in disks]
        of_centre = normals_at(vertices, surface.mesh.triangles, np.repeat(centres, sizes))
        of_disk = normals_at(vertices, surface.mesh.triangles, disk)
        removed[disk[np.einsum("ij,ij->i", of_disk, of_centre) > 0]] = True
    return removed


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
