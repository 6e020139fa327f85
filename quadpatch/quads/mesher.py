"""Quad mesh of the base surface; the one place that talks to Instant Meshes.

The base surface is smooth, so it is thinned to a few vertices per quad before it is meshed: Instant Meshes takes 1.5 s
for 64,000 vertices and minutes for a million, the clustered base surface 0.2 s and a few seconds, for quads as good.

It is also cut where it is not a manifold. There Instant Meshes colours its vertices wrongly, updates neighbours at the
same time, and gives other quads on every run, whatever its `deterministic` says; vertices without a sound fan of
triangles may also turn its whole field into NaN.

Instant Meshes writes to the C-level standard output. For the time of the call that descriptor points to the null
device, for the whole process: call this from one thread, in a process that writes nothing else meanwhile.

References
----------
W. Jakob, M. Tarini, D. Panozzo, O. Sorkine-Hornung, "Instant Field-Aligned Meshes", ACM Transactions on Graphics 34,
2015.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pynanoinstantmeshes
from scipy.spatial import cKDTree

from quadpatch.errors import NoQuadsError
from quadpatch.mesh.measures import surface_area
from quadpatch.mesh.topology import face_components
from quadpatch.quads.frames import quad_normals
from quadpatch.quads.vertex_clustering import cluster_vertices
from quadpatch.types import BoolArray, FloatArray, QuadMesh, Quads, TriangleMesh, Vertices

# Cells of the clustered base surface along one side of a quad. Four to eight give the edge lengths, covered area and
# normals of the full base surface on a dozen scans; two already break the topology of quads.
_CELLS_PER_SIDE = 5.0
# The output is subdivided once: four quads for one of the field.
_SUBDIVISION = 4.0
# A quad with less than this part of the wanted area is no ground for a frame.
_SMALLEST_AREA = 0.01
# Instant Meshes needs a handful of vertices to lay its field on.
_FEWEST_VERTICES = 4
# Counts of vertices to ask for, in turn, as multiples of the wanted one.
_OTHER_COUNTS = (1.0, 1.05, 0.95)
# Triangles around a quad that say which side of it is out.
_NEIGHBOURS = 8


def quadrangulate(mesh: TriangleMesh, edge_length: float) -> QuadMesh:
    """Cover a surface with quads of about one side length.

    Field-aligned remeshing with four-fold symmetry. Open and
    non-manifold surfaces, several components, and triangles without area are fine; a component smaller than a
    quarter of a quad may get none. The result may have holes of its own and is deterministic.

    Parameters
    ----------
    mesh : TriangleMesh
        Base surface of the scan; finite.
    edge_length : float
        Wanted side of the quads, in mesh units.

    Returns
    -------
    QuadMesh
        Four different corners and a non-zero area in every quad; counter-clockwise seen from outside. No vertex
        without a quad.

    Raises
    ------
    NoQuadsError
        If the surface is too small for one quad.
    """
    centre, scale, unit = _to_unit(mesh)
    side = edge_length / scale
    n_quads = surface_area(unit) / side**2
    thin = cluster_vertices(unit, side / _CELLS_PER_SIDE)
    if n_quads < 1 or len(thin.vertices) < _FEWEST_VERTICES:
        raise NoQuadsError(f"the surface is too small or too thin for quads of side {edge_length:.4g}")
    quad_mesh = _first_that_works(thin, [factor * n_quads / _SUBDIVISION for factor in _OTHER_COUNTS])
    quads = quad_mesh.quads[_is_proper(quad_mesh, side)]
    if len(quads) == 0:
        raise NoQuadsError(f"no quad of side {edge_length:.4g} fits the surface")
    quads = _turn_outwards(quad_mesh.vertices, quads, thin)
    used, compact = np.unique(quads, return_inverse=True)
    return QuadMesh(quad_mesh.vertices[used] * scale + centre, compact.reshape(quads.shape).astype(np.int64))


def _to_unit(mesh: TriangleMesh) -> tuple[FloatArray, float, TriangleMesh]:
    """Move and scale into the unit ball, because float32 follows; drop the vertices that no triangle uses."""
    if len(mesh.triangles) == 0:
        raise NoQuadsError("the surface has no triangles")
    used, compact = np.unique(mesh.triangles, return_inverse=True)
    vertices = mesh.vertices[used]
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    centre, scale = 0.5 * (low + high), float(np.linalg.norm(high - low)) / 2
    if scale == 0.0:
        raise NoQuadsError("all triangles of the surface lie in one point")
    return centre, scale, TriangleMesh((vertices - centre) / scale, compact.reshape(-1, 3).astype(np.int64))


def _first_that_works(mesh: TriangleMesh, counts: list[float]) -> QuadMesh:
    """Ask for quads with one count of vertices after the other: the extraction fails for some, and says so."""
    for count in counts:
        try:
            return _instant_meshes(mesh, max(round(count), _FEWEST_VERTICES))
        except RuntimeError as error:
            last = error
    raise NoQuadsError(f"Instant Meshes finds no quads on the surface: {last}") from last


def _instant_meshes(mesh: TriangleMesh, n_vertices: int) -> QuadMesh:
    with _silent_stdout():
        vertices, quads = pynanoinstantmeshes.remesh(
            mesh.vertices.astype(np.float32),
            mesh.triangles.astype(np.uint32),
            n_vertices,
            rosy=4,
            posy=4,
            extrinsic=False,
            smooth_iter=2,
            align_to_boundaries=False,
            deterministic=True,
            # The default of 0 doubles the vertices on every edge as creases, and on flat parts leaves no quads at all.
            creaseAngle=-1.0,
        )
    return QuadMesh(np.asarray(vertices, dtype=np.float64), np.asarray(quads, dtype=np.int64).reshape(-1, 4))


@contextmanager
def _silent_stdout() -> Iterator[None]:
    """Send the C-level standard output of the process to the null device."""
    sys.stdout.flush()
    kept = os.dup(1)
    null = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(null)
        os.close(kept)


def _is_proper(quad_mesh: QuadMesh, side: float) -> BoolArray:
    """Quads that can carry a frame: finite, four different corners, some area."""
    quads = np.sort(quad_mesh.quads, axis=1)
    has_own_corners = (quads[:, 1:] != quads[:, :-1]).all(axis=1)
    double_area = np.linalg.norm(quad_normals(quad_mesh.vertices, quad_mesh.quads), axis=1)
    # A comparison with NaN is false, so that quads with broken corners go as well.
    return np.asarray(has_own_corners & (double_area > 2 * _SMALLEST_AREA * side**2))


def _turn_outwards(vertices: Vertices, quads: Quads, base_surface: TriangleMesh) -> Quads:
    """Flip whole pieces of the quad mesh whose normals disagree with those of the base surface.

    Instant Meshes keeps the orientation of its input within a piece, so the area of a piece takes the vote:
    single quads at a fold or on a thin wall could be misled by the triangle next to them.
    """
    a, b, c = (base_surface.vertices[base_surface.triangles[:, corner]] for corner in range(3))
    tree = cKDTree((a + b + c) / 3)
    _, nearest = tree.query(vertices[quads].mean(axis=1), k=min(_NEIGHBOURS, len(a)))
    outward = np.cross(b - a, c - a)[nearest.reshape(len(quads), -1)].sum(axis=1)
    vote = np.einsum("ij,ij->i", outward, quad_normals(vertices, quads))
    piece = face_components(quads, int(quads.max()) + 1)
    is_inside_out = (np.bincount(piece, weights=vote) < 0)[piece]
    return np.where(is_inside_out[:, None], quads[:, ::-1], quads)
