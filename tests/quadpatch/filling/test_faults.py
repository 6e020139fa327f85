import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.faults import FOLD_ANGLE_DEG, Faults, find_faults
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.processes import ProcessPool
from quadpatch.types import FloatArray, TriangleMesh, Triangles
from tests.quadpatch.filling.handmade import fan, put_together, tent
from tests.quadpatch.shapes import flipped, joined, moved, open_grid, plate_with_disc, punched, random_rotation, sphere

# The outermost ring of `plate_with_disc(12, 2)` lies at this radius.
OUTER = 1 + 2 * 2 * np.pi / 12


def placed(filled: FilledMesh, vertices: FloatArray) -> FilledMesh:
    values = {**filled.__dict__, "mesh": TriangleMesh(vertices, filled.mesh.triangles)}
    return FilledMesh(**values)


def counts(faults: Faults) -> tuple[list[int], list[int]]:
    return faults.n_folds.tolist(), faults.crossings.tolist()


def hinge(angle_deg: float) -> FilledMesh:
    """Two triangles that meet in an edge under an angle between their normals; the second one is new."""
    turn = np.radians(angle_deg)
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 1, 0]])
    apex = np.array([[0.5, -np.cos(turn), -np.sin(turn)]])
    return put_together(TriangleMesh(vertices, np.array([[0, 1, 2]])), (apex, np.array([[1, 0, -1]])))


def needle(height: float) -> FilledMesh:
    """The hinge, all but closed, with a new triangle of some height over its edge."""
    folded = hinge(179.0)
    vertices = folded.mesh.vertices.copy()
    vertices[3] = [0.5, height * np.cos(np.radians(1)), -height * np.sin(np.radians(1))]
    return placed(folded, vertices)


@pytest.mark.parametrize("apex", [(0.0, 0.0, 0.0), (0.3, 0.2, 0.0), (0.0, 0.0, 0.5), (0.2, -0.3, 1.5)])
def test_a_tent_over_a_hole_has_no_fault(apex: tuple[float, float, float]) -> None:
    faults = find_faults(tent(apex))
    assert counts(faults) == ([0], [0])
    assert not faults.is_doubtful.any()
    assert not faults.is_wrong.any()
    assert faults.severity.tolist() == [0]


@pytest.mark.parametrize(("angle_deg", "n_turned"), [(15.0, 1), (0.0, 2)])
def test_an_apex_outside_of_its_rim_turns_triangles_over(angle_deg: float, n_turned: int) -> None:
    # Each of them folds at the rim, and the outermost ones against the fill as well.
    angle = np.radians(angle_deg)
    faults = find_faults(tent((1.03 * np.cos(angle), 1.03 * np.sin(angle), 0.0)))
    assert faults.n_folds.tolist() == [n_turned + 2]
    assert faults.crossings[0] > 0
    assert faults.is_wrong.tolist() == [True]
    assert faults.is_invalid.tolist() == [True]


@pytest.mark.parametrize(("angle_deg", "n_folds"), [(0, 0), (90, 0), (FOLD_ANGLE_DEG - 1, 0), (FOLD_ANGLE_DEG + 1, 1)])
def test_a_fold_begins_at_its_angle(angle_deg: float, n_folds: int) -> None:
    faults = find_faults(hinge(angle_deg))
    assert faults.n_folds.tolist() == [n_folds]
    assert faults.is_wrong.tolist() == [n_folds > 0]
    for name, expected in (("pairs", [[0, 1]]), ("edges", [[0, 1]])):
        assert np.sort(getattr(faults.folds, name), axis=1).tolist() == expected[:n_folds]


def test_a_lonely_triangle_closed_by_its_back_folds_at_three_edges() -> None:
    triangle = TriangleMesh(np.eye(3), np.array([[0, 1, 2]]))
    faults = find_faults(put_together(triangle, (np.zeros((0, 3)), np.array([[2, 1, 0]]))))
    assert counts(faults) == ([3], [0])
    assert faults.is_wrong.tolist() == [True]


@pytest.mark.parametrize(("height", "is_wrong"), [(1e-2, True), (1e-4, False), (0.0, False)])
def test_a_new_triangle_without_height_is_doubtful_at_most(height: float, is_wrong: bool) -> None:
    faults = find_faults(needle(height))
    assert faults.is_wrong.tolist() == [is_wrong]
    if height:
        assert faults.n_folds.tolist() == [1]
        assert faults.is_doubtful.tolist() == [True]
        assert faults.folds.is_sliver.tolist() == [not is_wrong]


def test_a_wrong_fill_is_worse_than_any_doubtful_one() -> None:
    doubtful, wrong = find_faults(needle(1e-4)), find_faults(hinge(170.0))
    assert 0 < doubtful.severity[0] < wrong.severity[0]


def test_a_measured_triangle_without_height_at_a_rim_excuses_the_fill() -> None:
    # The measured triangle is the needle now: its normal points the wrong way.
    turned = needle(1e-7)
    flat_rim = put_together(
        TriangleMesh(turned.mesh.vertices[[0, 1, 3]], np.array([[1, 0, 2]])),
        (turned.mesh.vertices[[2]], np.array([[0, 1, -1]])),
    )
    faults = find_faults(flat_rim)
    assert faults.n_folds.tolist() == [1]
    assert faults.folds.is_flat_rim.tolist() == [True]
    assert not faults.is_doubtful.any()


def test_a_rim_that_turns_over_itself_excuses_the_fill_there_and_nowhere_else() -> None:
    # Two measured triangles lie back to back; the fill goes on from the second.
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, 0.9, 0.01]])
    folded = TriangleMesh(vertices, np.array([[0, 1, 2], [1, 0, 3]]))
    at_rim = put_together(folded, (np.array([[0.1, 0.1, 0.02]]), np.array([[1, 3, -1]])))
    faults = find_faults(at_rim)
    assert faults.n_folds.tolist() == [1]
    assert faults.folds.is_tolerated.tolist() == [True]
    assert not faults.folds.is_flat_rim.any()
    far = joined(folded, moved(hinge(0).mesh, (9.0, 0, 0)))
    elsewhere = put_together(
        TriangleMesh(far.vertices, far.triangles[:3]),
        (far.vertices[[6]] + [[0.0, 0.05, 0.02]], np.array([[5, 4, -1]])),
    )
    assert find_faults(elsewhere).is_wrong.tolist() == [True]


def pole(height: float) -> TriangleMesh:
    """Three narrow, upright triangles around the z axis, from z = -1 to some height."""
    angle = 2 * np.pi * np.arange(3) / 3
    foot = np.stack([0.1 * np.cos(angle), 0.1 * np.sin(angle), np.full(3, -1.0)], axis=1)
    tip = np.array([[0.0, 0, height]])
    return TriangleMesh(np.concatenate([foot, tip]), np.array([[0, 1, 3], [1, 2, 3], [2, 0, 3]]))


def over_pole(height: float) -> FilledMesh:
    """A tent of 12 triangles above a pole, both measured but for the tent."""
    plate = plate_with_disc(12, 2)
    return put_together(joined(plate, pole(height)), (np.array([[0.0, 0, 0.3]]), fan(np.arange(12))))


@pytest.mark.parametrize(("height", "n_crossings"), [(0.2, 0), (2.0, 12)])
def test_a_pole_through_a_tent_is_run_into_by_every_triangle_around_it(height: float, n_crossings: int) -> None:
    faults = find_faults(over_pole(height))
    assert counts(faults) == ([0], [n_crossings])
    assert faults.is_wrong.tolist() == faults.is_invalid.tolist() == [n_crossings > 0]
    assert len(faults.crossing_fills) == 0


@pytest.mark.parametrize("part", [plate_with_disc(12, 2), moved(open_grid(3, 0.5), (0, 0, 0.5))])
def test_what_the_mesh_leaves_out_can_be_run_into_as_an_obstacle(part: TriangleMesh) -> None:
    whole = over_pole(2.0)
    n = plate_with_disc(12, 2).triangles.shape[0]
    pole_triangles, tent_triangles = whole.mesh.triangles[n : n + 3], whole.mesh.triangles[n + 3 :]
    measured = whole.mesh.triangles[:n]
    values = {
        **whole.__dict__,
        "mesh": TriangleMesh(whole.mesh.vertices, np.concatenate([measured, tent_triangles])),
        "n_measured_triangles": n,
    }
    without = FilledMesh(**values)
    assert find_faults(without).crossings.tolist() == [0]
    assert find_faults(without, obstacles=pole_triangles).crossings.tolist() == [12]


def two_tents(height: float) -> FilledMesh:
    """Two plates with holes, one above the other and facing it; the tent of the lower one grows towards the upper."""
    below, above = plate_with_disc(12, 2), flipped(moved(plate_with_disc(12, 2), (0, 0, 1.0)))
    n = len(below.vertices)
    return put_together(
        joined(below, above),
        (np.array([[0.0, 0, height]]), fan(np.arange(12))),
        (np.array([[0.03, 0.04, 0.9]]), fan(n + np.arange(12)[::-1])),
    )


def test_two_fills_that_run_through_each_other_are_rivals_and_neither_is_lost() -> None:
    assert counts(find_faults(two_tents(0.5))) == ([0, 0], [0, 0])
    faults = find_faults(two_tents(2.0))
    assert (faults.crossings > 0).all()
    assert faults.crossing_fills.tolist() == [[0, 1]]
    assert faults.is_invalid.tolist() == [False, False]
    assert faults.is_wrong.tolist() == [True, True]
    assert faults.is_wrong_alone.tolist() == [False, False]


@pytest.mark.parametrize("loop", [0, 1])
def test_of_loops_that_are_not_looked_at_nothing_is_told_but_they_can_be_run_into(loop: int) -> None:
    faults = find_faults(two_tents(2.0), np.array([loop]))
    assert (faults.crossings > 0).tolist() == [loop == 0, loop == 1]
    assert find_faults(two_tents(2.0), np.zeros(0, np.int64)).crossings.tolist() == [0, 0]
    folded = tent((1.03, 0.0, 0.0))
    assert find_faults(folded, np.zeros(0, np.int64)).n_folds.tolist() == [0]


@given(seed=st.integers(0, 2**32 - 1), size=st.sampled_from([1e-12, 1e-6, 1.0, 1e6, 1e12]), far=st.sampled_from([0, 9]))
@settings(max_examples=10)
def test_faults_are_the_same_in_every_unit_and_place(seed: int, size: float, far: float) -> None:
    rng = np.random.default_rng(seed)
    rotation, shift = random_rotation(rng), rng.normal(0, 1 + far, 3)
    for filled in (tent((1.03, 0.01, 0.0)), over_pole(2.0), two_tents(2.0), two_tents(0.5)):
        there = placed(filled, size * (filled.mesh.vertices @ rotation.T + shift))
        one, other = find_faults(filled), find_faults(there)
        assert other.n_folds.tolist() == one.n_folds.tolist()
        # Sheets that lie on each other in a plane do not after a rotation: their crossings are rounding.
        if filled.mesh.vertices[:, 2].any():
            assert other.crossings.tolist() == one.crossings.tolist()


def test_a_mesh_without_loops_has_no_faults() -> None:
    faults = find_faults(put_together(punched(sphere(2), (0, 0, 1), radius=0.5)))
    assert counts(faults) == ([], [])
    assert faults.is_wrong.tolist() == []


# Corners of a triangle that stands on a sheet, by how far they lie aside and their height.
POLE = np.array([[0.001, 0.002, 0.1], [0.002, -0.001, -0.1], [0.011, 0.003, 0.1]])


def with_many_fills(n_sides: int) -> tuple[FilledMesh, Triangles]:
    """A fine sheet, disks of which count as fills, and triangles that run through every third of them."""
    sheet = open_grid(200, 2.0)
    at = (np.arange(n_sides) + 0.5) * 2.0 / n_sides - 1.0
    centres = np.array([(x, y, 0.0) for x in at for y in at])
    distance = np.linalg.norm(sheet.vertices[sheet.triangles].mean(axis=1)[:, None] - centres, axis=2)
    hole = np.where(distance.min(axis=1) < 0.9 / n_sides, distance.argmin(axis=1), -1)
    corners = (centres[::3, None] + POLE).reshape(-1, 3)
    poles = TriangleMesh(corners, np.arange(len(corners)).reshape(-1, 3))
    mesh = joined(poles, sheet)
    is_inner = np.zeros(len(mesh.vertices), bool)
    is_inner[mesh.triangles[len(poles.triangles) :][hole >= 0]] = True
    is_inner[mesh.triangles[len(poles.triangles) :][hole < 0]] = False
    order = np.argsort(is_inner, kind="stable")
    obstacles, triangles = np.split(np.argsort(order)[mesh.triangles], [len(poles.triangles)])
    outside, inside, owner = triangles[hole < 0], triangles[hole >= 0], hole[hole >= 0]
    vertex_hole = np.zeros(len(order), np.int64)
    vertex_hole[inside] = owner[:, None]
    n_measured, unknown = int((~is_inner).sum()), np.zeros(len(centres))
    whole = TriangleMesh(mesh.vertices[order], np.concatenate([outside, inside]))
    return (
        FilledMesh(whole, n_measured, len(outside), owner, vertex_hole[n_measured:], unknown, unknown, []),
        obstacles,
    )


def test_many_fills_have_the_faults_that_each_has_by_itself_whatever_the_number_of_processes() -> None:
    filled, obstacles = with_many_fills(4)
    assert len(filled.triangle_hole) > 45_000
    alone = find_faults(filled, np.array([3]), obstacles)
    for n_processes in (1, 2, 3):
        with ProcessPool(n_processes) as pool:
            found = find_faults(filled, obstacles=obstacles, pool=pool)
        assert np.flatnonzero(found.crossings).tolist() == [*range(0, 16, 3)]
        assert found.is_invalid.tolist() == (found.crossings > 0).tolist()
        assert not len(found.crossing_fills)
        owner = filled.triangle_hole[found.crossing_triangles - filled.n_measured_triangles]
        assert found.crossing_triangles[owner == 3].tolist() == alone.crossing_triangles.tolist()
