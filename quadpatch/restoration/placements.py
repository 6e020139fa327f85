"""Ways to place missing vertices by geometry alone; calibration chooses among them."""

import numpy as np

from quadpatch.mesh.distance import nearest_points
from quadpatch.mesh.meshlab import poisson_surface
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.restoration.least_squares import extend_smoothly
from quadpatch.restoration.normal_fitting import EDGES, SMOOTH, fit_to_normals
from quadpatch.types import BoolArray, TriangleMesh, Vertices

LEAST_SQUARES = "least_squares"
SMOOTH_NORMALS = "smooth_normals"
EDGE_NORMALS = "edge_normals"
BASE_SURFACE = "base_surface"

# Iterations that take the steps of the octree off a Poisson surface.
_SMOOTHING = 3


def placements(mesh: TriangleMesh, missing: BoolArray, base_surface: TriangleMesh | None) -> dict[str, Vertices]:
    """Place the missing vertices in several ways.

    Parameters
    ----------
    mesh : TriangleMesh
        Positions of missing vertices are never read.
    missing : (n,) bool
        Within reach of measured ones.
    base_surface : TriangleMesh or None
        A surface that is known besides the mesh, such as a coarse mesh.

    Returns
    -------
    dict
        Vertices (n, 3) by the name of the way.
    """
    first = extend_smoothly(mesh.triangles, missing, mesh.vertices)
    start = TriangleMesh(first, mesh.triangles)
    found = {
        LEAST_SQUARES: first,
        SMOOTH_NORMALS: fit_to_normals(start, missing, SMOOTH),
        EDGE_NORMALS: fit_to_normals(start, missing, EDGES),
    }
    if base_surface is not None:
        found[BASE_SURFACE] = moved_onto(start, missing, base_surface)
    return found


def moved_onto(start: TriangleMesh, missing: BoolArray, surface: TriangleMesh) -> Vertices:
    """Move missing vertices (of all, (n, 3)) onto a surface that measured ones may lie off.

    How far the measured vertices lie off is continued smoothly and taken off, so that a surface that is too smooth or
    too low still serves.
    """
    offset = nearest_points(start.vertices, surface) - start.vertices
    correction = offset - extend_smoothly(start.triangles, missing, offset)
    return np.where(missing[:, None], start.vertices + correction, start.vertices)


def poisson_base(mesh: TriangleMesh, missing: BoolArray) -> TriangleMesh:
    """Screened Poisson surface of the measured vertices, smoothed.

    Parameters
    ----------
    mesh : TriangleMesh
        Positions of missing vertices are never read; its triangles serve for the normals of the points.
    missing : (n,) bool

    Raises
    ------
    StageError
        If MeshLab finds no surface.
    """
    completed = extend_smoothly(mesh.triangles, missing, mesh.vertices)
    normals = vertex_normals(completed, mesh.triangles)
    points = ~missing & normals.any(axis=1)
    surface = poisson_surface(completed[points], normals[points])
    return laplacian_smooth(surface, _SMOOTHING)
