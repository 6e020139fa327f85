import numpy as np
import pytest

from quadpatch.mesh.measures import surface_area
from quadpatch.mesh.surface_facts import surface_facts
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import joined, open_grid, punched, sphere

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 2.0) for z in (0.0, 3.0)])
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
BOX = TriangleMesh(CORNERS, np.array([t for a, b, c, d in SIDES for t in ((a, b, c), (a, c, d))]))


@pytest.mark.parametrize("shift", [0.0, 1e6])
def test_a_closed_box_has_its_area_and_its_volume_wherever_it_lies(shift: float) -> None:
    facts = surface_facts(TriangleMesh(BOX.vertices + shift, BOX.triangles))
    assert (facts.triangles, facts.boundary_loops, facts.boundary_length, facts.components) == (12, 0, 0.0, 1)
    assert facts.is_watertight
    assert facts.area == pytest.approx(22.0)
    assert facts.volume == pytest.approx(6.0)


def test_a_box_that_faces_inwards_has_a_negative_volume() -> None:
    assert surface_facts(TriangleMesh(BOX.vertices, BOX.triangles[:, ::-1])).volume == pytest.approx(-6.0)


def test_a_box_without_a_triangle_is_open_and_has_no_volume() -> None:
    facts = surface_facts(TriangleMesh(BOX.vertices, BOX.triangles[1:]))
    assert (facts.boundary_loops, facts.is_watertight, facts.volume) == (1, False, None)
    sides = np.linalg.norm(BOX.vertices[BOX.triangles[0]] - BOX.vertices[np.roll(BOX.triangles[0], 1)], axis=1)
    assert facts.boundary_length == pytest.approx(sides.sum())


@pytest.mark.parametrize("change", ["turned over", "third face"])
def test_a_surface_that_does_not_bound_a_body_is_not_watertight(change: str) -> None:
    triangles = np.array(BOX.triangles)
    if change == "turned over":
        triangles[0] = triangles[0, ::-1]
    else:
        triangles = np.concatenate([triangles, triangles])
    assert not surface_facts(TriangleMesh(BOX.vertices, triangles)).is_watertight


def test_pieces_are_counted_and_lone_vertices_are_none() -> None:
    two = joined(BOX, TriangleMesh(BOX.vertices + 9.0, BOX.triangles))
    stray = TriangleMesh(np.concatenate([[[50.0, 0.0, 0.0]], two.vertices]), two.triangles + 1)
    facts = surface_facts(stray)
    assert (facts.components, facts.is_watertight) == (2, True)
    assert facts.volume == pytest.approx(12.0)


def test_a_mesh_of_several_chunks_is_summed_up_whole() -> None:
    ball = sphere(7)
    assert len(ball.triangles) > 1 << 16
    facts = surface_facts(ball)
    assert facts.area == pytest.approx(surface_area(ball))
    assert facts.volume == pytest.approx(4 / 3 * np.pi, rel=1e-3)


def test_every_loop_of_the_boundary_counts() -> None:
    facts = surface_facts(punched(sphere(4), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), radius=0.3))
    assert (facts.boundary_loops, facts.components) == (2, 1)
    assert surface_facts(open_grid(5)).boundary_length == pytest.approx(16.0)


def test_no_triangles_are_no_surface() -> None:
    facts = surface_facts(TriangleMesh(np.zeros((3, 3)), np.zeros((0, 3), np.int64)))
    assert (facts.components, facts.is_watertight, facts.volume, facts.area) == (0, False, None, 0.0)
