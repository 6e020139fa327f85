"""What is counted and measured of a whole surface: its boundary, area, volume and pieces."""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.edge_survey import survey_edges
from quadpatch.mesh.pieces import find_pieces
from quadpatch.types import IntArray, TriangleMesh, Vertices

# Triangles that are looked at together, so that a large scan needs no copies of its size.
_CHUNK = 1 << 16


@dataclass(frozen=True)
class SurfaceFacts:
    """Figures of a surface. Lengths in mesh units, areas and volumes in their squares and cubes.

    Attributes
    ----------
    triangles, boundary_loops : int
    boundary_length : float
        Of all loops together.
    area : float
    volume : float or None
        Enclosed; negative where the surface faces inwards. None where it is not watertight.
    components : int
        Pieces that share no vertex.
    is_watertight : bool
        Whether each edge has exactly two triangles, which pass it in opposite directions.
    """

    triangles: int
    boundary_loops: int
    boundary_length: float
    area: float
    volume: float | None
    components: int
    is_watertight: bool


def surface_facts(mesh: TriangleMesh) -> SurfaceFacts:
    """Count and measure a mesh, in one survey of its edges and two passes over its triangles."""
    survey = survey_edges(mesh.triangles, len(mesh.vertices))
    loops = boundary_loops(mesh.triangles, survey).loops
    is_watertight = not (survey.on_boundary.any() or survey.is_crowded or survey.is_divided)
    area, volume = _area_and_volume(mesh)
    # Vertices that no triangle uses are pieces of their own to `find_pieces`.
    pieces = np.unique(find_pieces(mesh, []).of_vertex[mesh.triangles[:, 0]])
    return SurfaceFacts(
        len(mesh.triangles),
        len(loops),
        sum(_length(mesh.vertices, loop) for loop in loops),
        area,
        volume if is_watertight and len(mesh.triangles) else None,
        len(pieces),
        is_watertight and len(mesh.triangles) > 0,
    )


def _length(vertices: Vertices, loop: IntArray) -> float:
    points = vertices[loop]
    return float(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1).sum())


def _area_and_volume(mesh: TriangleMesh) -> tuple[float, float]:
    """Sum the areas of the triangles, and the volumes of the tetrahedra that they span with one point.

    The point lies on the surface: far from it the volumes would cancel out badly.
    """
    twice_area = six_volumes = 0.0
    origin = mesh.vertices[mesh.triangles[0, 0]] if len(mesh.triangles) else np.zeros(3)
    for at in range(0, len(mesh.triangles), _CHUNK):
        a, b, c = (mesh.vertices[mesh.triangles[at : at + _CHUNK, corner]] - origin for corner in range(3))
        normals = np.cross(b - a, c - a)
        twice_area += float(np.sqrt(np.einsum("ij,ij->i", normals, normals)).sum())
        six_volumes += float(np.einsum("ij,ij->", a, normals))
    return twice_area / 2, six_volumes / 6
