import numpy as np

from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.restoration.least_squares import extend_smoothly
from quadpatch.restoration.normal_fitting import EDGES, SMOOTH, fit_to_normals
from quadpatch.types import TriangleMesh
from tests.quadpatch.restoration.boxes import scattered, step
from tests.quadpatch.shapes import sphere


def test_an_edge_that_the_least_squares_mesh_rounds_off_gets_sharp() -> None:
    mesh = step()
    missing = scattered(mesh, 0.3)
    rounded = extend_smoothly(mesh.triangles, missing, mesh.vertices)
    sharp = fit_to_normals(TriangleMesh(rounded, mesh.triangles), missing, EDGES)
    before, after = (np.sqrt((distance_to_mesh(x[missing], mesh) ** 2).mean()) for x in (rounded, sharp))
    assert after < 0.2 * before


def test_a_sphere_stays_round() -> None:
    ball = sphere(4)
    missing = scattered(ball, 0.3)
    start = TriangleMesh(extend_smoothly(ball.triangles, missing, ball.vertices), ball.triangles)
    radius = np.linalg.norm(fit_to_normals(start, missing, SMOOTH)[missing], axis=1)
    np.testing.assert_allclose(radius, 1.0, atol=2e-3)


def test_measured_vertices_keep_their_bits_and_the_input_stays() -> None:
    mesh = step()
    missing = scattered(mesh, 0.3)
    spoilt = TriangleMesh(mesh.vertices + 0.1 * missing[:, None], mesh.triangles)
    kept = spoilt.vertices.copy()
    fitted = fit_to_normals(spoilt, missing, SMOOTH)
    assert fitted[~missing].tobytes() == mesh.vertices[~missing].tobytes()
    assert spoilt.vertices.tobytes() == kept.tobytes()


def test_a_mesh_that_misses_nothing_comes_back() -> None:
    mesh = step()
    none = np.zeros(len(mesh.vertices), bool)
    assert fit_to_normals(mesh, none, EDGES).tobytes() == mesh.vertices.tobytes()
