"""Fills of meshes with holes, and what holds of every one of them."""

import numpy as np

from quadpatch.filling.fairing import Energy
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.shapes import cylinder, joined, punched, sphere

SMOOTH = Energy(plate=1.0, variation=20.0)

CLOSED = {
    "sphere": punched(sphere(4), (0, 0, 1), (1, 0, 0), (0, -0.8, -0.6), radius=0.35),
    "tube": punched(cylinder(40, 30), (1, 0, 0), (0, -1, 1), radius=0.4),
    "two pieces": joined(punched(sphere(3), (0, 0, 1), radius=0.5), punched(sphere(3, 0.3), (0, 0.3, 0), radius=0.2)),
}


def all_loops(mesh: TriangleMesh) -> list[IntArray]:
    return boundary_loops(mesh.triangles).loops


def short_loops(mesh: TriangleMesh) -> list[IntArray]:
    """All loops but the longest."""
    return sorted(all_loops(mesh), key=len)[:-1]


def filled(mesh: TriangleMesh, loops: list[IntArray], energy: Energy = SMOOTH) -> FilledMesh:
    return fair_holes(close_holes(mesh, loops), energy)


def assert_keeps(result: FilledMesh, mesh: TriangleMesh) -> None:
    """The measured mesh is a bit-exact prefix, and every mark fits."""
    n, m = len(mesh.vertices), len(mesh.triangles)
    assert (result.n_measured_vertices, result.n_measured_triangles) == (n, m)
    assert result.mesh.vertices[:n].tobytes() == mesh.vertices.tobytes()
    assert result.mesh.triangles[:m].tobytes() == mesh.triangles.tobytes()
    assert len(result.vertex_hole) == len(result.mesh.vertices) - n == result.invented_vertices.sum()
    assert len(result.triangle_hole) == len(result.mesh.triangles) - m == result.invented_triangles.sum()
    assert np.isfinite(result.mesh.vertices).all()
    new = result.mesh.triangles[m:]
    inside = new >= n
    hole_of_corner = np.broadcast_to(result.triangle_hole[:, None], new.shape)
    assert (result.vertex_hole[new[inside] - n] == hole_of_corner[inside]).all()
