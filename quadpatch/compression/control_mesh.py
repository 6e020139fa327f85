"""The quad mesh of a file: edge collapse, then triangles paired to quads; the one place here that talks to MeshLab.

Quads of one size, as a repair uses them, cut off whatever is thinner than a quad. Edge collapse makes small quads where
the surface bends and large ones where it is flat, and keeps the topology, borders included.

References
----------
M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH 1997; M. Tarini, N. Pietroni,
P. Cignoni, D. Panozzo, E. Puppo, "Practical quad mesh simplification", Computer Graphics Forum 29, 2010 (pairing).
"""

import numpy as np
import pymeshlab

from quadpatch.errors import NoQuadsError
from quadpatch.quads.vertex_clustering import split_fans
from quadpatch.types import BoolArray, QuadMesh, Quads, TriangleMesh, Vertices

# Weight of the planes that hold the border in its place.
_BORDER_WEIGHT = 3.0
# From 0 to 1: how strongly slivers are avoided.
_QUALITY = 0.5
# A closed surface has at least so many triangles.
_FEWEST_TRIANGLES = 4
# A smaller part of the mean quad's area is no quad.
_LEAST_AREA = 1e-6


def collapse(mesh: TriangleMesh, n_triangles: int) -> TriangleMesh:
    """Collapse edges until about so many triangles are left.

    Parameters
    ----------
    mesh : TriangleMesh
        Finite. Where it is not a manifold it is cut: every fan of triangles gets vertices of its own.
    n_triangles : int
        A mesh with fewer stays as it is.
    """
    original, triangles = split_fans(mesh.triangles)
    if len(triangles) <= n_triangles:
        return TriangleMesh(mesh.vertices[original], triangles)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices[original], triangles))
    meshes.meshing_decimation_quadric_edge_collapse(
        targetfacenum=n_triangles,
        qualitythr=_QUALITY,
        preserveboundary=False,
        boundaryweight=_BORDER_WEIGHT,
        preservenormal=True,
        preservetopology=True,
    )
    result = meshes.current_mesh()
    return TriangleMesh(np.asarray(result.vertex_matrix(), np.float64), np.asarray(result.face_matrix(), np.int64))


def collapse_to_quads(mesh: TriangleMesh, n_quads: int) -> QuadMesh:
    """Cover a surface with about so many quads.

    Triangles are paired to quads. Where one finds no partner, a mesh of a third as many triangles is taken in place of
    that, each cut into three quads by its centroid and the midpoints of its edges, so that no hole is left.

    Parameters
    ----------
    mesh : TriangleMesh
        As for `collapse`.
    n_quads : int
        Pieces keep a few quads each, however few are asked for.

    Returns
    -------
    QuadMesh
        Four different corners and some area in every quad, turned as the triangles are; no vertex without a quad.

    Raises
    ------
    NoQuadsError
        If no quad comes out.
    """
    coarse = collapse(mesh, 2 * n_quads)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(coarse.vertices, coarse.triangles))
    meshes.meshing_tri_to_quad_by_smart_triangle_pairing()
    result = meshes.current_mesh()
    vertices = np.asarray(result.vertex_matrix(), np.float64)
    polygons = [list(map(int, face)) for face in result.polygonal_face_list()]
    quads = np.array([polygon for polygon in polygons if len(polygon) == 4], np.int64).reshape(-1, 4)
    if len(quads) < len(polygons) or not _is_proper(vertices, quads).all():
        vertices, quads = _in_three(collapse(mesh, max(n_quads // 3, _FEWEST_TRIANGLES)))
    quads = quads[_is_proper(vertices, quads)]
    if not len(quads):
        raise NoQuadsError("the surface is too small or too thin to carry one quad")
    used, compact = np.unique(quads, return_inverse=True)
    return QuadMesh(vertices[used], compact.reshape(-1, 4).astype(np.int64))


def _in_three(mesh: TriangleMesh) -> tuple[Vertices, Quads]:
    """Cut every triangle into three quads."""
    n, triangles = len(mesh.vertices), mesh.triangles
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    keys, of_triangle = np.unique(ends[:, 0] * n + ends[:, 1], return_inverse=True)
    midpoints = (mesh.vertices[keys // n] + mesh.vertices[keys % n]) / 2
    edge = n + of_triangle.reshape(-1, 3)
    centre = n + len(keys) + np.arange(len(triangles))
    quads = [np.stack([triangles[:, k], edge[:, k], centre, edge[:, k - 1]], axis=1) for k in range(3)]
    vertices = np.concatenate([mesh.vertices, midpoints, mesh.vertices[triangles].mean(axis=1)])
    return vertices, np.stack(quads, axis=1).reshape(-1, 4)


def _is_proper(vertices: Vertices, quads: Quads) -> BoolArray:
    """Four different corners, finite, and some area."""
    ranked = np.sort(quads, axis=1)
    area = np.linalg.norm(
        np.cross(vertices[quads[:, 2]] - vertices[quads[:, 0]], vertices[quads[:, 3]] - vertices[quads[:, 1]]), axis=1
    )
    mean = float(area[np.isfinite(area)].mean()) if np.isfinite(area).any() else 0.0
    return np.asarray((ranked[:, 1:] != ranked[:, :-1]).all(axis=1) & (area > _LEAST_AREA * mean))
