from dataclasses import replace
from typing import Self

import numpy as np
import pytest

from quadpatch.filling.meshlab_closing import close_by_meshlab
from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.inpainters.paper_dictionary import LOCAL_ATOMS, HeightsInpainter, SelfHeights, learn_heights
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.smoothing import laplacian_smooth, neighbour_average
from quadpatch.options import DictionaryOptions, HoleOptions, PatchOptions, RepairOptions
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.paper_layout import cut_patches, learnable, smooth_for_quads
from quadpatch.patches.scale import PatchScale
from quadpatch.patches.seeds import Seeds
from quadpatch.recipes.paper import NO_FAIRING, OVERLAP, RESOLUTION, inpaint_as_paper, paper_scale
from quadpatch.recipes.result import Repair
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.stages import Stages
from quadpatch.types import FloatArray, Patches, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid, punched, relief, sphere

PLACES = [(x, y, 0.0) for x in (-0.5, 0.1, 0.55) for y in (-0.45, 0.05, 0.5)]
WHOLE = relief(70, 2.0, 0.03, 8)
RELIEF = punched(WHOLE, *PLACES, radius=0.1)
OPTIONS = RepairOptions(patches=PatchOptions(0.3, 16), recipe="paper", dictionary=DictionaryOptions(60, 20))


SELF = SelfHeights(OPTIONS.dictionary)


class Truth:
    """A model that knows the whole surface: what it predicts are true heights."""

    def __init__(self, whole: TriangleMesh, resolution: int) -> None:
        self.whole = whole
        self.resolution = resolution

    def fitted_to(self, undamaged: UndamagedSurface) -> Self:
        return self

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        seeds = Seeds(patches.origins, patches.frames, np.zeros(len(patches), np.int64))
        nothing = np.zeros(len(self.whole.triangles), bool)
        scene = RayScene(self.whole)
        true = sample_height_maps(scene, self.whole, nothing, seeds, patches.length, self.resolution)
        return np.where(true.seen, true.heights, patches.heights)


def cut(mesh: TriangleMesh, scale: PatchScale) -> Patches:
    # Smoothed as a repair smooths: the level of raw heights is that over the smoothed surface.
    smoothed = smooth_for_quads(mesh) if mesh is WHOLE else laplacian_smooth(mesh, 30)
    return learnable(cut_patches(mesh, smoothed, scale, np.random.default_rng(0)))


def learned(scale: PatchScale, options: DictionaryOptions, *meshes: TriangleMesh) -> HeightsInpainter:
    """Learn one dictionary from the patches of whole meshes: the paper's local (one) and global (many) ones."""
    parts = [cut(mesh, scale) for mesh in meshes]
    heights, known = np.concatenate([part.heights for part in parts]), np.concatenate([part.known for part in parts])
    inpainter = learn_heights(heights, known, options, np.random.default_rng(0))
    assert inpainter is not None
    return inpainter


@pytest.fixture(scope="module")
def repaired() -> Repair:
    return inpaint_as_paper(RELIEF, SELF, OPTIONS)


def new_vertices(repair: Repair) -> FloatArray:
    return repair.filled.mesh.vertices[repair.filled.n_measured_vertices :]


def closed(repair: Repair, mesh: TriangleMesh) -> FloatArray:
    """New vertices where the closing puts them."""
    filled = close_by_meshlab(mesh, [hole.loop for hole in repair.chosen])
    return filled.mesh.vertices[filled.n_measured_vertices :]


def mean_error(points: FloatArray, whole: TriangleMesh) -> float:
    return float(distance_to_mesh(points, whole).mean())


def verdicts(repair: Repair) -> list[tuple[str, str]]:
    return [(result.verdict, result.code) for result in repair.results]


def test_what_a_relief_teaches_beats_the_closing(repaired: Repair) -> None:
    assert mean_error(new_vertices(repaired), WHOLE) < 0.5 * mean_error(closed(repaired, RELIEF), WHOLE)
    assert verdicts(repaired) == [("skipped", "border")] + 9 * [("filled", "")]


def test_measured_vertices_and_triangles_are_a_bit_exact_prefix(repaired: Repair) -> None:
    mesh, filled = repaired.filled.mesh, repaired.filled
    assert mesh.vertices[: filled.n_measured_vertices].tobytes() == RELIEF.vertices.tobytes()
    assert mesh.triangles[: filled.n_measured_triangles].tobytes() == RELIEF.triangles.tobytes()
    assert len(new_vertices(repaired)) > 100


def test_true_heights_put_every_vertex_on_the_true_surface() -> None:
    """Reconstruction is exact but for the bilinear reading of bins and the mean over patches of different tilt."""
    whole = sphere(4)
    mesh = punched(whole, (0, 0, 1), (1, 0, 0), (0, -1, 0), radius=0.2)
    repair = inpaint_as_paper(mesh, Truth(whole, 24), RepairOptions())
    assert repair.completion is not None
    agreement = repair.completion.agreement
    assert agreement is not None
    assert (agreement.coverage == 1).all()
    error, before = (np.abs(np.linalg.norm(v, axis=1) - 1) for v in (new_vertices(repair), closed(repair, mesh)))
    assert error.mean() < before.mean() / 10
    assert np.quantile(error, 0.98) < before.max() / 3
    assert agreement.rim_misfit.max() < 0.3 * agreement.departure.min()


def test_nothing_is_faired_gated_or_joined() -> None:
    """A dictionary of one constant atom codes a patch as a plane at the mean height of its known bins."""
    atoms = np.full((256, 1), 1 / 16)
    mesh = punched(sphere(4), (0, 0, 1), radius=0.3)
    repair = inpaint_as_paper(mesh, HeightsInpainter(Dictionary(atoms, 16, 1)), RepairOptions())
    assert repair.blend is NO_FAIRING
    assert repair.completion is not None
    assert repair.completion.blend_factor == 1.0
    assert verdicts(repair) == [("filled", "")]
    # Planes don't meet the rim of a hole in a sphere.
    assert repair.completion.agreement is not None
    assert repair.completion.agreement.rim_misfit[0] > 0.01


def test_neither_confidence_nor_expected_error_is_made_up(repaired: Repair) -> None:
    for result in repaired.results:
        assert (result.confidence, result.expected_error) == (None, None)
    measures = {"coverage", "spread", "departure", "rim_misfit", "folds", "crossings"}
    assert repaired.results[1].measures.keys() == measures
    assert repaired.results[1].n_new_vertices > 0
    assert repaired.results[1].n_new_triangles > 0


def test_faults_are_named_and_handed_out_all_the_same() -> None:
    # A blade stands in the hole: the paper's closing runs through it, and so do the vertices that it places.
    whole = sphere(4)
    blade = np.array([[-0.1, 0.02, 0.8], [0.1, 0.03, 0.8], [0.01, 0.025, 1.3]])
    n = len(whole.vertices)
    mesh = punched(TriangleMesh(np.concatenate([whole.vertices, blade]), whole.triangles), (0, 0, 1), radius=0.3)
    with_blade = TriangleMesh(mesh.vertices, np.concatenate([mesh.triangles, [[n, n + 1, n + 2]]]))
    ids = RepairOptions(HoleOptions(max_diameter=0.8), recipe="paper")
    for repair in (
        inpaint_as_paper(with_blade, Truth(whole, 8), ids),
        inpaint_as_paper(mesh, Truth(whole, 8), ids, obstacles=np.array([[n, n + 1, n + 2]])),
    ):
        result = next(result for result in repair.results if result.hole.n_edges > 3)
        assert result.verdict.startswith("filled")
        assert result.measures["crossings"] > 0
        assert result.n_new_triangles > 0


def test_every_stage_is_gone_through_in_the_order_of_the_paper() -> None:
    stages = Stages()
    inpaint_as_paper(punched(bumpy_plate(50, 2.0), (0, 0, 0), radius=0.2), SELF, OPTIONS, stages)
    assert list(stages.seconds) == [
        *("holes", "fill", "smooth", "quadrangulate", "patchify", "learn", "inpaint", "reconstruct", "judge")
    ]


def test_the_same_mesh_and_options_give_the_same_bytes(repaired: Repair) -> None:
    again = inpaint_as_paper(RELIEF, SELF, OPTIONS)
    assert again.filled.mesh.vertices.tobytes() == repaired.filled.mesh.vertices.tobytes()
    assert again.filled.mesh.triangles.tobytes() == repaired.filled.mesh.triangles.tobytes()


def test_a_dictionary_of_the_undamaged_mesh_does_no_worse_than_one_of_the_punched_one(repaired: Repair) -> None:
    assert repaired.completion is not None
    local = learned(repaired.completion.scale, OPTIONS.dictionary, WHOLE)
    stages = Stages()
    repair = inpaint_as_paper(RELIEF, local, OPTIONS, stages)
    assert mean_error(new_vertices(repair), WHOLE) < 1.1 * mean_error(new_vertices(repaired), WHOLE)
    assert "learn" not in stages.seconds


def test_dictionaries_have_as_many_atoms_as_asked_for_or_as_there_are_patches() -> None:
    scale = PatchScale(0.4, 8, 2)
    n_patches = len(cut(relief(60), scale))
    assert learned(scale, DictionaryOptions(), relief(60)).dictionary.n_atoms == min(LOCAL_ATOMS, n_patches)
    many = relief(60), bumpy_plate(60, 2.0), relief(60, waves=4)
    assert learned(scale, DictionaryOptions(LOCAL_ATOMS + 20), *many).dictionary.n_atoms == LOCAL_ATOMS + 20
    three = learned(scale, DictionaryOptions(3, 2), relief(60))
    assert (three.dictionary.n_atoms, three.dictionary.n_nonzero, three.resolution) == (3, 2, 8)
    again = learned(scale, DictionaryOptions(3, 2), relief(60))
    assert again.dictionary.atoms.tobytes() == three.dictionary.atoms.tobytes()


def test_a_mesh_too_small_to_learn_from_is_closed_with_a_warning() -> None:
    mesh = punched(bumpy_plate(20, 2.0), (0, 0, 0), radius=0.22)
    repair = inpaint_as_paper(mesh, SELF, replace(OPTIONS, patches=PatchOptions(length=1.0, overlap=0)))
    assert repair.completion is None
    (warning,) = repair.warnings
    assert "the holes were closed, nothing more" in warning
    assert (new_vertices(repair) == closed(repair, mesh)).all()
    assert verdicts(repair)[1] == ("filled_smooth", "geometry")


def test_new_vertices_that_no_patch_sees_lie_at_the_mean_of_their_ring() -> None:
    """Patches so narrow that many lie inside the hole: without a known bin they have nothing to go by."""
    mesh = punched(bumpy_plate(50, 2.0), (-0.5, -0.5, 0), (0.5, 0.4, 0), radius=0.25)
    options = RepairOptions(patches=PatchOptions(length=0.1, overlap=0))
    repair = inpaint_as_paper(mesh, Truth(bumpy_plate(50, 2.0), 8), options)
    assert repair.completion is not None
    agreement = repair.completion.agreement
    assert agreement is not None
    assert ((agreement.coverage > 0) & (agreement.coverage < 0.8)).all()
    filled = repair.filled
    average = neighbour_average(filled.mesh.triangles, len(filled.mesh.vertices))
    from_ring = np.linalg.norm(average @ filled.mesh.vertices - filled.mesh.vertices, axis=1)
    assert (from_ring[filled.n_measured_vertices :] < 1e-9).mean() > 0.1


def test_a_mesh_without_holes_comes_back() -> None:
    repair = inpaint_as_paper(sphere(3), SELF, OPTIONS)
    assert (repair.results, repair.completion, repair.warnings) == ([], None, [])
    assert repair.filled.mesh.vertices.tobytes() == sphere(3).vertices.tobytes()


def test_a_hole_without_new_vertices_is_named_as_such() -> None:
    mesh = TriangleMesh(open_grid(9, 2.0).vertices, np.delete(open_grid(9, 2.0).triangles, 60, axis=0))
    repair = inpaint_as_paper(mesh, Truth(open_grid(9, 2.0), 8), RepairOptions())
    assert verdicts(repair) == [("skipped", "border"), ("filled_smooth", "no_new_vertex")]


def test_holes_that_were_not_chosen_stay_open() -> None:
    mesh = punched(sphere(4), (0, 0, 1), (0, 0, -1), radius=0.4)
    repair = inpaint_as_paper(mesh, Truth(sphere(4), 8), RepairOptions(HoleOptions(ids=(1,))))
    assert verdicts(repair) == [("skipped", "not_chosen"), ("filled", "")]


def test_what_is_asked_for_beats_the_rule_of_thumb_and_the_model_beats_both() -> None:
    chosen = PatchOptions(length=0.3, resolution=20, overlap=0)
    assert paper_scale([0.1, 0.2], 0.001, chosen) == PatchScale(0.3, 20, 0)
    assert paper_scale([0.1, 0.2], 0.001, chosen, 12).resolution == 12
    automatic = paper_scale([0.1, 0.2], 0.001, PatchOptions())
    assert (automatic.resolution, automatic.overlap) == (RESOLUTION, OVERLAP)
    assert 0.1 < automatic.length < 0.4
    # Bins far below the mesh's edges would show its triangles.
    assert paper_scale([0.1], 1.0, PatchOptions()).length >= 0.5 * RESOLUTION


def test_the_finest_networks_see_as_much_surface_as_the_others() -> None:
    coarse, fine = (paper_scale([0.1], 1.0, PatchOptions(), n) for n in (RESOLUTION, 100))
    assert fine == PatchScale(coarse.length, 100, coarse.overlap)
    assert paper_scale([0.1], 1.0, PatchOptions(resolution=48)).length == 2 * coarse.length


def test_presets_are_the_papers_two_kinds_of_patches_in_units_of_the_longest_side() -> None:
    mesh = punched(sphere(4, 5.0), (0, 0, 5.0), radius=0.8)
    repair = inpaint_as_paper(mesh, Truth(sphere(4, 5.0), 24), RepairOptions(patches=PatchOptions(preset="type2")))
    assert repair.completion is not None
    assert repair.completion.scale.length == pytest.approx(0.6)
    assert repair.completion.scale.resolution == 24
