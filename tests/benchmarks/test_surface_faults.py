from pathlib import Path

import numpy as np
import pytest

from benchmarks.surface_faults import find_faults, find_faults_in_files
from quadpatch.repair import repair_file
from quadpatch.types import TriangleMesh
from tests.quadpatch.faulty_shapes import grown
from tests.quadpatch.shapes import joined, open_grid, punched, sphere, write_ply

SHEET = open_grid(8)
# Over the middle of the sheet, which lies in z = 0 with one unit between vertices.
MIDDLE = 27


def test_a_sound_repair_has_no_fault(tmp_path: Path) -> None:
    before, after = write_ply(tmp_path / "in.ply", punched(sphere(3), (0, 0, 1), radius=0.25)), tmp_path / "out.ply"
    repair_file(before, after, "smooth")
    faults = find_faults_in_files(before, after)
    assert faults.is_kept
    assert faults.n_new_triangles > 20
    counts = faults.n_boundary, faults.n_nonmanifold, faults.n_doubled, faults.n_folds, faults.n_slivers
    assert (*counts, faults.n_crossings) == (0, 0, 0, 0, 0, 0)


def test_nothing_new_is_no_fault_whatever_the_mesh() -> None:
    crossed = joined(sphere(2), sphere(2, 1.01), SHEET)
    faults = find_faults(crossed, crossed)
    assert faults.is_kept
    assert (faults.n_new_triangles, faults.n_folds, faults.n_crossings, faults.n_doubled) == (0, 0, 0, 0)


@pytest.mark.parametrize("change", ["vertex", "sign", "triangle", "lost"])
def test_changed_measured_rows_are_seen(change: str) -> None:
    vertices, triangles = SHEET.vertices.copy(), SHEET.triangles.copy()
    if change == "vertex":
        vertices[3, 0] = np.nextafter(vertices[3, 0], 9)
    elif change == "sign":
        vertices[3, 2] = -0.0
    elif change == "triangle":
        triangles[2] = np.roll(triangles[2], 1)
    else:
        triangles = triangles[:-1]
    assert not find_faults(SHEET, TriangleMesh(vertices, triangles)).is_kept


@pytest.mark.parametrize(("height", "n_folds"), [(0.1, 1), (-0.1, 1), (3.0, 0)])
@pytest.mark.parametrize("is_flipped", [False, True])
def test_a_flap_folded_back_over_its_rim_is_a_fold_in_either_direction(
    height: float, n_folds: int, is_flipped: bool
) -> None:
    # The rim edge from vertex 0 to vertex 1 runs along x; the sheet lies at greater y.
    flap = [[0, 1, -1] if is_flipped else [1, 0, -1]]
    after = grown(SHEET, [SHEET.vertices[0] + [0.5, 0.8, height]], flap)
    assert find_faults(SHEET, after).n_folds == n_folds


def test_a_fold_is_found_on_files_that_repeat_their_vertices() -> None:
    flat = TriangleMesh(
        SHEET.vertices[SHEET.triangles].reshape(-1, 3), np.arange(3 * len(SHEET.triangles)).reshape(-1, 3)
    )
    tip = SHEET.vertices[0] + [0.5, 0.8, 0.1]
    after = grown(flat, [SHEET.vertices[1], SHEET.vertices[0], tip], [[-1, -2, -3]])
    assert find_faults(flat, after).n_folds == 1


@pytest.mark.parametrize("number", ["f4", "f8"])
def test_vertices_that_differ_by_rounding_are_one(number: str, tmp_path: Path) -> None:
    """Beside a seam that is torn in the last bit, a new triangle crosses nothing."""
    precision = np.float32 if number == "f4" else np.float64
    vertices = (SHEET.vertices + 10.1).astype(precision)
    own = np.nextafter(vertices[:2], precision(100))
    torn = grown(TriangleMesh(vertices.astype(np.float64), SHEET.triangles), own.astype(np.float64), [])
    first = torn.triangles[0].tolist()
    torn.triangles[0] = [len(vertices) + corner if corner < 2 else corner for corner in first]
    after = grown(torn, [torn.vertices[0] + np.array([0.5, -0.8, 0.1])], [[1, 0, -1]])
    files = write_ply(tmp_path / "in.ply", torn, number), write_ply(tmp_path / "out.ply", after, number)
    faults = find_faults_in_files(*files)
    assert (faults.is_kept, faults.n_crossings, faults.n_folds, faults.n_nonmanifold) == (True, 0, 0, 0)
    assert faults.n_boundary == 4 * 7 + 1


@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_triangle_through_the_sheet_crosses_it_at_any_scale(scale: float, offset: float) -> None:
    moved = TriangleMesh(scale * (SHEET.vertices + offset), SHEET.triangles)
    blade = moved.vertices[MIDDLE] + scale * np.array([[0.3, 0.4, -1], [0.4, 0.3, -1], [0.35, 0.45, 1]])
    faults = find_faults(moved, grown(moved, blade, [[-1, -2, -3]]))
    assert faults.crossing.tolist() == [len(moved.triangles)]
    above = find_faults(moved, grown(moved, blade + scale * np.array([0, 0, 1.5]), [[-1, -2, -3]]))
    assert above.n_crossings == 0


@pytest.mark.parametrize("size", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("height", [0.0, 1e-12, 1e-3])
def test_a_triangle_that_lies_on_the_sheet_crosses_it(height: float, size: float) -> None:
    corners = SHEET.vertices[MIDDLE] + [0.11, 0.13, height] + size * np.array([[0, 0, 0], [1, 0, 0], [0.3, 0.9, 0]])
    for order in ([[-1, -2, -3]], [[-1, -3, -2]]):
        assert find_faults(SHEET, grown(SHEET, corners, order)).n_crossings == (height < 1e-6)


def test_a_corner_that_only_touches_an_edge_crosses_nothing() -> None:
    """A triangle without area at the rim brings a corner that lies on the edge of another measured triangle."""
    along = np.linspace(0.05, 0.95, 37)
    for share in along.tolist():
        corner = (1 - share) * SHEET.vertices[0] + share * SHEET.vertices[1]
        measured = grown(SHEET, [corner], [[1, 0, -1]])
        new = corner + np.array([[-0.3, -0.8, 0.3], [0.3, -0.8, -0.4]])
        n = len(SHEET.vertices)
        assert find_faults(measured, grown(measured, new, [[n, -1, -2]])).n_crossings == 0


def test_sheets_that_cross_exactly_at_their_edges_are_seen() -> None:
    """Both have their edges at the same places along x, so edges meet edges."""
    upright = TriangleMesh(SHEET.vertices[:, [0, 2, 1]] + [0, 0.3, 0.2], SHEET.triangles)
    assert find_faults(SHEET, joined(SHEET, upright)).n_crossings == 14


def test_doubled_triangles_and_edges_of_three_are_counted_once_each() -> None:
    a, b, c = SHEET.triangles[10].tolist()
    doubled = find_faults(SHEET, grown(SHEET, [], [[c, b, a]]))
    assert (doubled.n_doubled, doubled.n_crossings, doubled.n_nonmanifold) == (1, 1, 0)
    fin = find_faults(SHEET, grown(SHEET, [SHEET.vertices[a] + [0, 0, 1]], [[a, b, -1]]))
    assert (fin.n_doubled, fin.n_nonmanifold) == (0, 1)


def test_a_measured_duplicate_at_a_rim_is_no_fault_of_the_fill() -> None:
    twice = TriangleMesh(SHEET.vertices, np.concatenate([SHEET.triangles, SHEET.triangles[:1]]))
    start, end = SHEET.triangles[0][:2].tolist()
    faults = find_faults(twice, grown(twice, [SHEET.vertices[0] + [0.5, -0.8, 0]], [[end, start, -1]]))
    assert (faults.n_doubled, faults.n_nonmanifold, faults.n_folds) == (0, 0, 0)


def test_a_sliver_has_no_direction_that_could_fold() -> None:
    start, end = SHEET.vertices[:2]
    faults = find_faults(SHEET, grown(SHEET, [0.3 * start + 0.7 * end], [[1, 0, -1]]))
    assert (faults.n_slivers, faults.n_folds) == (1, 0)
