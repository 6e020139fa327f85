import numpy as np
import pytest

from quadpatch.colours.continuation import NewColours, continue_colours
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.options import HoleOptions, RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.colours.coloured import Coloured, even, grains, plate, stripes
from tests.quadpatch.shapes import bumpy_plate


@pytest.fixture(scope="module")
def filled() -> FilledMesh:
    return plate()


def coloured(filled: FilledMesh, colours: FloatArray) -> Coloured:
    return Coloured(filled, colours[: filled.n_measured_vertices])


def continued(scan: Coloured, seed: int = 0) -> NewColours:
    return continue_colours(scan.filled, scan.colours, scan.edges, np.random.default_rng(seed))


def new_part(filled: FilledMesh, colours: FloatArray) -> FloatArray:
    return colours[filled.n_measured_vertices :]


def squared(a: FloatArray, b: FloatArray) -> float:
    return float(((a - b) ** 2).mean())


@pytest.fixture(scope="module")
def granite(filled: FilledMesh) -> tuple[Coloured, FloatArray, NewColours]:
    truth = grains(filled.mesh.vertices, np.random.default_rng(1), 0.06)
    scan = coloured(filled, truth)
    return scan, new_part(filled, truth), continued(scan)


def test_grains_keep_three_times_the_gradients_of_harmonic_colours(
    granite: tuple[Coloured, FloatArray, NewColours],
) -> None:
    scan, truth, found = granite
    assert found.method == "exemplars"
    assert found.colours is not None
    both = found.colours, new_part(scan.filled, scan.harmonic)
    kept, blurred = (scan.energy(new) / scan.energy(truth) for new in both)
    assert kept > 0.5
    assert kept > 3 * blurred


def test_grains_lose_little_more_than_calibration_allows(granite: tuple[Coloured, FloatArray, NewColours]) -> None:
    scan, truth, found = granite
    assert found.colours is not None
    lost = squared(found.colours, truth) / squared(new_part(scan.filled, scan.harmonic), truth)
    assert 10 * np.log10(lost) < 1.5


def test_the_verdict_is_that_of_calibration_holes(granite: tuple[Coloured, FloatArray, NewColours]) -> None:
    _, _, found = granite
    assert found.verdict is not None
    assert found.verdict.n_holes >= 12
    assert found.verdict.kept > found.verdict.kept_harmonic + 0.25
    assert -1.5 < found.verdict.gain_db < 0.5


def test_no_new_colour_leaves_the_range_of_the_measured_ones(
    granite: tuple[Coloured, FloatArray, NewColours],
) -> None:
    scan, _, found = granite
    assert found.colours is not None
    assert np.isfinite(found.colours).all()
    assert (found.colours >= scan.colours.min(axis=0)).all()
    assert (found.colours <= scan.colours.max(axis=0)).all()


def test_the_same_seed_gives_the_same_bits(granite: tuple[Coloured, FloatArray, NewColours]) -> None:
    scan, _, found = granite
    assert found.colours is not None
    again = continued(scan).colours
    assert again is not None
    assert again.tobytes() == found.colours.tobytes()


def test_a_pattern_that_repeats_is_carried_on_closer_to_the_truth_than_harmonic_colours(filled: FilledMesh) -> None:
    truth = stripes(filled.mesh.vertices, 0.2)
    scan = coloured(filled, truth)
    found = continued(scan)
    assert found.colours is not None
    assert found.verdict is not None
    assert found.verdict.gain_db > 3
    missed = new_part(filled, truth)
    assert squared(found.colours, missed) < 0.5 * squared(new_part(filled, scan.harmonic), missed)


def test_colours_that_change_evenly_stay_harmonic(filled: FilledMesh) -> None:
    found = continued(coloured(filled, even(filled.mesh.vertices)))
    assert found.method == "harmonic"
    assert found.verdict is not None


def test_one_colour_stays_one_colour(filled: FilledMesh) -> None:
    found = continued(coloured(filled, np.full((len(filled.mesh.vertices), 3), 77.0)))
    assert found.method == "harmonic"


def test_a_hole_with_an_uncoloured_rim_vertex_is_left_out_and_others_are_not(
    granite: tuple[Coloured, FloatArray, NewColours],
) -> None:
    scan, _, _ = granite
    new = scan.filled.mesh.triangles[scan.filled.n_measured_triangles :]
    first = new[scan.filled.triangle_hole == 0]
    colours = scan.colours.copy()
    colours[first[first < len(colours)][0]] = np.nan
    found = continued(Coloured(scan.filled, colours)).colours
    assert found is not None
    is_first = scan.filled.vertex_hole == 0
    assert np.isnan(found[is_first]).all()
    assert np.isfinite(found[~is_first]).all()


def test_without_room_for_calibration_colours_stay_harmonic() -> None:
    small = plate(24, 0.3)
    scan = coloured(small, grains(small.mesh.vertices, np.random.default_rng(1), 0.1))
    assert continued(scan) == NewColours(None)


def test_a_mesh_without_fills_has_no_new_colours(filled: FilledMesh) -> None:
    nothing = filled.without(np.arange(len(filled.disagreement)))
    scan = coloured(nothing, grains(filled.mesh.vertices, np.random.default_rng(1), 0.06))
    assert continued(scan) == NewColours(None)


def test_on_narrow_strips_smaller_cells_find_sources() -> None:
    """A gap as long as the sheet, between strips that no patch of its size fits on."""
    sheet = bumpy_plate(120, 2.0)
    middle = np.abs(sheet.vertices[sheet.triangles][:, :, 0].mean(axis=1))
    torn = TriangleMesh(sheet.vertices, sheet.triangles[middle > 0.05])
    filled = inpaint(torn, None, RepairOptions(HoleOptions(bridges=((0, 1),)))).filled
    scan = coloured(filled, 128 + np.random.default_rng(1).normal(0, 25, (len(filled.mesh.vertices), 3)))
    found = continued(scan)
    assert found.verdict is not None
    assert found.verdict.n_holes >= 12


def test_without_room_for_any_source_colours_stay_harmonic(
    granite: tuple[Coloured, FloatArray, NewColours], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("quadpatch.colours.patches._LEAST_MEASURED", 1.1)
    scan, _, _ = granite
    assert continued(scan) == NewColours(None)
