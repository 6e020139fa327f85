import numpy as np
import pytest

from quadpatch.denoising.risk import least_risk_weights
from quadpatch.types import FloatArray

N = 4000
EDGES = np.stack([np.arange(N - 1), np.arange(1, N)], axis=1)


def shrunk(signal: float, factors: list[float], noise: float = 0.5) -> FloatArray:
    """Weights of filters that multiply what was measured of a signal by some factors."""
    rng = np.random.default_rng(0)
    measured = rng.normal(scale=signal, size=N) + rng.normal(scale=noise, size=N)
    probe = rng.choice([-1.0, 1.0], N)
    shifts = np.stack([(factor - 1) * measured for factor in factors], axis=1)
    responses = np.stack([(factor - 1) * probe for factor in factors], axis=1)
    return least_risk_weights(shifts, responses, probe, EDGES, noise)


@pytest.mark.parametrize("signal", [0.0, 0.5, 1.0, 3.0])
def test_the_weight_of_a_flat_answer_is_that_of_the_wiener_filter(signal: float) -> None:
    noise_share = 0.25 / (signal**2 + 0.25)
    # The noise counts as a tenth stronger than it is.
    assert shrunk(signal, [0.0])[0] == pytest.approx(min(1.0, 1.21 * noise_share), abs=0.05)


def test_the_better_of_two_filters_gets_the_weight() -> None:
    assert shrunk(0.1, [0.0, 0.9])[0] > 0.8
    assert shrunk(3.0, [0.0, 0.9])[0] < 0.05


def test_weights_are_shares() -> None:
    weights = shrunk(0.5, [0.0, 0.3, 0.3, 1.5])
    assert (weights >= 0).all()
    assert weights.sum() <= 1 + 1e-5


def test_filters_that_do_nothing_get_nothing() -> None:
    assert least_risk_weights(np.zeros((N, 2)), np.zeros((N, 2)), np.ones(N), EDGES, 1.0).tolist() == [0.0, 0.0]
