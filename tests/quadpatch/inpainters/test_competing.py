from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from quadpatch.errors import OptionError
from quadpatch.inpainters.competing import CompetingInpainters, FittedCompetitors
from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.mesh.distance import distance_to_mesh
from quadpatch.model_choice import AUTO, BASE_NETWORK, SELF, choose_model
from quadpatch.options import RepairOptions
from quadpatch.progress import no_progress
from quadpatch.recipes.default import inpaint
from quadpatch.types import FloatArray, Patches
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched, relief


@dataclass(frozen=True)
class Constant:
    """Predicts one height everywhere."""

    height: float
    resolution: int | None = 4

    def fitted_to(self, undamaged: Any) -> "Constant | None":
        return self if self.height >= 0 else None

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        return np.full(base_heights.shape, self.height)


NOTHING: Any = None
HEIGHTS = np.zeros((2, 4, 4))


def test_models_that_are_not_named_are_left_out() -> None:
    rivals = CompetingInpainters({"low": Constant(1.0), "high": Constant(2.0, 8)})  # type: ignore[dict-item]
    assert rivals.limited_to(["high", "other"]).resolution == 8


def fitted(**members: float) -> FittedCompetitors | None:
    models = {name: Constant(height) for name, height in members.items()}
    return CompetingInpainters(models).fitted_to(NOTHING)  # type: ignore[arg-type]


def test_each_model_competes_by_itself_and_all_by_their_mean() -> None:
    both = fitted(low=1.0, high=3.0)
    assert both is not None
    assert [dict(mixture.shares) for mixture in both.mixtures()] == [{"low": 1}, {"high": 1}, {"low": 0.5, "high": 0.5}]
    predicted = [float(mixture.predict(NOTHING, HEIGHTS).mean()) for mixture in both.mixtures()]
    assert predicted == [1.0, 3.0, 2.0]


def test_of_three_models_every_two_compete_by_their_mean_too() -> None:
    three = fitted(a=1.0, b=2.0, c=6.0)
    assert three is not None
    assert ["".join(mixture.shares) for mixture in three.mixtures()] == ["a", "b", "c", "ab", "ac", "bc", "abc"]
    assert all(sum(mixture.shares.values()) == pytest.approx(1.0) for mixture in three.mixtures())
    assert [float(m.predict(NOTHING, HEIGHTS).mean()) for m in three.mixtures()[3:]] == [1.5, 3.5, 4.0, 3.0]


def test_one_model_competes_with_nothing() -> None:
    one = fitted(only=1.0)
    assert one is not None
    assert [dict(mixture.shares) for mixture in one.mixtures()] == [{"only": 1.0}]


def test_a_model_for_which_the_mesh_shows_too_little_is_left_out() -> None:
    remaining = fitted(unable=-1.0, able=2.0)
    assert remaining is not None
    assert list(remaining.members) == ["able"]
    assert fitted(unable=-1.0) is None


def test_patches_have_the_resolution_of_the_model_that_has_one() -> None:
    free, bound = Constant(1.0, None), Constant(1.0, 32)
    assert CompetingInpainters({"free": free, "bound": bound}).resolution == 32  # type: ignore[dict-item]
    assert CompetingInpainters({"free": free}).resolution is None  # type: ignore[dict-item]


def test_auto_lets_a_dictionary_of_the_mesh_and_the_shipped_network_compete() -> None:
    inpainter, facts = choose_model(AUTO, RepairOptions(), no_progress, None)
    assert isinstance(inpainter, CompetingInpainters)
    assert (list(inpainter.members), inpainter.resolution) == ([SELF, BASE_NETWORK], 32)
    assert facts == {"name": AUTO, "effort": "standard"}
    with pytest.raises(OptionError, match="one learned model"):
        choose_model(AUTO, RepairOptions(recipe="paper"), no_progress, None)


@dataclass(frozen=True)
class Zero:
    """Says that the surface is the smoothed one, wherever it is asked."""

    resolution: int | None = None

    def fitted_to(self, undamaged: UndamagedSurface) -> "Zero":
        return replace(self, resolution=undamaged.patches.resolution)

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        return base_heights


@pytest.mark.slow
def test_the_model_that_leaves_the_smallest_error_on_calibration_holes_is_taken_and_named() -> None:
    whole = relief(160, 2.0, 0.02, 14)
    scan = punched(whole, *[(x, y, 0.0) for x in (-0.5, 0.1, 0.55) for y in (-0.45, 0.05, 0.5)], radius=0.09)
    dictionary, _ = choose_model(SELF, RepairOptions(), no_progress, None)
    assert dictionary is not None
    repair = inpaint(scan, CompetingInpainters({"zero": Zero(), "self": dictionary}), RepairOptions())  # type: ignore[dict-item]
    assert repair.completion is not None
    assert repair.completion.shares == {"self": 1.0}
    smooth = inpaint(scan, None, RepairOptions())
    errors = [
        distance_to_mesh(one.filled.mesh.vertices[one.filled.n_measured_vertices :], whole).mean()
        for one in (repair, smooth)
    ]
    assert errors[0] < 0.7 * errors[1]


def test_where_no_model_helps_none_is_named() -> None:
    plate = bumpy_plate(80, 2.0)
    scan = punched(plate, *on_surface(plate, (0.3, 0.2), (-0.5, -0.4)), radius=0.15)
    repair = inpaint(scan, CompetingInpainters({"zero": Zero()}), RepairOptions())  # type: ignore[dict-item]
    assert repair.completion is not None
    assert (repair.completion.blend_factor, repair.completion.shares) == (0.0, {})
