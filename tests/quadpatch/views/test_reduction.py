import numpy as np
import pytest

from quadpatch.mesh.boundary import boundary_edges, boundary_loops
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.types import BoolArray, FloatArray, TriangleMesh
from quadpatch.views.reduction import reduce_surface
from tests.quadpatch.shapes import bumpy_plate, joined, open_grid, punched, sphere


def measured_alone(mesh: TriangleMesh) -> BoolArray:
    return np.zeros(len(mesh.triangles), bool)


def disc_in_the_middle(mesh: TriangleMesh, radius: float) -> BoolArray:
    return np.asarray((np.linalg.norm(mesh.vertices[mesh.triangles][..., :2], axis=2) < radius).any(axis=1))


def rim_edges(mesh: TriangleMesh) -> set[tuple[float, ...]]:
    """Positions of both ends of each edge of the border."""
    return set(map(tuple, mesh.vertices[boundary_edges(mesh.triangles)].reshape(-1, 6).tolist()))


def test_a_mesh_of_fewer_triangles_stays_as_it_is() -> None:
    mesh = sphere(2)
    reduced = reduce_surface(mesh, measured_alone(mesh), 1000)
    assert np.array_equal(reduced.measured.vertices[reduced.measured.triangles], mesh.vertices[mesh.triangles])
    assert len(reduced.invented.triangles) == 0


@pytest.mark.parametrize(("n_before", "n_after"), [(80, 6000), (300, 2000)], ids=["collapsed", "clustered first"])
def test_a_surface_is_reduced_to_the_wanted_triangles_and_stays_where_it_is(n_before: int, n_after: int) -> None:
    plate = bumpy_plate(n_before, 4.0)
    reduced = reduce_surface(plate, measured_alone(plate), n_after)
    assert 0.9 * n_after <= len(reduced.measured.triangles) <= 1.1 * n_after
    cell = 4.0 / np.sqrt(n_after)
    assert distance_to_mesh(reduced.measured.vertices, plate).max() < 0.2 * cell
    assert distance_to_mesh(plate.vertices, reduced.measured).max() < 2 * cell


@pytest.mark.parametrize("n_after", [6000, 2500], ids=["collapsed", "clustered first"])
def test_borders_do_not_move(n_after: int) -> None:
    mesh = punched(bumpy_plate(80, 4.0), (0.5, 0.5, 0.0), radius=0.3)
    reduced = reduce_surface(mesh, measured_alone(mesh), n_after)
    assert len(reduced.measured.triangles) <= n_after
    before, after = rim_edges(mesh), rim_edges(reduced.measured)
    assert len(before) > 300
    assert before <= after


@pytest.mark.parametrize(("n_before", "n_after"), [(80, 6000), (300, 6000)], ids=["collapsed", "clustered first"])
def test_invented_surface_is_kept_and_the_seam_is_closed(n_before: int, n_after: int) -> None:
    plate = bumpy_plate(n_before, 4.0)
    is_invented = disc_in_the_middle(plate, 0.3)
    reduced = reduce_surface(plate, is_invented, n_after)
    assert np.array_equal(
        reduced.invented.vertices[reduced.invented.triangles], plate.vertices[plate.triangles[is_invented]]
    )
    assert np.array_equal(reduced.invented_source, np.flatnonzero(is_invented))
    assert len(reduced.measured.triangles) + len(reduced.invented.triangles) <= 1.1 * n_after
    turned = np.roll(np.array(sorted(rim_edges(reduced.invented))), 3, axis=1)
    assert set(map(tuple, turned.tolist())) <= rim_edges(reduced.measured)


def test_more_invented_surface_than_may_be_kept_is_reduced_with_the_rest() -> None:
    plate = bumpy_plate(200, 4.0)
    is_invented = disc_in_the_middle(plate, 1.8)
    reduced = reduce_surface(plate, is_invented, 4000)
    n_invented = len(reduced.invented.triangles)
    assert n_invented > 0
    assert len(reduced.measured.triangles) + n_invented < 1.5 * 4000
    assert is_invented[reduced.invented_source].all()
    shared = set(map(tuple, reduced.invented.vertices.tolist())) & set(map(tuple, reduced.measured.vertices.tolist()))
    assert len(shared) > 50


def test_borders_are_reduced_where_there_is_little_else() -> None:
    mesh = joined(*(TriangleMesh(at + sphere(0, 0.1).vertices[:3], np.array([[0, 1, 2]])) for at in grid_of_places()))
    assert len(reduce_surface(mesh, measured_alone(mesh), 300).measured.triangles) == 900
    bounded = reduce_surface(mesh, measured_alone(mesh), 300, is_bounded=True)
    assert 0 < len(bounded.measured.triangles) < 900


def grid_of_places() -> FloatArray:
    return open_grid(30, 6.0).vertices


def test_colours_are_means_and_vertices_without_one_do_not_count() -> None:
    plate = open_grid(200, 2.0)
    left = plate.vertices[:, :1] < 0
    colours = np.where(left, [[200.0, 0.0, 0.0]], [[0.0, 0.0, 100.0]])
    colours[::3] = np.nan
    reduced = reduce_surface(plate, measured_alone(plate), 3000, colours)
    far = np.abs(reduced.measured.vertices[:, 0]) > 0.1
    assert reduced.measured_colours is not None
    expected = np.where(reduced.measured.vertices[far, :1] < 0, [[200.0, 0.0, 0.0]], [[0.0, 0.0, 100.0]])
    found = reduced.measured_colours[far]
    known = np.isfinite(found).all(axis=1)
    assert known.mean() > 0.95
    assert np.allclose(found[known], expected[known])


def test_vertices_at_equal_positions_are_one() -> None:
    ball = sphere(4)
    soup = TriangleMesh(ball.vertices[ball.triangles].reshape(-1, 3), np.arange(ball.triangles.size).reshape(-1, 3))
    reduced = reduce_surface(soup, measured_alone(soup), 2000)
    assert len(reduced.measured.triangles) == 2000
    assert not boundary_loops(reduced.measured.triangles).loops
