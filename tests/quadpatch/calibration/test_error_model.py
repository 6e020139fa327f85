from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.calibration.error_model import PRIOR, PRIOR_SLOPE, ErrorModel, fit_error_model
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.types import FloatArray
from tests.quadpatch.shapes import bumpy_plate

N_HOLES = 40
SEEDS = st.integers(0, 2**16)


def some_holes(seed: int) -> tuple[FilledMesh, FloatArray]:
    """Holes of many sizes, some sure and some not: a fill with nothing but their signs, and their diameters."""
    rng = np.random.default_rng(seed)
    diameters = rng.uniform(0.5, 2.0, N_HOLES)
    nothing = fair_holes(close_holes(bumpy_plate(5, 2.0), []), THIN_PLATE)
    disagreement = diameters * np.exp(rng.uniform(-8, -3, N_HOLES))
    return replace(nothing, disagreement=disagreement, rim_variation=np.exp(rng.uniform(-3, -1, N_HOLES))), diameters


@given(SEEDS, st.floats(0.0, 1.0), st.floats(1e-3, 10.0))
def test_a_power_law_is_found_again(seed: int, slope: float, factor: float) -> None:
    filled, diameters = some_holes(seed)
    errors = ErrorModel(factor, slope).errors(filled, diameters)
    learned = fit_error_model(filled, diameters, errors)
    # The usual slope pulls a little.
    assert learned.slope == pytest.approx(slope, abs=0.1)
    np.testing.assert_allclose(learned.errors(filled, diameters), errors, rtol=0.4)


@given(SEEDS, SEEDS)
def test_the_mean_expected_error_is_that_of_calibration_and_the_slope_stays_between_nothing_and_proportion(
    seed: int, errors_seed: int
) -> None:
    filled, diameters = some_holes(seed)
    errors = diameters * np.exp(np.random.default_rng(errors_seed).normal(-4, 3, N_HOLES))
    learned = fit_error_model(filled, diameters, errors)
    assert 0 <= learned.slope <= 1
    assert learned.errors(filled, diameters).mean() == pytest.approx(errors.mean())


@given(SEEDS, st.floats(1e-6, 1e6))
def test_errors_scale_with_the_mesh(seed: int, scale: float) -> None:
    filled, diameters = some_holes(seed)
    errors = PRIOR.errors(filled, diameters) * np.random.default_rng(seed).uniform(0.5, 2, N_HOLES)
    learned = fit_error_model(filled, diameters, errors)
    larger = replace(filled, disagreement=scale * filled.disagreement)
    again = fit_error_model(larger, scale * diameters, scale * errors)
    assert again.factor == pytest.approx(learned.factor)
    assert again.slope == pytest.approx(learned.slope)
    np.testing.assert_allclose(
        again.errors(larger, scale * diameters), scale * learned.errors(filled, diameters), rtol=1e-9
    )


@given(SEEDS, st.floats(1.0, 10.0), st.floats(1.0, 10.0))
def test_a_less_certain_hole_is_never_expected_to_be_better(seed: int, wider: float, rougher: float) -> None:
    filled, diameters = some_holes(seed)
    worse = replace(filled, disagreement=wider * filled.disagreement, rim_variation=rougher * filled.rim_variation)
    assert (PRIOR.errors(worse, diameters) >= PRIOR.errors(filled, diameters)).all()


def test_where_uncertainty_says_nothing_every_hole_is_expected_to_be_as_wrong_as_the_others() -> None:
    filled, diameters = some_holes(0)
    errors = 0.01 * diameters / np.sqrt(filled.disagreement / diameters * filled.rim_variation)
    learned = fit_error_model(filled, diameters, errors)
    assert learned.slope == 0
    assert np.ptp(learned.errors(filled, diameters) / diameters) < 1e-12


def test_calibration_holes_that_are_all_alike_leave_the_usual_slope() -> None:
    filled, diameters = some_holes(0)
    alike = replace(filled, disagreement=1e-3 * diameters, rim_variation=np.full(N_HOLES, 0.1))
    errors = diameters * np.random.default_rng(1).uniform(0.001, 0.01, N_HOLES)
    assert fit_error_model(alike, diameters, errors).slope == pytest.approx(PRIOR_SLOPE)


def test_holes_without_a_new_vertex_give_nothing_to_learn() -> None:
    filled, diameters = some_holes(0)
    errors = ErrorModel(0.1, 0.5).errors(filled, diameters)
    empty = np.arange(N_HOLES) % 4 == 0
    some = replace(filled, disagreement=np.where(empty, 0.0, filled.disagreement))
    without = replace(filled, disagreement=filled.disagreement[~empty], rim_variation=filled.rim_variation[~empty])
    expected = fit_error_model(without, diameters[~empty], errors[~empty]).slope
    assert fit_error_model(some, diameters, errors).slope == pytest.approx(expected)
    nothing = replace(filled, disagreement=np.zeros(N_HOLES))
    assert fit_error_model(nothing, diameters, errors).slope == PRIOR_SLOPE


def test_flat_holes_without_error_expect_none() -> None:
    filled, diameters = some_holes(0)
    flat = replace(filled, disagreement=np.zeros(N_HOLES), rim_variation=np.zeros(N_HOLES))
    assert fit_error_model(flat, diameters, np.zeros(N_HOLES)).errors(flat, diameters).max() == 0
    assert PRIOR.errors(flat, diameters).max() < 1e-7
