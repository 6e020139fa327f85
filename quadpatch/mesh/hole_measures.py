"""Holes: the boundary loops of a mesh, measured, with the kind of each and the place where it lies."""

from dataclasses import dataclass

import numpy as np

from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.edge_survey import EdgeSurvey, survey_edges
from quadpatch.mesh.hole_kinds import hole_kinds
from quadpatch.mesh.loop_shapes import LoopShapes, measure_loops, perimeters
from quadpatch.mesh.loops import laid_out
from quadpatch.mesh.normals import unit
from quadpatch.mesh.pieces import find_pieces
from quadpatch.mesh.rims import Rims, rims_of
from quadpatch.types import FloatArray, IntArray, TriangleMesh
from quadpatch_rules.hole_selection import HoleKind

Vector = tuple[float, float, float]
_ORIGIN: Vector = (0.0, 0.0, 0.0)
_UP: Vector = (0.0, 0.0, 1.0)

# Where the normals at a rim cancel out below this length, their mean points nowhere.
_LEAST_NORMAL = 0.5


@dataclass(frozen=True, slots=True)
class Hole:
    """One boundary loop.

    Attributes
    ----------
    id : int
        Position in the list of holes, widest first.
    loop : (n_edges,) int64
        Vertices, with the surface on the left of the loop.
    perimeter, diameter : float
        Length of the loop and the largest distance between two of its vertices, in mesh units.
    area : float
        Area of the loop's projection onto its best plane, in square mesh units.
    planarity : float
        Root mean square distance of the loop from its best plane, divided by the diameter: 0 is flat.
    is_manifold : bool
        False where the rim touches an edge of three or more faces or faces that disagree about their direction.
    kind : str
        `hole`; `slit`, whose sides lie close together along its length; `open_end`, a planar rim that ends the object,
        such as the end of a tube; `border`, the outer border of a piece of the scan.
    centre : (3,) floats
        Mean of the rim by length, in mesh units.
    normal : (3,) floats
        Unit vector: mean normal of the surface at the rim; that of a flat patch over the rim where the former cancel
        out, and at open ends.
    low, high : (3,) floats
        Corners of the rim's bounding box, in mesh units.
    """

    id: int
    loop: IntArray
    perimeter: float
    diameter: float
    area: float
    planarity: float
    is_manifold: bool
    kind: HoleKind = "hole"
    centre: Vector = _ORIGIN
    normal: Vector = _UP
    low: Vector = _ORIGIN
    high: Vector = _ORIGIN

    @property
    def is_border(self) -> bool:
        """Whether it is the outer border of a piece of the scan, as far as size and normals tell."""
        return self.kind == "border"

    @property
    def n_edges(self) -> int:
        """Edges, and vertices, of the loop."""
        return len(self.loop)


def find_holes(mesh: TriangleMesh, survey: EdgeSurvey | None = None) -> list[Hole]:
    """Find and measure every boundary loop.

    Parameters
    ----------
    mesh : TriangleMesh
    survey : EdgeSurvey, optional
        Of the mesh, where that was made before.

    Returns
    -------
    list of Hole
        Widest first; equal ones by their perimeter, then in the order of their first vertex. Ids count up from 0.
    """
    survey = survey or survey_edges(mesh.triangles, len(mesh.vertices))
    near = TriangleMesh(mesh.vertices, mesh.triangles[survey.near])
    boundary = boundary_loops(near.triangles, survey)
    if not boundary.loops:
        return []
    lengths = perimeters(mesh.vertices[np.concatenate(boundary.loops)], laid_out(boundary.loops)[0])
    order = np.argsort(-lengths, kind="stable").tolist()
    loops = [boundary.loops[i] for i in order]
    is_manifold = np.array([boundary.is_manifold[i] for i in order])
    rims = rims_of(near, loops)
    shapes = measure_loops(near, rims, loops, lengths[order])
    kinds = hole_kinds(mesh.vertices, rims, shapes, find_pieces(mesh, loops), is_manifold)
    # The border of a sheet is wider than any hole in it; the rim of a winding hole may well be longer.
    widest_first = np.argsort(-shapes.diameters, kind="stable")
    areas = np.linalg.norm(shapes.vector_areas, axis=1)
    vectors = (
        rims.sums(_moments(rims)) / np.maximum(rims.sums(rims.lengths), 1e-300)[:, None],
        _facing(shapes, kinds),
        np.minimum.reduceat(rims.points, rims.starts[:-1], axis=0),
        np.maximum.reduceat(rims.points, rims.starts[:-1], axis=0),
    )
    numbers = (shapes.perimeters, shapes.diameters, areas, shapes.planarity, is_manifold)
    columns = (
        [loops[i] for i in widest_first.tolist()],
        *(column[widest_first].tolist() for column in numbers),
        [kinds[i] for i in widest_first.tolist()],
        *(_vectors(rows[widest_first]) for rows in vectors),
    )
    return [Hole(number, *row) for number, row in enumerate(zip(*columns, strict=True))]


def _moments(rims: Rims) -> FloatArray:
    return (rims.points + rims.edges / 2) * rims.lengths[:, None]


def _facing(shapes: LoopShapes, kinds: list[HoleKind]) -> FloatArray:
    """Return unit vectors (n, 3) that the loops face, as `Hole.normal` says."""
    agreed = np.linalg.norm(shapes.rim_normals, axis=1) >= _LEAST_NORMAL
    agreed &= np.array([kind != "open_end" for kind in kinds])
    # A loop with the surface on its left runs clockwise, seen from where a patch over it faces.
    facing = np.where(agreed[:, None], unit(shapes.rim_normals), -unit(shapes.vector_areas))
    is_nowhere = np.linalg.norm(facing, axis=1) < _LEAST_NORMAL
    return np.where(is_nowhere[:, None], shapes.plane_normals, facing)


def _vectors(rows: FloatArray) -> list[Vector]:
    return list(zip(*rows.T.tolist(), strict=True))
