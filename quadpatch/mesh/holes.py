"""Holes: boundary loops with their measures, and the rule that says which of them to fill."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.distance import cdist

from quadpatch.errors import OptionError
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.pieces import connected_pieces
from quadpatch.options import HoleOptions
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Vertices

# An open scan has an outer border that nobody wants closed: without a rule from the user, loops wider than this
# share of the bounding box's diagonal stay open.
AUTO_DIAMETER_SHARE = 0.25

# A scan often has loose pieces, each with an outer border: the longest loop of a piece, if wider than this share of
# the piece's own diagonal.
BORDER_SHARE = 0.5

# Vertices grow with the square of the rim; such a fill would take minutes and gigabytes.
MAX_NEW_VERTICES = 200_000

# A loop with the surface on its left runs clockwise around a hole and counter-clockwise around an outer border, seen
# along the normals at its rim; beyond this cosine it is a border for sure.
OUTWARD = 0.5

# Up to here, all pairwise distances of a loop are cheaper than its convex hull.
_SMALL_LOOP = 400


@dataclass(frozen=True)
class Hole:
    """One boundary loop.

    Attributes
    ----------
    id : int
        Position in the list of holes, longest perimeter first.
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
    is_border : bool
        True for the outer border of a connected piece of the scan, as far as its size tells.
    """

    id: int
    loop: IntArray
    perimeter: float
    diameter: float
    area: float
    planarity: float
    is_manifold: bool
    is_border: bool = False

    @property
    def n_edges(self) -> int:
        """Edges, and vertices, of the loop."""
        return len(self.loop)

    @property
    def n_expected_vertices(self) -> int:
        """About as many new vertices as a fill will have: equilateral triangles as large as the rim's edges."""
        edge = self.perimeter / max(self.n_edges, 1)
        return round(self.area / (np.sqrt(0.75) * edge**2)) if edge > 0 else 0


@dataclass(frozen=True)
class Selection:
    """What to do with every hole: an empty reason means that it is to be filled.

    Attributes
    ----------
    chosen : list of Hole
    skipped : dict of int to (str, str)
        Hole id to a stable code and a sentence for people.
    """

    chosen: list[Hole]
    skipped: dict[int, tuple[str, str]]


def find_holes(mesh: TriangleMesh) -> list[Hole]:
    """Find and measure every boundary loop.

    Returns
    -------
    list of Hole
        Longest perimeter first; equal ones in the order of their first vertex. Ids count up from 0.
    """
    boundary = boundary_loops(mesh.triangles)
    piece, piece_diagonals = _pieces(mesh)
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    measured = []
    for loop, is_manifold in zip(boundary.loops, boundary.is_manifold, strict=True):
        points = mesh.vertices[loop]
        perimeter = float(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1).sum())
        measured.append((perimeter, loop, points, is_manifold))
    measured.sort(key=lambda item: -item[0])
    holes, seen = [], set()
    for i, (perimeter, loop, points, is_manifold) in enumerate(measured):
        diameter, its_piece = loop_diameter(points), int(piece[loop[0]])
        is_border = its_piece not in seen and diameter > BORDER_SHARE * piece_diagonals[its_piece]
        is_border |= _outwardness(points, normals[loop].mean(axis=0)) > OUTWARD
        seen.add(its_piece)
        holes.append(Hole(i, loop, perimeter, diameter, *_area_and_planarity(points), is_manifold, bool(is_border)))
    return holes


def _pieces(mesh: TriangleMesh) -> tuple[IntArray, FloatArray]:
    """Find connected pieces: the number of the piece of every vertex (n,), and each piece's diagonal."""
    piece = connected_pieces(mesh)
    count = int(piece.max(initial=-1)) + 1
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, piece, mesh.vertices)
    np.maximum.at(high, piece, mesh.vertices)
    return piece, np.linalg.norm(high - low, axis=1)


def select_holes(holes: list[Hole], options: HoleOptions, diagonal: float) -> Selection:
    """Apply the user's rule, or the automatic one, to every hole.

    Parameters
    ----------
    holes : list of Hole
    options : HoleOptions
    diagonal : float
        Of the mesh's bounding box, in mesh units; the automatic rule is relative to it.

    Raises
    ------
    OptionError
        If an explicit id names no hole.
    """
    if options.ids is not None:
        unknown = sorted(set(options.ids) - {hole.id for hole in holes})
        if unknown:
            raise OptionError(f"no hole has the id {unknown[0]}; this mesh has {len(holes)} holes, counted from 0")
    limit = options.max_diameter
    if options.is_automatic:
        limit = AUTO_DIAMETER_SHARE * diagonal
    chosen, skipped = [], {}
    for hole in holes:
        reason = _reason_to_skip(hole, options, limit)
        if reason is None:
            chosen.append(hole)
        else:
            skipped[hole.id] = reason
    return Selection(chosen, skipped)


def _reason_to_skip(hole: Hole, options: HoleOptions, max_diameter: float | None) -> tuple[str, str] | None:
    """Apply the rules in order; the first that holds is the reason."""
    widest, longest = max_diameter or np.inf, options.max_perimeter or np.inf
    rule = "a quarter of the scan's diagonal" if options.is_automatic else "the given maximum"
    reasons = (
        (not hole.is_manifold, "non_manifold_rim", "its rim touches faces of opposite direction, or three at one edge"),
        (options.ids is not None and hole.id not in options.ids, "not_chosen", "not among the chosen ids"),
        (options.all_but_largest and hole.id == 0, "largest", "the largest loop is taken for the border of the scan"),
        (options.is_automatic and hole.is_border, "border", "outer border of a piece of the scan"),
        (hole.n_expected_vertices > MAX_NEW_VERTICES, "too_many_vertices", _too_many(hole)),
        (hole.diameter > widest, "too_wide", f"diameter {hole.diameter:.6g} is over {widest:.6g}, {rule}"),
        (hole.perimeter > longest, "too_long", f"perimeter {hole.perimeter:.6g} is over {longest:.6g}, {rule}"),
    )
    return next(((code, text) for applies, code, text in reasons if applies), None)


def _too_many(hole: Hole) -> str:
    return f"a fill as dense as its rim takes about {hole.n_expected_vertices} new vertices, over {MAX_NEW_VERTICES}"


def loop_diameter(points: Vertices) -> float:
    """Measure the largest distance between two of the points (n, 3)."""
    if len(points) > _SMALL_LOOP:
        points = _extremes(points)
    # In pieces: a loop on a ball has every vertex on its hull, and all pairs of a long one would fill the memory.
    pieces = range(0, len(points), _SMALL_LOOP)
    return max(float(cdist(points[i : i + _SMALL_LOOP], points).max()) for i in pieces)


def _extremes(points: Vertices) -> Vertices:
    """Pick the corners of the convex hull, in as many dimensions as the points span."""
    centred = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    for n_dimensions in (3, 2):
        try:
            return points[ConvexHull(centred @ axes[:n_dimensions].T).vertices]
        except QhullError:
            # The points are flat, or lie on a line.
            continue
    along = centred @ axes[0]
    return points[[int(along.argmin()), int(along.argmax())]]


def _outwardness(points: Vertices, normal: FloatArray) -> float:
    """Mean cosine between the vector area of a loop and the normals at its rim: 1 is an outer border, -1 a hole."""
    vector_area = _vector_area(points - points.mean(axis=0))
    # Not divided by the length of the mean normal: at the end of a tube the normals cancel out, and that says nothing.
    size = float(np.linalg.norm(vector_area))
    return float(vector_area @ normal) / size if size > 0 else 0.0


def _vector_area(centred: Vertices) -> FloatArray:
    """Half the sum of cross products along a loop: the same for every surface that the loop spans."""
    return np.asarray(np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0) / 2)


def _area_and_planarity(points: Vertices) -> tuple[float, float]:
    centred = points - points.mean(axis=0)
    # The length of the vector area is the largest area that the loop projects to.
    area = float(np.linalg.norm(_vector_area(centred)))
    distance = np.linalg.svd(centred, compute_uv=False)[-1] / np.sqrt(len(points))
    diameter = float(np.linalg.norm(centred, axis=1).max()) * 2
    return area, float(distance / diameter) if diameter > 0 else 0.0
