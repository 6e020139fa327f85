"""What is wrong with a repaired surface, judged without the method's own code.

The judge is independent of `quadpatch`: files are read by trimesh, triangles that pass through others are found by
MeshLab (pymeshlab), and the rest is counted here. MeshLab does not see two sheets in one plane, so triangles that lie
on others are found by their centres. Vertices are joined where their coordinates are equal but for rounding, since some
formats repeat them. A fold does not depend on the direction of the triangles: it is an edge whose two triangles lie
nearly on top of each other.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pymeshlab
import trimesh
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Two triangles that turn by more than this at their common edge are folded over each other.
FOLD_DEGREES = 150.0

# Corners are exact to half a unit in the last place; an area vector shorter than what that does to it has no direction.
_NOISE = 64 * float(np.finfo(np.float64).eps)

# Vertices so many units in the last place apart, of the largest coordinate, are one.
_SAME_PLACE = 4

# Two triangles are in one plane up to this share of the mesh's diagonal, and a point is inside a triangle where each of
# its barycentric coordinates is more than that: neighbours only touch.
_SAME_PLANE = 1e-9
_INSIDE = 1e-3

# A line in which two triangles meet is a point below this share of the diagonal.
_SAME_POINT = 1e-7

# A new triangle of less area than this share of the squared diagonal is a sliver.
_SLIVER_SHARE = 1e-12


@dataclass(frozen=True)
class SurfaceFaults:
    """Faults of a repaired mesh that the mesh before did not have.

    Attributes
    ----------
    is_kept : bool
        The vertices and triangles of the mesh before come first, bit for bit.
    n_new_triangles : int
    n_boundary : int
        Edges of one triangle, new or not.
    n_nonmanifold : int
        Edges of three or more different triangles, a new one among them.
    n_doubled : int
        New triangles on the same three corners as another one.
    n_folds : int
        Edges of new triangles, rim included, that turn by more than 150 degrees.
    n_slivers : int
        New triangles of nearly no area.
    crossing : (n_crossing,) int64
        New triangles that run through other surface or lie on it, by position among the triangles of the mesh after.
    """

    is_kept: bool
    n_new_triangles: int
    n_boundary: int
    n_nonmanifold: int
    n_doubled: int
    n_folds: int
    n_slivers: int
    crossing: IntArray

    @property
    def n_crossings(self) -> int:
        """New triangles that run through other surface or lie on it."""
        return len(self.crossing)


def find_faults(before: TriangleMesh, after: TriangleMesh) -> SurfaceFaults:
    """Compare a mesh with its repair.

    Parameters
    ----------
    before, after : TriangleMesh
        As their files hold them, not welded.
    """
    is_kept = _starts_with(after.vertices, before.vertices) and _starts_with(after.triangles, before.triangles)
    welded = _weld(after)
    is_new = np.arange(len(welded.triangles)) >= len(before.triangles)
    is_repeated = _repeats_another(welded.triangles)
    is_counted = _is_proper(welded.triangles) & ~is_repeated
    single, single_new = TriangleMesh(welded.vertices, welded.triangles[is_counted]), is_new[is_counted]
    edge, n_edges = _edge_of_corner(single.triangles)
    n_faces = np.bincount(edge, minlength=n_edges)
    n_new_faces = np.bincount(edge[np.repeat(single_new, 3)], minlength=n_edges)
    return SurfaceFaults(
        is_kept,
        int(is_new.sum()),
        int((n_faces == 1).sum()),
        int(((n_faces > 2) & (n_new_faces > 0)).sum()),
        int((is_repeated & is_new).sum()),
        _count_folds(single, single_new, edge),
        int((_is_sliver(welded) & is_new).sum()),
        np.flatnonzero(_runs_through_another(welded, is_new) | _lies_on_another(welded, is_new)),
    )


def find_faults_in_files(before: Path, after: Path) -> SurfaceFaults:
    """Compare a mesh file with its repair; both of a format that trimesh reads."""
    return find_faults(read_as_is(before), read_as_is(after))


def read_as_is(path: Path) -> TriangleMesh:
    """Read a file by trimesh: vertices and triangles in the file's order, nothing joined or dropped."""
    mesh = trimesh.load(path, process=False, force="mesh", maintain_order=True)
    return TriangleMesh(np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64))


def _starts_with(rows: FloatArray | IntArray, first: FloatArray | IntArray) -> bool:
    return len(rows) >= len(first) and rows[: len(first)].tobytes() == first.tobytes()


def _weld(mesh: TriangleMesh) -> TriangleMesh:
    """Join vertices that are a few units in the last place apart, of the precision that the mesh's numbers show."""
    vertices, number = np.unique(mesh.vertices, axis=0, return_inverse=True)
    is_single = np.array_equal(vertices, vertices.astype(np.float32))
    unit = float(np.finfo(np.float32 if is_single else np.float64).eps) * np.abs(vertices).max(initial=0)
    pairs = cKDTree(vertices).query_pairs(_SAME_PLACE * unit, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(vertices),) * 2)
    label = connected_components(graph, directed=False)[1]
    _, first, joined = np.unique(label, return_index=True, return_inverse=True)
    return TriangleMesh(vertices[first], joined[number.ravel()][mesh.triangles].astype(np.int64))


def _is_proper(triangles: Triangles) -> BoolArray:
    a, b, c = triangles.T
    return np.asarray((a != b) & (b != c) & (c != a))


def _repeats_another(triangles: Triangles) -> BoolArray:
    """Whether each triangle (m,) has the same three corners as an earlier one, in any order."""
    is_first = np.zeros(len(triangles), dtype=bool)
    is_first[np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1]] = True
    return ~is_first & _is_proper(triangles)


def _edge_of_corner(triangles: Triangles) -> tuple[IntArray, int]:
    """Find the number of the undirected edge from each corner to the next one (3 m,), and how many edges there are."""
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, edge = np.unique(ends, axis=0, return_inverse=True)
    return edge.ravel(), len(edges)


def _area_vectors(mesh: TriangleMesh) -> FloatArray:
    a, b, c = (mesh.vertices[corner] for corner in mesh.triangles.T)
    return np.asarray(np.cross(b - a, c - a))


def _is_sliver(mesh: TriangleMesh) -> BoolArray:
    return np.asarray(np.linalg.norm(_area_vectors(mesh), axis=1) / 2 < _SLIVER_SHARE * _size(mesh) ** 2)


def _count_folds(mesh: TriangleMesh, is_new: BoolArray, edge: IntArray) -> int:
    """Count the edges of new triangles at which two triangles lie nearly on top of each other."""
    vector = _area_vectors(mesh)
    length = np.linalg.norm(vector, axis=1)
    normal = vector / np.maximum(length, np.finfo(np.float64).tiny)[:, None]
    corners = mesh.vertices[mesh.triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0)
    has_normal = length > _NOISE * np.abs(mesh.vertices).max(initial=0) * longest
    start = mesh.triangles.ravel()
    folded = []
    for one, other in _pairs(edge):
        a, b = one // 3, other // 3
        # Neighbours that agree about their direction pass the edge in opposite directions.
        turn = np.where(start[one] != start[other], 1.0, -1.0) * np.einsum("ij,ij->i", normal[a], normal[b])
        is_seen = (is_new[a] | is_new[b]) & has_normal[a] & has_normal[b]
        folded.append(edge[one[is_seen & (turn < np.cos(np.radians(FOLD_DEGREES)))]])
    return len(np.unique(np.concatenate([np.zeros(0, np.int64), *folded])))


def _pairs(edge: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield all pairs of corners that have an edge in common, as two arrays at a time."""
    order = np.argsort(edge, kind="stable")
    for step in range(1, len(order)):
        is_same = edge[order[step:]] == edge[order[:-step]]
        if not is_same.any():
            return
        yield order[:-step][is_same], order[step:][is_same]


def _runs_through_another(mesh: TriangleMesh, is_new: BoolArray) -> BoolArray:
    """Whether each triangle (m,) is new and has more than one point in common with one that is no neighbour.

    Where a corner lies on an edge that does not end there, MeshLab sees a crossing or none, as rounding has it; so what
    it finds is looked at again.
    """
    is_crossing = np.zeros(len(mesh.triangles), dtype=bool)
    corners = mesh.vertices[mesh.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    has_area = ~_is_sliver(mesh)
    # Loop over what MeshLab found, which is little.
    for i in np.flatnonzero(_crosses(mesh) & is_new & has_area).tolist():
        n_common = np.isin(mesh.triangles, mesh.triangles[i]).sum(axis=1)
        is_near = ((low <= high[i]) & (high >= low[i])).all(axis=1) & has_area & (n_common < 2)
        is_crossing[i] = any(
            _common_length(mesh, i, j) > _SAME_POINT * _size(mesh) for j in np.flatnonzero(is_near).tolist()
        )
    return is_crossing


def _common_length(mesh: TriangleMesh, one: int, other: int) -> float:
    """Measure the line in which two triangles meet."""
    shared = np.intersect1d(mesh.triangles[one], mesh.triangles[other])
    points = [mesh.vertices[vertex] for vertex in shared]
    for edges, plane in ((one, other), (other, one)):
        a, b, c = mesh.vertices[mesh.triangles[plane]]
        normal = np.cross(b - a, c - a)
        corners = mesh.vertices[mesh.triangles[edges]]
        height = (corners - a) @ normal / np.linalg.norm(normal)
        for k in range(3):
            height_before, height_after = float(height[k - 1]), float(height[k])
            if height_before * height_after < 0 and min(abs(height_before), abs(height_after)) > _SAME_PLANE * _size(
                mesh
            ):
                point = corners[k - 1] + (corners[k] - corners[k - 1]) * (
                    height_before / (height_before - height_after)
                )
                if _barycentric(point[None], a, b, c).min() > -_SAME_PLANE:
                    points.append(point)
    return max((float(np.linalg.norm(p - q)) for p in points for q in points), default=0.0)


def _barycentric(points: FloatArray, a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Barycentric coordinates (k, 3) of points (k, 3) in their triangles, or in one triangle."""
    normal = np.cross(b - a, c - a)
    square = np.maximum((normal * normal).sum(axis=-1), np.finfo(np.float64).tiny)
    by_b = (np.cross(points - a, c - a) * normal).sum(axis=-1) / square
    by_c = (np.cross(b - a, points - a) * normal).sum(axis=-1) / square
    return np.stack([1 - by_b - by_c, by_b, by_c], axis=-1)


def _size(mesh: TriangleMesh) -> float:
    """Diagonal of the bounding box, in mesh units."""
    return float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))


def _crosses(mesh: TriangleMesh) -> BoolArray:
    """Whether each triangle (m,) runs through another one, as MeshLab finds it."""
    is_crossing = np.zeros(len(mesh.triangles), dtype=bool)
    proper = np.flatnonzero(_is_proper(mesh.triangles))
    if not len(proper):
        return is_crossing
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(_centred(mesh.vertices), mesh.triangles[proper].astype(np.int32)))
    meshes.compute_selection_by_self_intersections_per_face()
    is_crossing[proper] = meshes.current_mesh().face_selection_array().astype(bool)
    return is_crossing


def _lies_on_another(mesh: TriangleMesh, is_new: BoolArray) -> BoolArray:
    """Whether each triangle (m,) is new and lies on one that it has no edge in common with, or that one on it."""
    is_overlapping = np.zeros(len(mesh.triangles), dtype=bool)
    proper = np.flatnonzero(_is_proper(mesh.triangles))
    if not is_new[proper].any():
        return is_overlapping
    centres = mesh.vertices[mesh.triangles[proper]].mean(axis=1)
    # Triangles of one size at a time, so that a few large ones do not make candidates of all.
    reach = np.linalg.norm(mesh.vertices[mesh.triangles[proper]] - centres[:, None], axis=2).max(axis=1, initial=0)
    level = np.frexp(reach)[1]
    points = cKDTree(centres)
    for step in np.unique(level):
        of_level = proper[level == step]
        near = points.query_ball_point(centres[level == step], np.ldexp(1.0, int(step)))
        upper = np.repeat(of_level, [len(those) for those in near])
        lower = proper[np.concatenate([np.array(those, np.int64) for those in near])]
        is_asked = (is_new[lower] | is_new[upper]) & (lower != upper)
        lower, upper = lower[is_asked], upper[is_asked]
        lies = _has_on_it(mesh, upper, lower)
        is_overlapping[lower[lies]] = is_overlapping[upper[lies]] = True
    return is_overlapping & is_new


def _has_on_it(mesh: TriangleMesh, upper: IntArray, lower: IntArray) -> BoolArray:
    """Whether each triangle (k,) has the centre of another one (k,) on it; those with an edge in common only fold."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.triangles[upper].T)
    centre = mesh.vertices[mesh.triangles[lower]].mean(axis=1)
    normal = np.cross(b - a, c - a)
    square = np.maximum(np.einsum("ij,ij->i", normal, normal), np.finfo(np.float64).tiny)
    height = np.abs(np.einsum("ij,ij->i", centre - a, normal)) / np.sqrt(square)
    n_common = (mesh.triangles[upper][:, :, None] == mesh.triangles[lower][:, None]).sum(axis=(1, 2))
    is_inside = _barycentric(centre, a, b, c).min(axis=1) > _INSIDE
    return np.asarray(is_inside & (height < _SAME_PLANE * _size(mesh)) & (n_common != 2))


def _centred(vertices: Vertices) -> Vertices:
    """Bring the mesh into a box of diagonal 1 around the origin: MeshLab's tolerances are absolute."""
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    return np.asarray((vertices - vertices.mean(axis=0)) / (size or 1.0))
