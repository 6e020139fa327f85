import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from quadpatch.calibration.synthetic_holes import MeshWithHoles, Spacing, UncutSurface, cut_holes
from quadpatch.mesh.boundary import boundary_edges, boundary_loops
from quadpatch.mesh.loop_diameter import loop_diameter
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.topology import directed_edges
from quadpatch.types import IntArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, cylinder, euler_characteristic, open_grid, punched, sphere

SHEET = punched(bumpy_plate(90, 2.0), (0.3, 0.3, 0), (-0.5, 0.2, 0), radius=0.12)
EDGE = mean_edge_length(SHEET)
LONGEST = float(np.linalg.norm(np.diff(SHEET.vertices[directed_edges(SHEET.triangles)], axis=1), axis=2).max())


def punched_at_random(mesh: TriangleMesh, diameter: float, spacing: Spacing, seed: int = 0) -> MeshWithHoles:
    return cut_holes(UncutSurface(mesh), diameter, spacing, np.random.default_rng(seed))


def rim_vertices(mesh: TriangleMesh) -> IntArray:
    return np.unique(boundary_edges(mesh.triangles))


@settings(max_examples=10)
@given(seed=st.integers(0, 1000), diameter=st.floats(0.1, 0.4), margin=st.floats(0.05, 0.2))
def test_holes_keep_their_margin_from_every_border_and_from_each_other(
    seed: int, diameter: float, margin: float
) -> None:
    cut = punched_at_random(SHEET, diameter, Spacing(EDGE, margin), seed)
    removed, rims = SHEET.vertices[cut.removed], SHEET.vertices[rim_vertices(SHEET)]
    assert np.linalg.norm(removed[:, None] - rims, axis=2).min() > margin
    # The first hole leaves room for another one on a sheet of this size, wherever it lies.
    assert len(cut.loops) >= 2
    for i, loop in enumerate(cut.loops):
        others = SHEET.vertices[np.concatenate([other for j, other in enumerate(cut.loops) if j != i])]
        apart = np.linalg.norm(SHEET.vertices[loop][:, None] - others, axis=2)
        # Vertices that are gone lie two margins apart, and a rim at most one edge from them.
        assert apart.min() > 2 * margin - 2 * LONGEST


@settings(max_examples=20)
@given(seed=st.integers(0, 1000), diameter=st.floats(0.1, 0.4), margin=st.floats(0.05, 0.2))
def test_holes_are_cut_until_there_is_no_room_left(seed: int, diameter: float, margin: float) -> None:
    cut = punched_at_random(SHEET, diameter, Spacing(EDGE, margin), seed)
    # No disk is wider than the hole that was asked for.
    reach = diameter / 2 + margin
    surface = SHEET.vertices[np.unique(SHEET.triangles)]
    to_rim = np.asarray(cKDTree(SHEET.vertices[rim_vertices(SHEET)]).query(surface)[0])
    to_gone = np.asarray(cKDTree(SHEET.vertices[cut.removed]).query(surface)[0])
    assert (to_gone[to_rim > reach] <= 2 * reach).all()


def test_loops_are_the_new_rims_and_all_of_them() -> None:
    cut = punched_at_random(SHEET, 0.25, Spacing(EDGE, 2 * EDGE))
    old = {tuple(loop.tolist()) for loop in boundary_loops(SHEET.triangles).loops}
    now = {tuple(loop.tolist()) for loop in boundary_loops(cut.mesh.triangles).loops}
    assert old < now
    assert {tuple(loop.tolist()) for loop in cut.loops} == now - old
    assert not cut.removed[np.concatenate(cut.loops)].any()


def test_what_is_left_and_what_was_cut_away_make_up_the_mesh() -> None:
    cut = punched_at_random(SHEET, 0.25, Spacing(EDGE, 2 * EDGE))
    np.testing.assert_array_equal(cut.mesh.triangles, SHEET.triangles[~cut.cut_away])
    np.testing.assert_array_equal(cut.cut_away, cut.removed[SHEET.triangles].any(axis=1))
    assert cut.mesh.vertices is SHEET.vertices
    assert not cut.removed[cut.mesh.triangles].any()


def test_rims_are_as_wide_as_they_were_asked_to_be() -> None:
    cut = punched_at_random(SHEET, 0.3, Spacing(EDGE, 2 * EDGE))
    widths = [loop_diameter(SHEET.vertices[loop]) for loop in cut.loops]
    assert np.median(widths) == pytest.approx(0.3, abs=0.4 * EDGE)


def test_on_a_crumpled_surface_every_hole_is_one_disk_of_that_width_or_is_not_cut() -> None:
    flat = open_grid(120, 2.0)
    noise = np.random.default_rng(0).normal(0, 0.6 * mean_edge_length(flat), len(flat.vertices))
    rough = TriangleMesh(flat.vertices + noise[:, None] * [0, 0, 1], flat.triangles)
    cut = punched_at_random(rough, 0.25, Spacing(mean_edge_length(rough), 0.05))
    widths = [loop_diameter(rough.vertices[loop]) for loop in cut.loops]
    assert len(widths) > 3
    assert min(widths) > 0.7 * 0.25
    assert euler_characteristic(cut.mesh.triangles) == euler_characteristic(rough.triangles) - len(cut.loops)


@pytest.mark.parametrize("mesh", [sphere(4), cylinder(60, 80)], ids=["sphere", "cylinder"])
def test_every_hole_takes_one_disk(mesh: TriangleMesh) -> None:
    edge = mean_edge_length(mesh)
    cut = punched_at_random(mesh, 6 * edge, Spacing(edge, 2 * edge))
    assert len(cut.loops) > 5
    assert euler_characteristic(cut.mesh.triangles) == euler_characteristic(mesh.triangles) - len(cut.loops)


def test_what_faces_as_a_centre_does_goes_by_all_triangles_around_each_vertex() -> None:
    ball = sphere(3)
    surface, normals = UncutSurface(ball), vertex_normals(ball.vertices, ball.triangles)
    disk = np.arange(0, len(ball.vertices), 3)
    for centre in disk[:5].tolist():
        assert surface.facing(disk, centre).tolist() == disk[normals[disk] @ normals[centre] > 0].tolist()


def test_nothing_is_cut_where_all_vertices_were_rounded_to_one_place() -> None:
    one_place = TriangleMesh(np.full_like(SHEET.vertices, 1e17), SHEET.triangles)
    cut = punched_at_random(one_place, 0.0, Spacing(0.0, 0.0))
    assert cut.loops == []
    assert not cut.removed.any()


def test_a_hole_never_takes_the_surface_that_lies_behind_it() -> None:
    flat = open_grid(60, 2.0)
    n, gap = len(flat.vertices), np.array([0, 0, -0.01])
    thin = TriangleMesh(
        np.concatenate([flat.vertices, flat.vertices + gap]),
        np.concatenate([flat.triangles, flat.triangles[:, ::-1] + n]),
    )
    edge = mean_edge_length(flat)
    cut = punched_at_random(thin, 0.3, Spacing(edge, 2 * edge))
    assert len(cut.loops) > 3
    # The centres keep clear of each other on both sides, so no place is gone on both.
    assert not (cut.removed[:n] & cut.removed[n:]).any()


def test_no_more_holes_are_cut_than_were_asked_for() -> None:
    for most in (1, 3):
        assert len(punched_at_random(SHEET, 0.2, Spacing(EDGE, 2 * EDGE, most)).loops) == most


@pytest.mark.parametrize("mesh", [open_grid(8, 0.5), TriangleMesh(np.zeros((4, 3)), np.zeros((0, 3), np.int64))])
def test_nothing_is_cut_where_there_is_no_room(mesh: TriangleMesh) -> None:
    cut = punched_at_random(mesh, 0.4, Spacing(0.07, 0.2))
    assert cut.loops == []
    assert not cut.removed.any()
    assert not cut.cut_away.any()
    np.testing.assert_array_equal(cut.mesh.triangles, mesh.triangles)


def test_the_same_generator_cuts_the_same_holes_another_one_others_and_neither_changes_the_mesh() -> None:
    before = SHEET.vertices.tobytes(), SHEET.triangles.tobytes()
    one, same, other = (punched_at_random(SHEET, 0.2, Spacing(EDGE, 2 * EDGE), seed) for seed in (1, 1, 2))
    assert one.removed.tobytes() == same.removed.tobytes()
    assert [loop.tolist() for loop in one.loops] == [loop.tolist() for loop in same.loops]
    assert one.removed.tobytes() != other.removed.tobytes()
    assert before == (SHEET.vertices.tobytes(), SHEET.triangles.tobytes())
