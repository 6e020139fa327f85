from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from quadpatch.calibration.calibration_set import MAX_HOLES, cut_calibration_set
from quadpatch.calibration.kept import KeptCalibrations
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.inpainters.competing import CompetingInpainters, FittedCompetitors
from quadpatch.inpainters.dictionary import SelfDictionary
from quadpatch.inpainters.inpainter import Fitting
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.options import RepairOptions
from quadpatch.patches.layout import lay_out
from quadpatch.patches.scale import PatchScale
from quadpatch.processes import ProcessPool, Shared
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.model_trials import FIRST_HOLES, CalibrationPatches, try_models
from quadpatch.recipes.patch_surfaces import PatchSurfaces
from quadpatch.recipes.result import Repair
from quadpatch.stages import Stages
from quadpatch.types import FloatArray, Patches
from tests.quadpatch.shapes import punched, relief

RELIEF = relief(120, 2.0, 0.03, 10)
RESOLUTION = 16


@dataclass(frozen=True)
class Shifted:
    """Says that the surface rises over the fill, by so many patch lengths in the middle of every patch."""

    share: float
    resolution: int = RESOLUTION

    def fitted_to(self, undamaged: Any) -> "Shifted":
        return self

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        hill = np.hanning(self.resolution)
        return patches.heights + self.share * patches.length * np.where(patches.known, 0.0, np.outer(hill, hill))


ONE_STEP = Fitting(1, 1, "steps")


@dataclass(frozen=True)
class FittedAsNetworksAre:
    """Another model, which says that it was fitted in one step."""

    model: Any
    fitting: Fitting = ONE_STEP

    @property
    def resolution(self) -> Any:
        return self.model.resolution

    def fitted_to(self, undamaged: Any) -> "FittedAsNetworksAre":
        return replace(self, model=self.model.fitted_to(undamaged))

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        predicted: FloatArray = self.model.predict(patches, base_heights)
        return predicted


class CountingPool(ProcessPool):
    """Counts the patches that were asked for."""

    def __init__(self) -> None:
        super().__init__()
        self.counts: list[int] = []

    def begin(self, function: Any, items: Any) -> "Shared[Any, Any]":
        todo = list(items)
        self.counts += [len(seeds.origins) for _, seeds, _ in todo]
        return super().begin(function, todo)


def patches_of(pool: ProcessPool) -> CalibrationPatches:
    edge = mean_edge_length(RELIEF)
    holes = cut_calibration_set(RELIEF, 0.2, edge, np.random.default_rng(0))
    assert holes is not None
    filled = fair_holes(close_holes(holes.opened, holes.loops), THIN_PLATE)
    surface = PatchSurfaces.of_scan(filled, None, filled, edge).calibration
    assert surface is not None
    scale = PatchScale(0.36, RESOLUTION, 2)
    return CalibrationPatches(holes, filled, surface, lay_out(surface.smoothed(scale), scale), scale, pool)


def competitors(**shares: float) -> FittedCompetitors:
    models = {name: Shifted(share) for name, share in shares.items()}
    return FittedCompetitors(models, dict.fromkeys(models, 1.0 / len(models)))


def test_a_model_that_loses_on_the_first_holes_is_dropped_and_the_other_patches_are_never_cut() -> None:
    pool = CountingPool()
    calibration = patches_of(pool)
    choice = try_models(calibration, competitors(up=0.5, down=-0.5))
    assert (choice.blend_factor, choice.error_model is None) == (0.0, False)
    geometry, *others = choice.trials
    assert (geometry.shares, geometry.n_holes) == ({}, calibration.n_holes)
    assert [(trial.shares, trial.blend_factor, trial.n_holes) for trial in others] == [
        ({"up": 1.0}, 0.0, FIRST_HOLES),
        ({"down": 1.0}, 0.0, FIRST_HOLES),
    ]
    assert {trial.error for trial in others} == {geometry.error}
    assert len(pool.counts) == 1
    assert len(calibration.every.patches) > len(calibration.first.patches)
    assert len(pool.counts) == 2


def test_models_that_were_looked_at_before_are_tried_on_all_holes_at_once() -> None:
    calibration = patches_of(ProcessPool())
    rivals = competitors(up=0.5, down=-0.5)
    choice = try_models(calibration, rivals, is_screened=True)
    assert [trial.n_holes for trial in choice.trials] == [calibration.n_holes] * 4
    assert choice.promising == ["up", "down"]
    dropped = try_models(calibration, rivals)
    again = try_models(calibration, competitors(up=0.5), is_screened=True).after(dropped)
    # Of those that had been dropped the number of holes says so; nothing was left to try but them here.
    assert [(*trial.shares, trial.n_holes) for trial in again.trials] == [
        (calibration.n_holes,),
        ("up", calibration.n_holes),
        ("up", FIRST_HOLES),
        ("down", FIRST_HOLES),
    ]


def test_the_first_holes_are_spread_over_all_lengths_of_rims() -> None:
    calibration = patches_of(ProcessPool())
    first = np.flatnonzero(calibration.is_first)
    assert len(first) == FIRST_HOLES < calibration.n_holes
    assert (first[0], first[-1]) == (0, calibration.n_holes - 1)
    assert np.ptp(np.diff(first)) <= 1


PLACES = [(x, y, 0.0) for x in (-0.5, 0.1, 0.55) for y in (-0.45, 0.05, 0.5)]
SCAN = punched(relief(160, 2.0, 0.02, 14), *PLACES, radius=0.09)
RIVALS = CompetingInpainters({"self": SelfDictionary(), "wrong": Shifted(0.5)})


@pytest.fixture(scope="module")
def alone() -> Repair:
    return inpaint(SCAN, RIVALS, RepairOptions())


def test_a_winner_is_not_tried_by_the_mean_with_one_that_was_dropped(alone: Repair) -> None:
    assert alone.completion is not None
    trials = {tuple(trial.shares): trial for trial in alone.completion.trials}
    assert list(trials) == [(), ("self",), ("wrong",)]
    assert trials["wrong",].n_holes == FIRST_HOLES < trials["self",].n_holes
    assert trials["self",].error < trials[()].error
    assert alone.completion.shares == {"self": 1.0}


def test_repairs_have_the_same_bits_with_any_number_of_processes(alone: Repair) -> None:
    with ProcessPool(3) as pool:
        together = inpaint(SCAN, RIVALS, RepairOptions(), Stages(pool=pool))
    assert together.filled.mesh.vertices.tobytes() == alone.filled.mesh.vertices.tobytes()
    assert together.completion is not None
    assert alone.completion is not None
    assert together.completion.trials == alone.completion.trials


# Waves between which the dictionary gains in some holes and loses in others, and room for more calibration holes.
UNSURE = punched(relief(160, 2.0, 0.02, 14), *PLACES[:4], radius=0.06)


@pytest.fixture(scope="module")
def unsure() -> Repair:
    return inpaint(UNSURE, RIVALS, RepairOptions())


def test_a_gain_that_may_be_chance_is_tried_on_more_holes_by_the_models_that_may_gain(unsure: Repair) -> None:
    assert unsure.completion is not None
    assert unsure.calibration is not None
    geometry, of_self, wrong = unsure.completion.trials
    assert geometry.n_holes == of_self.n_holes >= 1.5 * MAX_HOLES
    assert (wrong.shares, wrong.n_holes, wrong.error) == ({"wrong": 1.0}, FIRST_HOLES, geometry.error)
    # What calibration finds of energies rests on the first holes alone.
    assert unsure.calibration.n_holes == MAX_HOLES


def test_more_holes_leave_the_same_bits_with_any_number_of_processes_and_with_a_kept_calibration(
    unsure: Repair,
) -> None:
    kept = KeptCalibrations()
    with ProcessPool(3) as pool:
        together = inpaint(UNSURE, RIVALS, RepairOptions(), Stages(pool=pool), kept=kept)
    reused = inpaint(UNSURE, RIVALS, RepairOptions(), kept=kept)
    assert reused.is_calibration_reused
    for other in (together, reused):
        assert other.filled.mesh.vertices.tobytes() == unsure.filled.mesh.vertices.tobytes()
        assert other.completion is not None
        assert unsure.completion is not None
        assert other.completion.trials == unsure.completion.trials


def test_no_network_is_fitted_a_second_time_to_be_tried_on_more_holes() -> None:
    rivals = CompetingInpainters({"self": FittedAsNetworksAre(SelfDictionary()), "wrong": Shifted(0.5)})
    completion = inpaint(UNSURE, rivals, RepairOptions()).completion
    assert completion is not None
    assert [trial.n_holes for trial in completion.trials] == [MAX_HOLES, MAX_HOLES, FIRST_HOLES]


def test_how_a_network_was_fitted_that_is_dropped_is_told_after_more_holes() -> None:
    rivals = CompetingInpainters({"self": SelfDictionary(), "wrong": FittedAsNetworksAre(Shifted(0.5))})
    completion = inpaint(UNSURE, rivals, RepairOptions()).completion
    assert completion is not None
    assert completion.trials[0].n_holes >= 1.5 * MAX_HOLES
    assert completion.fitting == ONE_STEP
