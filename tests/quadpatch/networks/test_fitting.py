from dataclasses import replace
from itertools import count

import numpy as np
import pytest
import torch

from quadpatch.calibration.training_pairs import TrainingPairs, TrainingSurface, make_training_pairs
from quadpatch.networks.fitting import CUTTING_SHARE, MAX_ROUNDS, FittingInpainter, collect_training_pairs, fit
from quadpatch.networks.precision import has_fast_bfloat16
from quadpatch.networks.residual import Errors, Residual, errors
from quadpatch.options import NetworkOptions
from quadpatch.patches.residual_input import RESOLUTION, corrected, network_input
from quadpatch.types import Patches
from tests.quadpatch.networks.made import stirred
from tests.quadpatch.shapes import relief
from tests.quadpatch.training_surfaces import ground_of, undamaged_surface

pytestmark = pytest.mark.slow

STEPS = 60
# More than any machine takes.
AMPLE_S = 1e6


@pytest.fixture(scope="module")
def training_surface() -> TrainingSurface:
    """A pattern that repeats often enough to be learned at some places and asked for at others."""
    return ground_of(relief(70, 2.0, 0.04, 8), 0.3)


@pytest.fixture(scope="module")
def pairs(training_surface: TrainingSurface) -> TrainingPairs:
    """One round."""
    return next(make_training_pairs(training_surface, np.random.default_rng(1)))


@pytest.fixture(scope="module")
def small_surface() -> TrainingSurface:
    """Room for a few holes a round."""
    return ground_of(relief(34, 0.9, 0.03, 3), 0.25, overlap=1)


def measured(network: Residual, pairs: TrainingPairs) -> Errors:
    channels, correction, loss_mask = map(torch.from_numpy, (pairs.channels, pairs.correction, pairs.loss_mask))
    with torch.inference_mode():
        return errors(network(channels), correction[:, None], loss_mask[:, None])


def weights(network: Residual) -> bytes:
    return b"".join(tensor.numpy().tobytes() for tensor in network.state_dict().values())


def fresh() -> Residual:
    torch.manual_seed(0)
    return Residual()


def test_a_network_learns_from_some_holes_to_fill_others_of_the_same_surface(
    training_surface: TrainingSurface, pairs: TrainingPairs
) -> None:
    network = fresh()
    assert fit(network, pairs, NetworkOptions(STEPS, AMPLE_S), seed=0) == STEPS
    unseen = next(make_training_pairs(training_surface, np.random.default_rng(99)))
    untrained, trained = measured(Residual(), unseen), measured(network, unseen)
    assert untrained.network == untrained.fill == trained.fill
    assert trained.network < 0.75 * trained.fill
    assert trained.loss < 0.8 * untrained.loss


def test_the_same_seed_gives_the_same_bits_and_another_one_others(pairs: TrainingPairs) -> None:
    found = []
    for seed in (3, 3, 4):
        found.append(fresh())
        fit(found[-1], pairs, NetworkOptions(steps=5, seconds=AMPLE_S), seed)
    assert weights(found[0]) == weights(found[1])
    assert weights(found[0]) != weights(found[2])


def test_a_short_time_ends_the_steps_early_and_the_rate_still_falls_to_its_end(pairs: TrainingPairs) -> None:
    shares: list[float] = []
    network = fresh()
    options = NetworkOptions(steps=100_000, seconds=20.0)
    steps = fit(network, pairs, options, 0, lambda _, share: shares.append(share), count(0.0).__next__)
    # The rate follows the share, on a cosine: the last steps are small.
    assert steps == 19
    assert shares == pytest.approx([second / 20 for second in range(1, 20)])
    assert measured(network, pairs).loss < measured(Residual(), pairs).loss


def test_without_time_nothing_is_done(pairs: TrainingPairs) -> None:
    network = fresh()
    before = weights(network)
    assert fit(network, pairs, NetworkOptions(steps=10, seconds=1e-9), 0, clock=count(0.0).__next__) == 0
    assert weights(network) == before


def test_matrix_products_are_in_bfloat16_only_where_the_processor_is_fast_at_them(
    pairs: TrainingPairs,
) -> None:
    network, seen = fresh(), set[torch.dtype]()
    network.last.register_forward_hook(lambda _module, _seen, answer: seen.add(answer.dtype))
    fit(network, pairs, NetworkOptions(steps=1, seconds=AMPLE_S), 0)
    assert seen == {torch.bfloat16 if has_fast_bfloat16() else torch.float32}


def test_the_outcome_is_the_same_on_a_busy_machine_as_long_as_the_time_is_not_ahead_of_the_steps(
    pairs: TrainingPairs,
) -> None:
    options, found = NetworkOptions(steps=5, seconds=50.0), []
    for seconds_a_step in (0.01, 7.0, 9.9, 10.1):
        found.append(fresh())
        assert fit(found[-1], pairs, options, 3, clock=count(0.0, seconds_a_step).__next__) >= 4
    slow, in_time = weights(found.pop()), {weights(network) for network in found}
    assert len(in_time) == 1
    assert slow not in in_time


def test_training_pairs_follow_from_the_seed_and_are_those_of_several_rounds(small_surface: TrainingSurface) -> None:
    undamaged = undamaged_surface(small_surface)
    one, same, other = (collect_training_pairs(undamaged, seed) for seed in (0, 0, 1))
    first = next(make_training_pairs(small_surface, np.random.default_rng([0, 3])))
    assert len(first) < len(one) <= MAX_ROUNDS * len(small_surface.seeds)
    assert one.channels[: len(first)].tobytes() == first.channels.tobytes()
    assert one.channels.tobytes() == same.channels.tobytes()
    assert one.channels.tobytes() != other.channels.tobytes()


def test_a_surface_with_too_few_training_pairs_leaves_the_network_as_it_is(small_surface: TrainingSurface) -> None:
    inpainter = FittingInpainter(fresh(), NetworkOptions(steps=2))
    too_wide = replace(small_surface, diameters=np.array([1.5]))
    assert inpainter.fitted_to(undamaged_surface(too_wide)) is inpainter


def test_fitting_makes_another_network_and_tells_how_far_it_is(small_surface: TrainingSurface) -> None:
    heard: list[tuple[str, float]] = []
    inpainter = FittingInpainter(fresh(), NetworkOptions(steps=4, seconds=AMPLE_S), 0, lambda *said: heard.append(said))
    before = weights(inpainter.network)
    fitted = inpainter.fitted_to(undamaged_surface(small_surface))
    assert weights(inpainter.network) == before != weights(fitted.network)
    assert {stage for stage, _ in heard} == {"learn"}
    shares = [share for _, share in heard]
    assert shares == sorted(shares)
    # Training pairs come first and take a fixed share; then every step is told.
    of_steps = CUTTING_SHARE + (1 - CUTTING_SHARE) * np.array([0.0, 0.25, 0.5, 0.75])
    assert shares[-4:] == pytest.approx(of_steps, abs=1e-6)
    assert 0 < shares[0] < CUTTING_SHARE
    assert (fitted.resolution, fitted.options) == (inpainter.resolution, inpainter.options)


def test_predictions_are_the_fill_with_what_the_network_answers() -> None:
    rng = np.random.default_rng(0)
    shape = (300, RESOLUTION, RESOLUTION)
    heights, base_heights, known = rng.normal(size=shape), 0.1 * rng.normal(size=shape), rng.random(shape) > 0.3
    frames = np.tile(np.eye(3), (300, 1, 1))
    patches = Patches(np.zeros((300, 3)), frames, 1.0, heights, known, np.ones_like(known), np.zeros(shape, np.int64))
    network = stirred(fresh())
    predicted = FittingInpainter(network, NetworkOptions()).predict(patches, base_heights)
    seen = network_input(patches, base_heights)
    with torch.inference_mode():
        answers = network(torch.from_numpy(seen.channels))[:, 0].numpy().astype(np.float64)
    np.testing.assert_allclose(predicted, corrected(patches, seen.deviation, answers), atol=1e-5)
    assert predicted[known].tobytes() == heights[known].tobytes()
    untouched = FittingInpainter(fresh(), NetworkOptions()).predict(patches, base_heights)
    np.testing.assert_array_equal(untouched, heights)
