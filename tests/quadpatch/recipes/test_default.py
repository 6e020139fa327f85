"""Also tests `quadpatch.recipes.learned_detail`."""

import numpy as np
import pytest

from quadpatch.errors import OptionError
from quadpatch.inpainters.dictionary import DictionaryInpainter, SelfDictionary
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.measures import diagonal
from quadpatch.mesh.raycast import RayScene
from quadpatch.options import HoleOptions, PatchOptions, RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.result import Repair
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.stages import Stages
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import (
    bumpy_plate,
    joined,
    open_grid,
    punched,
    random_rotation,
    relief,
    sphere,
)

PLACES = [(x, y, 0.0) for x in (-0.5, 0.1, 0.55) for y in (-0.45, 0.05, 0.5)]
WHOLE_RELIEF = relief(160, 2.0, 0.02, 14)
RELIEF = punched(WHOLE_RELIEF, *PLACES, radius=0.09)
SMALL_RELIEF = punched(relief(80, 2.0, 0.03, 8), *PLACES, radius=0.13)


@pytest.fixture(scope="module")
def smooth_relief() -> Repair:
    return inpaint(RELIEF, None, RepairOptions())


@pytest.fixture(scope="module")
def smooth_small_relief() -> Repair:
    return inpaint(SMALL_RELIEF, None, RepairOptions())


@pytest.fixture(scope="module")
def learned_relief() -> Repair:
    return inpaint(RELIEF, SelfDictionary(), RepairOptions())


def test_filling_tells_how_far_it_is() -> None:
    told: list[float] = []
    stages = Stages(lambda name, fraction: told.append(fraction) if name == "fill" else None)
    inpaint(RELIEF, None, RepairOptions(), stages)
    assert told == sorted(told)
    assert len(told) > 8
    assert max(np.diff(told)) < 0.5


def new_vertices(repair: Repair) -> FloatArray:
    return repair.filled.mesh.vertices[repair.filled.n_measured_vertices :]


def height_errors(repair: Repair) -> FloatArray:
    """Vertical distance of every new vertex to the whole relief."""
    above = new_vertices(repair) * [1, 1, 0] + [0, 0, 1]
    _, distance = RayScene(WHOLE_RELIEF).cast(above, np.tile([0.0, 0, -1], (len(above), 1)))
    return np.asarray(np.abs(new_vertices(repair)[:, 2] - (1 - distance)))


def judgements(repair: Repair) -> list[tuple[float, float]]:
    """Expected error and confidence of every hole behind the border, which comes first and has neither."""
    border, *holes = repair.results
    assert (border.verdict, border.expected_error, border.confidence) == ("skipped", None, None)
    found = []
    for result in holes:
        assert result.expected_error is not None
        assert result.confidence is not None
        found.append((result.expected_error, result.confidence))
    return found


def moved(mesh: TriangleMesh, seed: int) -> tuple[TriangleMesh, FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    rotation, shift = random_rotation(rng), rng.normal(0, 3, 3)
    return TriangleMesh(mesh.vertices @ rotation.T + shift, mesh.triangles), rotation, shift


@pytest.mark.slow
def test_what_was_learned_from_a_relief_beats_the_smooth_fill(smooth_relief: Repair, learned_relief: Repair) -> None:
    assert height_errors(learned_relief).mean() < 0.6 * height_errors(smooth_relief).mean()
    completion = learned_relief.completion
    assert completion is not None
    assert completion.blend_factor > 0
    filled = {result.hole.id for result in learned_relief.results if result.verdict == "filled"}
    assert filled == {learned_relief.chosen[i].id for i in np.flatnonzero(completion.displaced_holes).tolist()}
    assert len(filled) >= 6


@pytest.mark.slow
def test_holes_that_the_model_does_not_complete_stay_as_geometry_filled_them(
    smooth_relief: Repair, learned_relief: Repair
) -> None:
    completion = learned_relief.completion
    assert completion is not None
    left = ~completion.displaced_holes[learned_relief.filled.vertex_hole]
    assert left.any()
    same = (new_vertices(learned_relief) == new_vertices(smooth_relief)).all(axis=1)
    assert same[left].all()
    assert not same[~left].all()


def test_every_stage_is_gone_through_in_order() -> None:
    stages = Stages()
    inpaint(SMALL_RELIEF, SelfDictionary(), RepairOptions(), stages)
    names = ["holes", "fill", "smooth", "quadrangulate", "patchify", "learn", "inpaint", "reconstruct", "judge"]
    assert list(stages.seconds) == names
    geometry = Stages()
    inpaint(SMALL_RELIEF, None, RepairOptions(), geometry)
    assert list(geometry.seconds) == ["holes", "fill", "judge"]


@pytest.mark.parametrize("learn", [False, True])
@pytest.mark.slow
def test_measured_vertices_and_triangles_come_first_bit_for_bit(
    learn: bool, smooth_relief: Repair, learned_relief: Repair
) -> None:
    filled = (learned_relief if learn else smooth_relief).filled
    assert filled.mesh.vertices[: len(RELIEF.vertices)].tobytes() == RELIEF.vertices.tobytes()
    assert filled.mesh.triangles[: len(RELIEF.triangles)].tobytes() == RELIEF.triangles.tobytes()
    (border,) = boundary_loops(filled.mesh.triangles).loops
    assert len(border) == 4 * 159


def test_a_smooth_repair_moves_with_its_mesh(smooth_small_relief: Repair) -> None:
    mesh, rotation, shift = moved(SMALL_RELIEF, 1)
    there, here = inpaint(mesh, None, RepairOptions()), smooth_small_relief
    assert there.blend.energies == here.blend.energies
    assert (there.filled.mesh.triangles == here.filled.mesh.triangles).all()
    expected = here.filled.mesh.vertices @ rotation.T + shift
    measured = here.filled.n_measured_vertices
    assert np.abs(there.filled.mesh.vertices - expected)[:measured].max() < 1e-9
    # Rims are opened wider to weigh the energies: rounding may flip an edge of these fills, and shift weights a little.
    least = min(hole.diameter for hole in here.chosen)
    assert np.abs(there.filled.mesh.vertices - expected).max() < 0.01 * least
    for one, other in zip(here.results, there.results, strict=True):
        assert (one.verdict, one.code) == (other.verdict, other.code)
    assert len(judgements(here)) == len(PLACES)
    for (one_error, one_confidence), (other_error, other_confidence) in zip(
        judgements(here), judgements(there), strict=True
    ):
        assert other_error == pytest.approx(one_error)
        # It goes by the box around the mesh, which does not turn with it.
        turned = one_confidence ** (diagonal(SMALL_RELIEF) / diagonal(mesh))
        assert other_confidence == pytest.approx(turned, abs=1e-9)


@pytest.mark.slow
def test_a_learned_repair_moves_with_its_mesh_as_far_as_the_quads_do(
    smooth_relief: Repair, learned_relief: Repair
) -> None:
    # The mesher lays other quads over a turned mesh, so other patches are learned from and averaged: the same
    # triangles, and displacements that differ by less than half of what they are.
    mesh, rotation, shift = moved(RELIEF, 0)
    there = inpaint(mesh, SelfDictionary(), RepairOptions())
    here, smooth = learned_relief, smooth_relief
    assert (there.filled.mesh.triangles == here.filled.mesh.triangles).all()
    assert here.completion is not None
    assert there.completion is not None
    both = (here.completion.displaced_holes & there.completion.displaced_holes)[here.filled.vertex_hole]
    assert both.any()
    apart = np.linalg.norm(new_vertices(here) @ rotation.T + shift - new_vertices(there), axis=1)
    displaced = np.linalg.norm(new_vertices(here) - new_vertices(smooth), axis=1)
    assert apart[both].mean() < 0.5 * displaced[both].mean()


def test_where_one_energy_fills_a_repair_moves_and_grows_with_its_mesh_but_for_rounding() -> None:
    ball = punched(sphere(4), (0, 0, 1), (1, 0, 0), radius=0.3)
    here = inpaint(ball, None, RepairOptions())
    assert len(here.blend.energies) == 1
    mesh, rotation, shift = moved(ball, 1)
    there = inpaint(mesh, None, RepairOptions())
    assert (there.filled.mesh.triangles == here.filled.mesh.triangles).all()
    assert np.abs(there.filled.mesh.vertices - here.filled.mesh.vertices @ rotation.T - shift).max() < 1e-9
    doubled = inpaint(TriangleMesh(1024.0 * ball.vertices, ball.triangles), None, RepairOptions())
    assert (doubled.filled.mesh.vertices == 1024.0 * here.filled.mesh.vertices).all()


def test_a_mesh_twice_as_large_gets_the_same_repair_twice_as_large(smooth_small_relief: Repair) -> None:
    doubled = inpaint(TriangleMesh(1024.0 * SMALL_RELIEF.vertices, SMALL_RELIEF.triangles), None, RepairOptions())
    # Weights go by logarithms, which round.
    expected = 1024.0 * smooth_small_relief.filled.mesh.vertices
    np.testing.assert_allclose(doubled.filled.mesh.vertices, expected, rtol=1e-9)


@pytest.mark.parametrize("inpainter", [None, SelfDictionary()])
def test_a_flat_plate_with_holes_stays_flat(inpainter: Inpainter | None) -> None:
    plate = bumpy_plate(60, 2.0)
    flat = TriangleMesh(plate.vertices * [1, 1, 0], plate.triangles)
    repair = inpaint(punched(flat, (0.3, 0.2, 0), (-0.5, -0.4, 0), radius=0.15), inpainter, RepairOptions())
    assert len(new_vertices(repair)) > 0
    assert np.abs(new_vertices(repair)[:, 2]).max() < 1e-12
    assert [result.verdict for result in repair.results] == ["skipped", "filled_smooth", "filled_smooth"]
    assert min(result.confidence or 0 for result in repair.results[1:]) > 0.999


def test_holes_in_a_sphere_come_back_round() -> None:
    repair = inpaint(punched(sphere(5), (0, 0, 1), (1, 0, 0), radius=0.3), None, RepairOptions())
    assert np.abs(np.linalg.norm(new_vertices(repair), axis=1) - 1).mean() < 5e-4
    assert [result.verdict for result in repair.results] == ["filled_smooth"] * 2


def test_only_chosen_holes_are_filled_and_every_hole_has_a_result() -> None:
    options = RepairOptions(HoleOptions(ids=(2, 4)))
    repair = inpaint(SMALL_RELIEF, None, options)
    assert {hole.id for hole in repair.chosen} == {2, 4}
    assert [result.hole.id for result in repair.results] == list(range(10))
    verdicts = {result.hole.id: result.verdict for result in repair.results}
    assert {number for number, verdict in verdicts.items() if verdict == "filled_smooth"} == {2, 4}
    new = sum(result.n_new_vertices for result in repair.results)
    assert new == len(new_vertices(repair)) > 0
    triangles = sum(result.n_new_triangles for result in repair.results)
    assert triangles == len(repair.filled.mesh.triangles) - len(SMALL_RELIEF.triangles)


def test_an_unknown_hole_is_refused() -> None:
    with pytest.raises(OptionError, match="id 99"):
        inpaint(SMALL_RELIEF, None, RepairOptions(HoleOptions(ids=(99,))))


@pytest.mark.parametrize("inpainter", [None, SelfDictionary()])
def test_a_mesh_without_holes_is_given_back(inpainter: Inpainter | None) -> None:
    mesh = sphere(2)
    repair = inpaint(mesh, inpainter, RepairOptions())
    assert repair.results == []
    assert repair.filled.mesh.vertices.tobytes() == mesh.vertices.tobytes()
    assert repair.filled.mesh.triangles.tobytes() == mesh.triangles.tobytes()


def test_too_little_surface_to_learn_from_falls_back_to_geometry_and_says_so() -> None:
    mesh = punched(sphere(2), (0, 0, 1), radius=0.5)
    repair = inpaint(mesh, SelfDictionary(), RepairOptions(HoleOptions(max_diameter=10.0)))
    geometry = inpaint(mesh, None, RepairOptions(HoleOptions(max_diameter=10.0)))
    assert [result.verdict for result in repair.results] == ["filled_smooth"]
    assert new_vertices(repair).tobytes() == new_vertices(geometry).tobytes()
    result = repair.results[0]
    assert repair.warnings or result.code == "no_practice"
    assert "on calibration holes" not in result.reason


@pytest.mark.parametrize("length", [0.2, 3.0, 10.0])
@pytest.mark.parametrize("inpainter", [SelfDictionary(), DictionaryInpainter(Dictionary(np.eye(256)[:, :20], 16, 4))])
def test_patches_of_any_length_give_a_repair_also_where_none_shows_the_hole(
    length: float, inpainter: Inpainter
) -> None:
    mesh = punched(sphere(4), (0, 0, 1), radius=0.4)
    options = RepairOptions(HoleOptions(max_diameter=10.0), PatchOptions(length=length))
    repair = inpaint(mesh, inpainter, options)
    assert [result.verdict for result in repair.results] == ["filled_smooth"]
    assert np.isfinite(new_vertices(repair)).all()


def test_a_hole_without_new_vertices_is_not_called_folded() -> None:
    # One triangle is missing, far from all other holes.
    drop = int(np.argmin(np.linalg.norm(SMALL_RELIEF.vertices[SMALL_RELIEF.triangles[:, 0]] - [0.1, 0.8, 0], axis=1)))
    mesh = TriangleMesh(SMALL_RELIEF.vertices, np.delete(SMALL_RELIEF.triangles, drop, axis=0))
    repair = inpaint(mesh, SelfDictionary(), RepairOptions())
    tiny = repair.results[-1]
    assert tiny.hole.n_edges == 3
    assert (tiny.verdict, tiny.n_new_vertices, tiny.n_new_triangles) == ("filled_smooth", 0, 1)
    assert repair.completion is not None
    assert tiny.code == "no_new_vertex"


def test_confidence_falls_with_the_roughness_around_a_hole() -> None:
    smooth = bumpy_plate(60, 2.0)
    noise = np.random.default_rng(0).normal(0, 0.02, (3600, 3)) * [0, 0, 1]
    rough = TriangleMesh(smooth.vertices + noise, smooth.triangles)
    both = [judgements(inpaint(punched(one, *PLACES, radius=0.15), None, RepairOptions())) for one in (smooth, rough)]
    assert [len(judged) for judged in both] == [len(PLACES)] * 2
    for (_, calm), (_, noisy) in zip(*both, strict=True):
        assert noisy < calm


def test_two_sheets_close_together_are_repaired_apart() -> None:
    top = punched(bumpy_plate(60, 2.0), *PLACES, radius=0.15)
    under = TriangleMesh(top.vertices - [0, 0, 0.01], top.triangles[:, ::-1])
    repair = inpaint(joined(top, under), SelfDictionary(), RepairOptions())
    alone = inpaint(top, None, RepairOptions())
    verdicts = [result.verdict for result in repair.results]
    assert verdicts.count("skipped") == 2
    assert verdicts.count("filled_smooth") + verdicts.count("filled") == 18
    height = new_vertices(repair)[:, 2]
    assert height.max() < new_vertices(alone)[:, 2].max() + 0.02
    assert height.min() > new_vertices(alone)[:, 2].min() - 0.03


def test_an_empty_place_for_calibration_is_no_fault() -> None:
    repair = inpaint(punched(open_grid(9), (0, 0, 0), radius=1.2), None, RepairOptions(HoleOptions(ids=(1,))))
    assert repair.results[1].verdict == "filled_smooth"
