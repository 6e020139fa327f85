import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.fairing import THIN_PLATE, Energy, fair
from quadpatch.filling.fill import ALTERNATIVE_ENERGY, close_flat, close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.normals import vertex_areas
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.filling.fills import CLOSED, SMOOTH, all_loops, assert_keeps, filled, short_loops
from tests.quadpatch.shapes import (
    bumpy_plate,
    euler_characteristic,
    is_oriented_manifold,
    open_grid,
    punched,
    random_rotation,
    sphere,
)


def test_a_flat_hole_is_filled_flat_and_covers_what_was_lost() -> None:
    whole = bumpy_plate(40, 2.0)
    flat = TriangleMesh(whole.vertices * [1, 1, 0], whole.triangles)
    mesh = punched(flat, (0.3, 0.2, 0), radius=0.4)
    result = filled(mesh, short_loops(mesh))
    assert np.abs(result.mesh.vertices[:, 2]).max() < 1e-12
    assert area(result.mesh) == pytest.approx(area(flat), rel=1e-9)


def area(mesh: TriangleMesh) -> float:
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2


def radial_error(result: FilledMesh) -> FloatArray:
    new = result.mesh.vertices[result.n_measured_vertices :]
    return np.asarray(np.abs(np.linalg.norm(new, axis=1) - 1))


def test_the_missing_cap_of_a_sphere_comes_back() -> None:
    mesh = punched(sphere(4), (0.1, 0.2, 1), radius=0.5)
    smooth, plate = (radial_error(filled(mesh, all_loops(mesh), energy)) for energy in (SMOOTH, THIN_PLATE))
    # The cap is 0.13 high.
    assert smooth.max() < 0.01
    assert smooth.mean() < 0.25 * plate.mean()


def test_the_gap_is_the_mean_distance_between_the_thin_plate_and_a_second_opinion_whatever_was_chosen() -> None:
    mesh = CLOSED["sphere"]
    closed = close_holes(mesh, all_loops(mesh))
    plate = closed.plate
    triangles = np.concatenate([closed.near.adjacent_triangles, plate.triangles])
    first, second = (
        fair(plate.vertices, triangles, plate.is_new, energy) for energy in (THIN_PLATE, ALTERNATIVE_ENERGY)
    )
    n_measured = len(closed.near.used)
    distances = np.linalg.norm(second - first, axis=1)[n_measured:]
    areas = vertex_areas(plate.vertices, plate.triangles)[n_measured:]
    for energy in (SMOOTH, THIN_PLATE):
        result = fair_holes(closed, energy)
        holes = [result.vertex_hole == i for i in range(3)]
        expected = [np.average(distances[hole], weights=areas[hole]) for hole in holes]
        np.testing.assert_allclose(result.disagreement, expected, rtol=1e-9)
        assert (result.disagreement > 0).all()


def test_the_rim_turns_by_the_angle_between_neighbouring_normals() -> None:
    ball = CLOSED["sphere"]
    loops = all_loops(ball)
    turn = filled(ball, loops, THIN_PLATE).rim_variation
    for found, loop in zip(turn, loops, strict=True):
        # On a unit sphere normals are as far apart as the vertices themselves.
        rim = ball.vertices[loop]
        assert found == pytest.approx(np.linalg.norm(rim - np.roll(rim, 1, axis=0), axis=1).mean(), rel=0.2)
    flat = punched(open_grid(21, 2.0), (0, 0, 0), radius=0.3)
    assert filled(flat, short_loops(flat), THIN_PLATE).rim_variation.max() < 1e-12


def test_a_rough_rim_shows_in_the_signs_of_its_own_hole_only() -> None:
    mesh = punched(bumpy_plate(40, 2.0), (0, 0, 0), (0.6, 0.6, 0), radius=0.2)
    loops = short_loops(mesh)
    rough = mesh.vertices.copy()
    near = np.linalg.norm(rough - mesh.vertices[loops[0]].mean(axis=0), axis=1) < 0.3
    rough[near, 2] += np.random.default_rng(0).normal(0, 0.01, int(near.sum()))
    calm, ragged = (filled(one, loops, THIN_PLATE) for one in (mesh, TriangleMesh(rough, mesh.triangles)))
    assert ragged.rim_variation[0] > 2 * calm.rim_variation[0]
    assert ragged.disagreement[0] > 2 * calm.disagreement[0]
    assert ragged.rim_variation[1] == calm.rim_variation[1]
    # Energies have no unit: their weights go by the mean area of all new vertices.
    assert ragged.disagreement[1] == pytest.approx(calm.disagreement[1], rel=0.01)


def test_a_fill_that_runs_away_from_a_ragged_rim_is_held_by_the_thin_plate() -> None:
    mesh = punched(bumpy_plate(40, 2.0), (0, 0, 0), (0.6, 0.6, 0), radius=0.3)
    loops = short_loops(mesh)
    centre = mesh.vertices[loops[0]].mean(axis=0)
    rough = mesh.vertices.copy()
    near = np.linalg.norm(rough - centre, axis=1) < 0.45
    rough[near] += np.random.default_rng(0).normal(0, 0.03, (int(near.sum()), 3))
    ragged = TriangleMesh(rough, mesh.triangles)
    closed = close_holes(ragged, loops)
    result = fair_holes(closed, Energy(variation=1.0))
    plate = closed.plate.vertices[len(closed.near.used) :] + closed.near.centre
    is_plate = (result.mesh.vertices[result.n_measured_vertices :] == plate).all(axis=1)
    assert is_plate[result.vertex_hole == 0].all()
    assert not is_plate[result.vertex_hole == 1].any()
    assert result.disagreement[0] > 10 * result.disagreement[1]


def test_far_away_scans_lose_nothing_beyond_their_own_rounding() -> None:
    mesh = punched(bumpy_plate(40, 2.0), (0.2, -0.3, 0), radius=0.4)
    near = filled(mesh, short_loops(mesh))
    shift = np.array([1e6, -2e6, 5e5])
    moved = TriangleMesh(mesh.vertices + shift, mesh.triangles)
    far = filled(moved, short_loops(moved))
    assert (far.mesh.triangles == near.mesh.triangles).all()
    # The rounded rim itself is off by up to half a unit in the last place of 2e6.
    assert np.abs(far.mesh.vertices - shift - near.mesh.vertices).max() < 20 * np.spacing(2e6)


@given(seed=st.integers(0, 2**32 - 1), power=st.integers(-20, 20))
@settings(max_examples=15)
def test_a_fill_moves_turns_and_grows_with_its_mesh(seed: int, power: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = punched(bumpy_plate(30, 2.0), (0.3, 0.2, 0), (-0.5, -0.4, 0), radius=0.35)
    rotation, shift, scale = random_rotation(rng), rng.normal(0, 3, 3), 2.0**power
    moved = TriangleMesh(scale * (mesh.vertices @ rotation.T + shift), mesh.triangles)
    here, there = (filled(one, short_loops(one)) for one in (mesh, moved))
    assert (here.mesh.triangles == there.mesh.triangles).all()
    expected = scale * (here.mesh.vertices @ rotation.T + shift)
    assert np.abs(there.mesh.vertices - expected).max() < 1e-9 * scale


def test_a_flat_closing_leaves_new_vertices_on_the_triangles_that_span_the_rim() -> None:
    """Nothing bulges: the missing cap of a sphere comes back as a lid within the convex hull of its planar rim."""
    ball = sphere(4)
    top = ball.vertices[:, 2] > 0.8
    mesh = TriangleMesh(ball.vertices, ball.triangles[~top[ball.triangles].any(axis=1)])
    (loop,) = all_loops(mesh)
    result = close_flat(mesh, [loop])
    assert_keeps(result, mesh)
    assert is_oriented_manifold(result.mesh.triangles)
    assert euler_characteristic(result.mesh.triangles) == 2
    new, rim = result.mesh.vertices[result.n_measured_vertices :], mesh.vertices[loop]
    assert len(new) > 30
    assert new[:, 2].max() <= rim[:, 2].max()
    assert new[:, 2].min() >= rim[:, 2].min()
    assert np.isnan(result.disagreement).all()
    assert np.isnan(result.rim_variation).all()


def test_a_flat_closing_of_a_flat_hole_is_flat_and_as_dense_as_what_was_lost() -> None:
    whole = open_grid(41, 2.0)
    mesh = punched(whole, (0, 0, 0), radius=0.4)
    result = close_flat(mesh, short_loops(mesh))
    new = result.mesh.vertices[result.n_measured_vertices :]
    lost = len(whole.vertices) - len(np.unique(mesh.triangles))
    assert (new[:, 2] == 0).all()
    assert 0.5 < len(new) / lost < 2


def test_a_flat_closing_of_no_hole_gives_the_mesh_back() -> None:
    result = close_flat(sphere(2), [])
    assert result.mesh.vertices.tobytes() == sphere(2).vertices.tobytes()
    assert result.mesh.triangles.tobytes() == sphere(2).triangles.tobytes()


def test_a_graded_fill_has_few_vertices_far_from_its_rim_and_about_the_same_shape() -> None:
    mesh = punched(sphere(5), (0.1, 0.2, 1), radius=0.6)
    loops = all_loops(mesh)
    uniform, graded = (close_holes(mesh, loops, graded=graded) for graded in (False, True))
    for energy in (SMOOTH, THIN_PLATE):
        dense, thin = fair_holes(uniform, energy), fair_holes(graded, energy)
        assert_keeps(thin, mesh)
        assert len(thin.vertex_hole) < 0.5 * len(dense.vertex_hole)
        heights = [np.linalg.norm(fill.mesh.vertices[fill.n_measured_vertices :], axis=1) for fill in (dense, thin)]
        lowest, other = (1 - height.min() for height in heights)
        assert other == pytest.approx(lowest, rel=0.25)
    assert graded.disagreement == pytest.approx(uniform.disagreement, rel=0.2)


def test_grading_changes_nothing_where_holes_are_small_for_their_edges() -> None:
    mesh = punched(sphere(3), (0.1, 0.2, 1), radius=0.3)
    uniform, graded = (close_holes(mesh, all_loops(mesh), graded=graded) for graded in (False, True))
    assert graded.plate.grading is None
    assert graded.plate.vertices.tobytes() == uniform.plate.vertices.tobytes()
