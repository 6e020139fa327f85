"""Holes cut into undamaged surface, where it is known what belongs into them."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.boundary import boundary_loops, on_boundary
from quadpatch.mesh.edge_groups import survey_edges
from quadpatch.mesh.measures import used_vertices
from quadpatch.mesh.normals import vertex_normals
from quadpatch.types import BoolArray, IntArray, TriangleMesh

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


def cut_holes(mesh: TriangleMesh, diameter: float, spacing: Spacing, rng: np.random.Generator) -> MeshWithHoles:
    """Cut disks of surface out of a mesh wherever they keep clear of every boundary and of each other.

    Parameters
    ----------
    mesh : TriangleMesh
    diameter : float
        Of the rims, in mesh units.
    spacing : Spacing
    rng : numpy.random.Generator
        Picks the places.
    """
    radius = max(diameter / 2 - _RIM_EDGES * spacing.edge_length, 0.5 * spacing.edge_length)
    removed = _disks(mesh, radius, spacing, rng)
    cut_away = np.asarray(removed[mesh.triangles].any(axis=1))
    remaining = TriangleMesh(mesh.vertices, mesh.triangles[~cut_away])
    return MeshWithHoles(remaining, removed, cut_away, new_loops(mesh, cut_away))


def _disks(mesh: TriangleMesh, radius: float, spacing: Spacing, rng: np.random.Generator) -> BoolArray:
    """Choose the vertices (n,) to take."""
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    tree = cKDTree(mesh.vertices)
    clear = _far_from_boundary(mesh, radius + spacing.margin)
    removed = np.zeros(len(mesh.vertices), bool)
    count = 0
    for centre in rng.permutation(np.flatnonzero(clear)).tolist():
        if not clear[centre]:
            continue
        nearby = np.array(tree.query_ball_point(mesh.vertices[centre], 2 * (radius + spacing.margin)))
        distance = np.linalg.norm(mesh.vertices[nearby] - mesh.vertices[centre], axis=1)
        removed[nearby[(distance < radius) & (normals[nearby] @ normals[centre] > 0)]] = True
        clear[nearby] = False
        count += 1
        if count == spacing.most:
            break
    return removed


def _far_from_boundary(mesh: TriangleMesh, distance: float) -> BoolArray:
    """Vertices (n,) that a triangle uses and that keep a distance from every boundary edge."""
    far = used_vertices(mesh.triangles, len(mesh.vertices))
    rim = np.flatnonzero(on_boundary(mesh))
    if len(rim):
        nearest, _ = cKDTree(mesh.vertices[rim]).query(mesh.vertices, distance_upper_bound=distance)
        far &= nearest > distance
    return far


def new_loops(mesh: TriangleMesh, cut_away: BoolArray) -> list[IntArray]:
    """Find the manifold loops that a mesh gets where triangles (n_triangles,) are cut away, far from its own boundary.

    Loops that touch a boundary of the mesh itself are left out. Only triangles next to the cuts are looked at.
    """
    beside = used_vertices(mesh.triangles[cut_away], len(mesh.vertices))
    near = mesh.triangles[~cut_away & beside[mesh.triangles].any(axis=1)]
    survey = survey_edges(near, len(mesh.vertices))
    # Edges between these vertices have all their triangles among the near ones.
    boundary = boundary_loops(near, replace(survey, on_boundary=beside & ~on_boundary(mesh)))
    pairs = zip(boundary.loops, boundary.is_manifold, strict=True)
    return [loop for loop, is_manifold in pairs if is_manifold]
