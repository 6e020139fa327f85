from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.calibration.error_model import UNTRIED, USUAL_SLOPE, Expectation, learn_expectation
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
    gap = diameters * np.exp(rng.uniform(-8, -3, N_HOLES))
    return replace(nothing, gap=gap, rim_turn=np.exp(rng.uniform(-3, -1, N_HOLES))), diameters


@given(SEEDS, st.floats(0.0, 1.0), st.floats(1e-3, 10.0))
def test_a_power_law_is_found_again(seed: int, slope: float, factor: float) -> None:
    filled, diameters = some_holes(seed)
    errors = Expectation(factor, slope).errors(filled, diameters)
    learned = learn_expectation(filled, diameters, errors)
    # The usual slope pulls a little.
    assert learned.slope == pytest.approx(slope, abs=0.1)
    np.testing.assert_allclose(learned.errors(filled, diameters), errors, rtol=0.4)


@given(SEEDS, SEEDS)
def test_the_mean_expected_error_is_that_of_practice_and_the_slope_stays_between_nothing_and_proportion(
    seed: int, errors_seed: int
) -> None:
    filled, diameters = some_holes(seed)
    errors = diameters * np.exp(np.random.default_rng(errors_seed).normal(-4, 3, N_HOLES))
    learned = learn_expectation(filled, diameters, errors)
    assert 0 <= learned.slope <= 1
    assert learned.errors(filled, diameters).mean() == pytest.approx(errors.mean())


@given(SEEDS, st.floats(1e-6, 1e6))
def test_errors_scale_with_the_mesh(seed: int, scale: float) -> None:
    filled, diameters = some_holes(seed)
    errors = UNTRIED.errors(filled, diameters) * np.random.default_rng(seed).uniform(0.5, 2, N_HOLES)
    learned = learn_expectation(filled, diameters, errors)
    larger = replace(filled, gap=scale * filled.gap)
    again = learn_expectation(larger, scale * diameters, scale * errors)
    assert again.factor == pytest.approx(learned.factor)
    assert again.slope == pytest.approx(learned.slope)
    np.testing.assert_allclose(
        again.errors(larger, scale * diameters), scale * learned.errors(filled, diameters), rtol=1e-9
    )


@given(SEEDS, st.floats(1.0, 10.0), st.floats(1.0, 10.0))
def test_a_less_certain_hole_is_never_expected_to_be_better(seed: int, wider: float, rougher: float) -> None:
    filled, diameters = some_holes(seed)
    worse = replace(filled, gap=wider * filled.gap, rim_turn=rougher * filled.rim_turn)
    assert (UNTRIED.errors(worse, diameters) >= UNTRIED.errors(filled, diameters)).all()


def test_where_uncertainty_says_nothing_every_hole_is_expected_to_be_as_wrong_as_the_others() -> None:
    filled, diameters = some_holes(0)
    errors = 0.01 * diameters / np.sqrt(filled.gap / diameters * filled.rim_turn)
    learned = learn_expectation(filled, diameters, errors)
    assert learned.slope == 0
    assert np.ptp(learned.errors(filled, diameters) / diameters) < 1e-12


def test_practice_holes_that_are_all_alike_leave_the_usual_slope() -> None:
    filled, diameters = some_holes(0)
    alike = replace(filled, gap=1e-3 * diameters, rim_turn=np.full(N_HOLES, 0.1))
    errors = diameters * np.random.default_rng(1).uniform(0.001, 0.01, N_HOLES)
    assert learn_expectation(alike, diameters, errors).slope == pytest.approx(USUAL_SLOPE)


def test_holes_without_a_new_vertex_teach_nothing() -> None:
    filled, diameters = some_holes(0)
    errors = Expectation(0.1, 0.5).errors(filled, diameters)
    empty = np.arange(N_HOLES) % 4 == 0
    some = replace(filled, gap=np.where(empty, 0.0, filled.gap))
    without = replace(filled, gap=filled.gap[~empty], rim_turn=filled.rim_turn[~empty])
    expected = learn_expectation(without, diameters[~empty], errors[~empty]).slope
    assert learn_expectation(some, diameters, errors).slope == pytest.approx(expected)
    nothing = replace(filled, gap=np.zeros(N_HOLES))
    assert learn_expectation(nothing, diameters, errors).slope == USUAL_SLOPE


def test_flat_holes_without_error_expect_none() -> None:
    filled, diameters = some_holes(0)
    flat = replace(filled, gap=np.zeros(N_HOLES), rim_turn=np.zeros(N_HOLES))
    assert learn_expectation(flat, diameters, np.zeros(N_HOLES)).errors(flat, diameters).max() == 0
    assert UNTRIED.errors(flat, diameters).max() < 1e-7
