from pathlib import Path

import pytest

from benchmarks.bridges import COLUMNS, GAPS, GAPS_OF_MESHES, Case, Outcome, _row, measure, mesh_cases, smooth_cases
from quadpatch.mesh.holes import find_holes
from tests.quadpatch.filling.gaps import to_sphere
from tests.quadpatch.shapes import flipped, joined, moved, open_grid, sphere, write_ply


def test_known_surfaces_have_a_gap_of_each_width_and_their_strips_lie_near_them() -> None:
    cases = [case for case in smooth_cases() if case.gap == GAPS[1]]
    assert [case.name for case in cases] == ["sphere", "torus"]
    for case in cases:
        assert case.distance(case.mesh.vertices).max() < 1e-12
        assert len(find_holes(case.mesh)) == 2
        found = measure(case)
        assert (found.n_proposed, found.n_joined) == (1, 1)
        assert found.mean is not None
        assert found.plain is not None
        assert found.largest is not None
        assert found.mean < found.plain / 5
        assert found.mean < found.largest < 0.01
        assert found.expected is not None


def test_a_mesh_is_cut_across_its_longest_side_and_compared_with_itself(tmp_path: Path) -> None:
    whole = sphere(3)
    path = write_ply(tmp_path / "ball.ply", type(whole)(whole.vertices * [1.0, 1.2, 1.0], whole.triangles))
    cases = list(mesh_cases(path))
    assert [case.gap for case in cases] == pytest.approx([share * 3.7 for share in GAPS_OF_MESHES], rel=0.01)
    for case in cases:
        low, high = sorted(hole.centre[1] for hole in find_holes(case.mesh))
        assert case.gap <= high - low < case.gap + 0.5
        assert case.distance(whole.vertices[:5] * [1.0, 1.2, 1.0]).max() == pytest.approx(0, abs=1e-12)


def test_loops_that_can_not_be_joined_have_no_error() -> None:
    sides = joined(open_grid(6), flipped(moved(open_grid(6), (6.0, 0.0, 0.0))))
    case = Case("sides", sides, 1.0, to_sphere)
    found = measure(case)
    assert found == Outcome(0, 0)
    assert _row(case, found) == ["sides", "1", "0", "0", *["–"] * 4]
    assert len(_row(case, found)) == len(COLUMNS)
