"""A mesh file as one surface: vertices that it repeats joined, faces that say nothing new left out.

STL repeats every vertex for every triangle, and exporters repeat vertices along seams, so the edges there look like
boundaries. Only vertices on boundary edges are joined: where their coordinates are the same bits (0.0 and -0.0 are one
number), and on demand where they are closer than a tolerance. What lies inside a surface is left as measured.

Faces that repeat others, and fins, are left out, and faces that are flipped against their neighbours are turned
back: holes are found, measured and filled on the surface that remains. The file keeps all of them.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quadpatch.mesh.duplicate_faces import repeated_triangles
from quadpatch.mesh.edge_survey import EdgeSurvey, survey_edges
from quadpatch.mesh.fins import fin_triangles
from quadpatch.mesh.hashes import shared_hashes
from quadpatch.mesh.near_vertices import Tolerance, join_near
from quadpatch.mesh.orientation import flipped_triangles
from quadpatch.mesh.passes import is_identity, parts_of
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Points, and triangles, that are looked at together: what is made of them fits into the processor's cache.
_CHUNK = 1 << 15


@dataclass(frozen=True)
class WeldCounts:
    """What became of a file's vertices and triangles.

    Attributes
    ----------
    equal_vertices, near_vertices : int
        Vertices joined to an earlier one at the same position, and to one within the tolerance.
    tolerance : float
        In mesh units.
    triangles : int
        Of the file, those without three different corners aside.
    duplicate_triangles, fin_triangles : int
        Left out.
    turned_triangles : int
        Turned over.
    """

    equal_vertices: int
    near_vertices: int
    tolerance: float
    triangles: int
    duplicate_triangles: int
    fin_triangles: int
    turned_triangles: int


@dataclass(frozen=True)
class Weld:
    """A welded mesh and the way back to its file.

    Attributes
    ----------
    mesh : TriangleMesh
        Vertices in the order in which the file first names them; triangles in the file's order, without those whose
        corners are not three different vertices and without the ignored ones, and all of a piece in one direction.
    to_file : (n_welded,) int64
        First file vertex of each welded vertex; of those that the triangles of `mesh` use, where there is one.
    from_file : (n_file,) int64
        Welded vertex of each file vertex.
    ignored_triangles : (k, 3) int64
        Repeated triangles and fins, in welded vertices.
    is_flipped : (n_triangles,) bool
        Triangles of `mesh` whose direction is not that of the file.
    counts : WeldCounts
    survey : EdgeSurvey or None
        Of `mesh`; None where it was changed after its edges were looked at.
    """

    mesh: TriangleMesh
    to_file: IntArray
    from_file: IntArray
    ignored_triangles: Triangles
    is_flipped: BoolArray
    counts: WeldCounts
    survey: EdgeSurvey | None = None


def weld(scan_vertices: Vertices, scan_triangles: Triangles, tolerance: Tolerance = 0.0) -> Weld:
    """Join the vertices of boundary edges that lie at one position, and leave out redundant triangles.

    Parameters
    ----------
    scan_vertices : (n_file, 3) float64
        In mesh units; finite.
    scan_triangles : (m, 3) int64
    tolerance : float or "auto"
        How far apart vertices are joined, in mesh units; 0 joins those at bit-identical positions alone. See
        `quadpatch.mesh.near_vertices`.

    Raises
    ------
    OptionError
        If the tolerance does not fit the mesh.
    """
    proper = _without_degenerate(scan_triangles)
    place = first_of_equal(scan_vertices)
    repeated = repeated_triangles(proper, place)
    kept = proper[~repeated] if repeated.any() else proper
    survey = survey_edges(kept, len(place))
    to_file, from_file = _numbered(_join_equal(kept, proper[repeated], place, survey))
    n_equal = len(scan_vertices) - len(to_file)
    triangles = kept
    if n_equal:
        triangles = _without_degenerate(from_file[kept])
        survey = survey_edges(triangles, len(to_file))
    near, tolerance = join_near(TriangleMesh(_picked(scan_vertices, to_file), triangles), survey.on_boundary, tolerance)
    again = np.zeros(len(triangles), dtype=bool)
    n_near = 0 if near is None else int((near != np.arange(len(near))).sum())
    if near is not None and n_near:
        to_file, from_file = _numbered(to_file[near][from_file])
        triangles = _without_degenerate(from_file[kept])
        survey = survey_edges(triangles, len(to_file))
        again = repeated_triangles(triangles, np.arange(len(to_file)))
    copies = np.concatenate([from_file[proper[repeated]], triangles[again]])
    triangles = triangles[~again] if again.any() else triangles
    fins = triangles[:0]
    if survey.is_crowded:
        is_fin = fin_triangles(_picked(scan_vertices, to_file), triangles)
        fins, triangles = triangles[is_fin], triangles[~is_fin]
    is_flipped = np.zeros(len(triangles), dtype=bool)
    if survey.is_divided:
        is_flipped = flipped_triangles(triangles, len(to_file))
        triangles = np.where(is_flipped[:, np.newaxis], triangles[:, ::-1], triangles)
    return Weld(
        TriangleMesh(_picked(scan_vertices, to_file), triangles),
        to_file,
        from_file,
        np.concatenate([copies, fins]),
        is_flipped,
        WeldCounts(n_equal, n_near, tolerance, len(proper), len(copies), len(fins), int(is_flipped.sum())),
        None if again.any() or survey.is_crowded or survey.is_divided else survey,
    )


def _picked(scan_vertices: Vertices, to_file: IntArray) -> Vertices:
    """Pick the file's vertices (n, 3) that stay; no copy where all of them do."""
    return scan_vertices if len(to_file) == len(scan_vertices) else scan_vertices[to_file]


def _without_degenerate(triangles: Triangles) -> Triangles:
    proper = np.zeros(len(triangles), bool)
    for part in parts_of(len(triangles), _CHUNK):
        a, b, c = triangles[part].T
        proper[part] = (a != b) & (b != c) & (c != a)
    return triangles if proper.all() else triangles[proper]


def _join_equal(kept: Triangles, copies: Triangles, place: IntArray, survey: EdgeSurvey) -> IntArray:
    """Find the first boundary vertex at the position of each boundary vertex, (n_file,) int64; others are their own.

    A vertex that repeated triangles alone use is joined to one of the triangles that they repeat.
    """
    if is_identity(place):
        # No two vertices lie at one position.
        return place
    first = np.arange(len(place), dtype=np.int64)
    candidates = np.flatnonzero(survey.on_boundary)
    at_place = np.zeros(len(place), np.int64)
    # Of several values for one index the last one stays.
    at_place[place[candidates[::-1]]] = candidates[::-1]
    first[candidates] = at_place[place[candidates]]
    if len(copies):
        is_used = np.zeros(len(place), dtype=bool)
        is_used[kept] = True
        spare = np.unique(copies)
        spare = spare[~is_used[spare]]
        at_place[place[kept.ravel()]] = kept.ravel()
        first[spare] = first[at_place[place[spare]]]
    return first


def _numbered(first: IntArray) -> tuple[IntArray, IntArray]:
    """Give numbers to the vertices that stay; return the file's vertex of each, and the number of each file vertex."""
    if is_identity(first):
        return first, first
    stays = first == np.arange(len(first))
    return np.flatnonzero(stays), (np.cumsum(stays) - 1)[first]


def first_of_equal(points: FloatArray) -> IntArray:
    """Find the first point that equals each point.

    Parameters
    ----------
    points : (n, 3) float64
        Or any other rows of three finite numbers.

    Returns
    -------
    (n,) int64
        Positions in `points`.
    """
    result = np.arange(len(points), dtype=np.int64)
    short = np.zeros(len(points), dtype=np.uint32)
    for part in parts_of(len(points), _CHUNK):
        short[part] = _position_hashes(points[part]) >> np.uint64(32)
    rows = shared_hashes(short)
    if not len(rows):
        return result
    points = points[rows]
    order = _grouping_order(points, _position_hashes(points))
    begins = np.ones(len(points), dtype=bool)
    begins[1:] = _neighbours_differ(points, order)
    # Both orders are stable, so the first of a group is also the first of the file.
    result[rows[order]] = rows[order[begins]][np.cumsum(begins) - 1]
    return result


def _position_hashes(points: FloatArray) -> NDArray[np.uint64]:
    """Hash positions (n, 3): equal ones alike, and as good as never two that differ."""
    hashes = np.zeros(len(points), dtype=np.uint64)
    for axis in range(3):
        # Adding 0.0 turns -0.0 into 0.0, so equal numbers have equal bits.
        hashes ^= (points[:, axis] + 0.0).view(np.uint64)
        hashes *= np.uint64(0x9E3779B97F4A7C15)
        hashes ^= hashes >> np.uint64(29)
    return hashes


def _grouping_order(points: FloatArray, hashes: NDArray[np.uint64]) -> IntArray:
    """Stable order that puts equal points side by side, (n,) int64.

    Sorting one hash is three times faster than sorting three coordinates; where two different points share a hash,
    their coordinates decide after all.
    """
    order = np.argsort(hashes, kind="stable")
    in_order = hashes[order]
    if ((in_order[1:] == in_order[:-1]) & _neighbours_differ(points, order)).any():
        order = np.lexsort(points.T)
    return np.asarray(order, dtype=np.int64)


def _neighbours_differ(points: FloatArray, order: IntArray) -> BoolArray:
    """Whether each point of an order lies elsewhere than the one before it, (n - 1,)."""
    differs = np.zeros(max(len(order) - 1, 0), dtype=bool)
    for axis in range(3):
        column = points[:, axis][order]
        differs |= column[1:] != column[:-1]
    return differs
