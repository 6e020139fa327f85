from dataclasses import replace
from itertools import count

import numpy as np
import pytest
import torch

from quadpatch.calibration.training_pairs import TrainingPairs, TrainingSurface, make_training_pairs
from quadpatch.inpainters.inpainter import Fitting, UndamagedSurface
from quadpatch.networks.fitting import CHECK, ENOUGH_PAIRS, LEAST_GAIN, MIN_PAIRS, PATIENCE, FittingInpainter, fit
from quadpatch.networks.precision import has_fast_bfloat16
from quadpatch.networks.residual import Errors, Residual, errors
from quadpatch.options import NetworkOptions
from quadpatch.patches.residual_input import RESOLUTION, corrected, network_input
from quadpatch.types import BoolArray, FloatArray, Patches
from tests.quadpatch.networks.made import stirred
from tests.quadpatch.shapes import relief
from tests.quadpatch.training_surfaces import ground_of, undamaged_surface

pytestmark = pytest.mark.slow

STEPS = 60
# Enough to gain far more than a percent.
SHORT = NetworkOptions(steps=60)


@pytest.fixture(scope="module")
def training_surface() -> TrainingSurface:
    """A pattern that repeats often enough to be learned at some places and asked for at others."""
    return ground_of(relief(70, 2.0, 0.04, 8), 0.3)


@pytest.fixture(scope="module")
def pairs(training_surface: TrainingSurface) -> TrainingPairs:
    """One round."""
    return next(make_training_pairs(training_surface, np.random.default_rng(1)))


@pytest.fixture(scope="module")
def held_out(training_surface: TrainingSurface) -> TrainingPairs:
    """Another round, as calibration holes would be."""
    return next(make_training_pairs(training_surface, np.random.default_rng(2)))


def measured(network: Residual, pairs: TrainingPairs) -> Errors:
    channels, correction, loss_mask = map(torch.from_numpy, (pairs.channels, pairs.correction, pairs.loss_mask))
    with torch.inference_mode():
        return errors(network(channels), correction[:, None], loss_mask[:, None])


def weights(network: Residual) -> bytes:
    return b"".join(tensor.numpy().tobytes() for tensor in network.state_dict().values())


def fresh() -> Residual:
    torch.manual_seed(0)
    return Residual()


def small() -> Residual:
    """Make a network that a step of takes little."""
    torch.manual_seed(0)
    return Residual((8, 8, 8))


@pytest.fixture(scope="module")
def undamaged(training_surface: TrainingSurface, held_out: TrainingPairs) -> UndamagedSurface:
    """What a repair hands to a model."""
    return replace(undamaged_surface(training_surface), held_out=lambda: held_out)


def test_a_network_learns_from_some_holes_to_fill_others_of_the_same_surface(
    training_surface: TrainingSurface, pairs: TrainingPairs, held_out: TrainingPairs
) -> None:
    network, fitting = fit(fresh(), iter([pairs]), held_out, NetworkOptions(STEPS), seed=0)
    assert (fitting.steps, fitting.end, fitting.training_pairs) == (STEPS, "steps", len(pairs))
    unseen = next(make_training_pairs(training_surface, np.random.default_rng(99)))
    untrained, trained = measured(Residual(), unseen), measured(network, unseen)
    assert untrained.network == untrained.fill == trained.fill
    assert trained.network < 0.75 * trained.fill
    assert trained.loss < 0.8 * untrained.loss
    assert fitting.held_out_before == pytest.approx(float(measured(Residual(), held_out).loss), rel=1e-3)
    assert fitting.held_out_after == pytest.approx(float(measured(network, held_out).loss), rel=0.02)


def test_the_same_seed_gives_the_same_bits_and_another_one_others(pairs: TrainingPairs) -> None:
    one, same, other = (fit(small(), iter([pairs]), pairs, SHORT, seed=seed) for seed in (3, 3, 4))
    assert (weights(one[0]), one[1]) == (weights(same[0]), same[1])
    assert weights(one[0]) != weights(other[0])


def test_neither_a_slow_machine_nor_more_threads_change_steps_or_bits(pairs: TrainingPairs) -> None:
    before, found = torch.get_num_threads(), []
    try:
        for threads, seconds_a_look in ((1, 0.0), (2, 1e9)):
            torch.set_num_threads(threads)
            ended = fit(small(), iter([pairs]), pairs, SHORT, seed=3, clock=count(0.0, seconds_a_look).__next__)
            found.append((weights(ended[0]), ended[1]))
            assert torch.get_num_threads() == threads
    finally:
        torch.set_num_threads(before)
    assert found[0] == found[1]
    assert found[0][0] != weights(small())


def test_a_limit_on_time_keeps_what_was_gained_and_says_where_it_struck(pairs: TrainingPairs) -> None:
    network = small()
    options = NetworkOptions(steps=100_000, seconds=CHECK + 20.0)
    fitted, fitting = fit(network, iter([pairs]), pairs, options, seed=0, clock=count(0.0).__next__)
    assert (fitting.steps_asked, fitting.steps, fitting.end) == (100_000, CHECK + 19, "seconds")
    assert fitting.held_out_after is not None
    assert fitting.held_out_before is not None
    assert fitting.held_out_after < fitting.held_out_before
    assert measured(fitted, pairs).loss < measured(network, pairs).loss


def test_without_time_for_a_step_the_network_stays_as_it_is(pairs: TrainingPairs) -> None:
    network, options = small(), NetworkOptions(steps=10, seconds=0.1)
    fitted, fitting = fit(network, iter([pairs]), pairs, options, seed=0, clock=count(0.0).__next__)
    assert fitted is network
    assert (fitting.steps, fitting.end) == (0, "seconds")
    assert fitting.held_out_after == fitting.held_out_before


def test_a_network_that_loses_on_what_is_held_out_is_dropped_after_a_few_steps(pairs: TrainingPairs) -> None:
    """Calibration holes whose truth lies on the other side of the fill: every step makes them worse."""
    network, contrary = small(), replace(pairs, correction=-pairs.correction)
    rounds = iter([pairs, pairs])
    fitted, fitting = fit(network, rounds, contrary, NetworkOptions(steps=100_000), seed=0)
    assert fitted is network
    assert (fitting.steps, fitting.end, fitting.training_pairs) == (PATIENCE * CHECK, "no_gain", len(pairs))
    assert fitting.held_out_after == fitting.held_out_before
    assert list(rounds) == [pairs]


def test_fitting_ends_where_what_is_held_out_gains_nothing_more(pairs: TrainingPairs) -> None:
    """Half of the correction is right: steps gain until they reach it, and then lose."""
    judge = replace(pairs, correction=np.float32(0.5) * pairs.correction)
    network, fitting = fit(small(), iter([pairs]), judge, NetworkOptions(steps=100_000), seed=0)
    assert fitting.end == "settled"
    assert PATIENCE * CHECK < fitting.steps < 100_000
    assert fitting.held_out_before is not None
    assert fitting.held_out_after is not None
    assert fitting.held_out_after < (1 - LEAST_GAIN) * fitting.held_out_before
    assert fitting.held_out_after == pytest.approx(float(measured(network, judge).loss), rel=0.02)


def test_every_gain_brings_a_round_of_training_pairs_until_they_are_enough(pairs: TrainingPairs) -> None:
    rounds = iter([pairs] * 1000)
    _, fitting = fit(small(), rounds, pairs, NetworkOptions(steps=2 * CHECK), seed=0)
    assert fitting.training_pairs == 3 * len(pairs)
    large = TrainingPairs.joined([pairs] * (1 + ENOUGH_PAIRS // len(pairs)), RESOLUTION)
    _, fitting = fit(small(), iter([large, pairs]), pairs, NetworkOptions(steps=CHECK), seed=0)
    assert fitting.training_pairs == len(large)


def test_matrix_products_are_in_bfloat16_only_where_the_processor_is_fast_at_them(
    pairs: TrainingPairs,
) -> None:
    network, seen = small(), set[torch.dtype]()
    network.last.register_forward_hook(lambda _module, _seen, answer: seen.add(answer.dtype))
    fit(network, iter([pairs]), pairs, NetworkOptions(steps=1), seed=0)
    assert seen == {torch.bfloat16 if has_fast_bfloat16() else torch.float32}


def test_training_pairs_of_the_same_seed_are_the_same(undamaged: UndamagedSurface) -> None:
    one, same, other = (FittingInpainter(small(), SHORT, seed).fitted_to(undamaged) for seed in (0, 0, 1))
    assert weights(one.network) == weights(same.network) != weights(other.network)
    assert one.fitting == same.fitting
    assert one.fitting is not None
    assert one.fitting.training_pairs >= MIN_PAIRS


def test_a_surface_with_too_few_training_pairs_leaves_the_network_as_it_is(
    training_surface: TrainingSurface, undamaged: UndamagedSurface
) -> None:
    inpainter = FittingInpainter(small(), NetworkOptions(steps=2))
    too_wide = replace(training_surface, diameters=np.array([3.0]))
    fitted = inpainter.fitted_to(replace(undamaged, training_surface=lambda: too_wide))
    assert fitted.network is inpainter.network
    assert fitted.fitting is not None
    assert (fitted.fitting.steps, fitted.fitting.end, fitted.fitting.training_pairs) == (0, "no_room", 0)


@pytest.mark.parametrize("n_held_out", [None, 0])
def test_nothing_is_cut_nor_fitted_where_there_is_no_calibration_hole_to_judge_by(
    undamaged: UndamagedSurface, n_held_out: int | None
) -> None:
    def never() -> TrainingSurface:
        raise AssertionError

    none = None if n_held_out is None else lambda: TrainingPairs.joined([], RESOLUTION)
    inpainter = FittingInpainter(small(), NetworkOptions(steps=2))
    fitted = inpainter.fitted_to(replace(undamaged, training_surface=never, held_out=none))
    assert fitted.network is inpainter.network
    assert fitted.fitting == Fitting(steps_asked=2, steps=0, end="no_calibration")


def test_fitting_makes_another_network_and_tells_how_far_it_is(undamaged: UndamagedSurface) -> None:
    heard: list[tuple[str, float]] = []
    inpainter = FittingInpainter(small(), SHORT, 0, lambda *said: heard.append(said))
    before = weights(inpainter.network)
    fitted = inpainter.fitted_to(undamaged)
    assert weights(inpainter.network) == before != weights(fitted.network)
    assert heard == [("learn", (step + 1) / SHORT.steps) for step in range(SHORT.steps)]
    assert (fitted.resolution, fitted.options) == (inpainter.resolution, inpainter.options)


def random_patches(heights: FloatArray, known: BoolArray) -> Patches:
    n = len(heights)
    frames = np.tile(np.eye(3), (n, 1, 1))
    return Patches(
        np.zeros((n, 3)), frames, 1.0, heights, known, np.ones_like(known), np.zeros(heights.shape, np.int64)
    )


def test_predictions_are_the_fill_with_the_mean_of_what_the_network_answers_to_four_turns() -> None:
    rng = np.random.default_rng(0)
    shape = (300, RESOLUTION, RESOLUTION)
    heights, base_heights, known = rng.normal(size=shape), 0.1 * rng.normal(size=shape), rng.random(shape) > 0.3
    patches, network = random_patches(heights, known), stirred(fresh())
    predicted = FittingInpainter(network, NetworkOptions()).predict(patches, base_heights)
    seen = network_input(patches, base_heights)
    channels = torch.from_numpy(seen.channels)
    with torch.inference_mode():
        turned = [network(channels.rot90(turn, (2, 3))).rot90(-turn, (2, 3)) for turn in range(4)]
    answers = torch.stack(turned).mean(dim=0)[:, 0].numpy().astype(np.float64)
    expected = corrected(patches, seen.deviation, answers)
    # bfloat16 has 8 binary digits.
    off = 2.0**-7 * np.abs(expected - heights).max() if has_fast_bfloat16() else 1e-5
    np.testing.assert_allclose(predicted, expected, atol=off)
    assert np.abs(expected - heights).max() > 100 * off
    assert predicted[known].tobytes() == heights[known].tobytes()
    untouched = FittingInpainter(fresh(), NetworkOptions()).predict(patches, base_heights)
    np.testing.assert_array_equal(untouched, heights)


def test_a_turned_patch_gets_the_turned_prediction() -> None:
    rng = np.random.default_rng(1)
    shape = (3, RESOLUTION, RESOLUTION)
    heights, base_heights, known = rng.normal(size=shape), 0.1 * rng.normal(size=shape), rng.random(shape) > 0.3
    inpainter = FittingInpainter(stirred(fresh()), NetworkOptions())
    upright = inpainter.predict(random_patches(heights, known), base_heights)
    turned = random_patches(np.rot90(heights, axes=(1, 2)).copy(), np.rot90(known, axes=(1, 2)).copy())
    answer = inpainter.predict(turned, np.rot90(base_heights, axes=(1, 2)).copy())
    np.testing.assert_allclose(answer, np.rot90(upright, axes=(1, 2)), atol=1e-4)
