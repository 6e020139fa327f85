import numpy as np

from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.restoration.placements import LEAST_SQUARES, moved_onto, placements, poisson_base
from quadpatch.types import TriangleMesh
from tests.quadpatch.restoration.boxes import scattered
from tests.quadpatch.shapes import sphere

BALL = sphere(4)


def test_every_way_keeps_what_was_measured_and_reads_nothing_else() -> None:
    missing = scattered(BALL, 0.4)
    spoilt = TriangleMesh(np.where(missing[:, None], 7.0, BALL.vertices), BALL.triangles)
    for way, vertices in placements(spoilt, missing, BALL).items():
        assert vertices[~missing].tobytes() == BALL.vertices[~missing].tobytes(), way
        assert distance_to_mesh(vertices[missing], BALL).max() < 0.02, way


def test_a_known_surface_of_another_size_corrects_a_deep_gap() -> None:
    """Measured vertices say by how much the surface is too small."""
    missing = BALL.vertices[:, 2] > 0.4
    smaller = TriangleMesh(0.9 * BALL.vertices, BALL.triangles)
    first = placements(BALL, missing, None)[LEAST_SQUARES]
    moved = moved_onto(TriangleMesh(first, BALL.triangles), missing, smaller)
    errors = [np.abs(np.linalg.norm(x[missing], axis=1) - 1).mean() for x in (first, moved)]
    assert errors[1] < 0.7 * errors[0]


def test_the_poisson_surface_of_the_measured_vertices_lies_close_to_them() -> None:
    missing = scattered(BALL, 0.6)
    surface = poisson_base(BALL, missing)
    assert distance_to_mesh(BALL.vertices, surface).max() < 0.03
