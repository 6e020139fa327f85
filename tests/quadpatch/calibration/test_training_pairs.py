from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.training_pairs import TrainingPairs, TrainingSurface, make_training_pairs
from quadpatch.filling.fairing import Energy
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.patches.residual_input import LARGEST, RESOLUTION
from quadpatch.patches.scale import PatchScale
from quadpatch.types import BoolArray, FloatArray, TriangleMesh
from tests.quadpatch.shapes import open_grid, punched, relief, sphere
from tests.quadpatch.training_surfaces import ground_of, looking_down

DIAMETER = 0.3
RELIEF = relief(110, 2.0, 0.04, 6)
# Three waves across a patch: the base surface, a mean over a third of it, shows none of them.
LENGTH = 1.0


def rounds(training_surface: TrainingSurface, count: int, seed: int = 0) -> list[TrainingPairs]:
    return list(islice(make_training_pairs(training_surface, np.random.default_rng(seed)), count))


def height_of_relief(x: FloatArray, y: FloatArray) -> FloatArray:
    """As `relief` says, at any place."""
    u, v = 6 * np.pi * x, 6 * np.pi * y
    return np.asarray(0.04 * (np.sin(u) * np.cos(v) + np.sin(v) * np.cos(0.3) + np.sin(0.3) * np.cos(u)))


def left_over(signal: FloatArray, truth: FloatArray, where: BoolArray, known: BoolArray) -> float:
    """Mean distance in some bins, in standard deviations, once scale, shift and tilt are as the known bins say."""
    tick = (np.arange(RESOLUTION) + 0.5) / RESOLUTION
    columns = np.stack([truth, np.ones_like(truth), *np.meshgrid(tick, tick)], axis=-1)
    solution, *_ = np.linalg.lstsq(columns[known], signal[known], rcond=None)
    return float(np.abs(columns[where] @ solution - signal[where]).mean())


@pytest.fixture(scope="module")
def training_surface() -> TrainingSurface:
    return ground_of(RELIEF, DIAMETER)


@pytest.fixture(scope="module")
def pairs(training_surface: TrainingSurface) -> TrainingPairs:
    (only,) = rounds(training_surface, 1)
    return only


def test_the_fill_with_its_correction_is_the_surface_that_was_there(training_surface: TrainingSurface) -> None:
    """Held against the formula of the relief: the known bins say in which scale."""
    places = [(x, y, 0.0) for x in (-0.3, 0.0, 0.3) for y in (-0.3, 0.0, 0.3)]
    scale = PatchScale(LENGTH, RESOLUTION, 0)
    (given,) = rounds(replace(training_surface, seeds=looking_down(*places), scale=scale), 1)
    assert len(given) == len(places)
    tick = ((np.arange(RESOLUTION) + 0.5) / RESOLUTION - 0.5) * LENGTH
    offset_x, offset_y = np.meshgrid(tick, tick)
    for (x, y, _), channels, correction, loss_mask in zip(
        places, given.channels.astype(float), given.correction.astype(float), given.loss_mask > 0, strict=True
    ):
        truth = height_of_relief(x + offset_x, y + offset_y)
        known = channels[1] > 0
        in_the_fill = left_over(channels[0], truth, loss_mask, known)
        in_the_pair = left_over(channels[0] + correction, truth, loss_mask, known)
        in_the_mesh = left_over(channels[0], truth, known, known)
        assert in_the_fill > 0.2
        assert in_the_pair < 0.1
        assert in_the_pair < 3 * in_the_mesh


def test_a_fill_without_error_leaves_nothing_to_correct() -> None:
    flat = ground_of(open_grid(80, 2.0), DIAMETER)
    (given,) = rounds(flat, 1)
    assert given.loss_mask.sum() > 1000
    assert (given.correction == 0).all()


def test_the_true_surface_of_a_ball_lies_above_a_fill_that_is_drawn_tight() -> None:
    ball = ground_of(sphere(5), 0.4)
    (given,) = rounds(replace(ball, blend=EnergyBlend.of_one(Energy(membrane=1.0))), 1)
    corrections = given.correction[given.loss_mask > 0]
    assert np.mean(corrections > 0) > 0.97
    assert np.median(corrections) > 0.5


def test_nothing_is_asked_but_in_invented_bins(pairs: TrainingPairs) -> None:
    loss_mask = pairs.loss_mask > 0
    assert set(np.unique(pairs.loss_mask)) == {0.0, 1.0}
    assert loss_mask.any(axis=(1, 2)).mean() > 0.9
    assert (pairs.channels[:, 1][loss_mask] == 0).all()
    assert (pairs.correction[~loss_mask] == 0).all()


def test_training_pairs_are_bounded_and_of_the_shape_that_networks_read(pairs: TrainingPairs) -> None:
    assert len(pairs) > 50
    assert pairs.channels.shape == (len(pairs), 2, RESOLUTION, RESOLUTION)
    assert pairs.correction.shape == pairs.loss_mask.shape == (len(pairs), RESOLUTION, RESOLUTION)
    for array in (pairs.channels, pairs.correction, pairs.loss_mask):
        assert array.dtype == np.float32
        assert np.isfinite(array).all()
        assert np.abs(array).max() <= LARGEST


def test_the_same_generator_gives_the_same_training_pairs_and_another_round_or_generator_others() -> None:
    training_surface = ground_of(relief(60, 1.2, 0.04, 4), DIAMETER)
    one, next_one = rounds(training_surface, 2)
    (same,), (other,) = rounds(training_surface, 1), rounds(training_surface, 1, seed=1)
    assert one.channels.tobytes() == same.channels.tobytes()
    assert one.correction.tobytes() == same.correction.tobytes()
    assert one.loss_mask.tobytes() == same.loss_mask.tobytes()
    for another in (next_one, other):
        assert one.loss_mask.tobytes() != another.loss_mask.tobytes()


def test_surface_that_is_missing_already_is_never_asked_for() -> None:
    """It is no truth: real holes, and those of calibration, are open in the ground."""
    mesh = punched(RELIEF, *((x, y, 0.0) for x in (-0.5, 0.0, 0.5) for y in (-0.5, 0.0, 0.5)), radius=0.15)
    whole = ground_of(RELIEF, DIAMETER)
    seeds = looking_down((0.0, 0.0, 0.0))
    scale = PatchScale(0.28, RESOLUTION, 0)
    for given in rounds(replace(whole, mesh=mesh, seeds=seeds, scale=scale), 2):
        assert given.loss_mask.sum() == 0


def test_where_there_is_no_room_for_a_hole_there_is_no_training_pair() -> None:
    small = open_grid(12, 0.3)
    edge_length = mean_edge_length(small)
    training_surface = TrainingSurface(
        small,
        looking_down((0, 0, 0)),
        PatchScale(0.6, RESOLUTION, 0),
        EnergyBlend.of_one(Energy(plate=1.0)),
        np.array([0.5]),
        edge_length,
    )
    assert [len(given) for given in rounds(training_surface, 2)] == [0, 0]
    nothing = TriangleMesh(small.vertices, small.triangles[:0])
    assert [len(given) for given in rounds(replace(training_surface, mesh=nothing), 1)] == [0]


def test_joined_training_pairs_stand_one_after_the_other(pairs: TrainingPairs) -> None:
    joined = TrainingPairs.joined([pairs, pairs], RESOLUTION)
    assert len(joined) == 2 * len(pairs)
    np.testing.assert_array_equal(joined.channels[len(pairs) :], pairs.channels)
    np.testing.assert_array_equal(joined.correction[: len(pairs)], pairs.correction)
    none = TrainingPairs.joined([], RESOLUTION)
    assert (len(none), none.channels.shape, none.loss_mask.shape) == (0, (0, 2, 32, 32), (0, 32, 32))
