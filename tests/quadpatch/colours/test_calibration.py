from dataclasses import replace

import numpy as np
import pytest

from quadpatch.colours.calibration import MOST_LOST_DB, Belief, Detail, Verdict, calibrate
from quadpatch.colours.detail import Choice
from quadpatch.colours.gap_graph import GapGraph
from quadpatch.colours.surface import ColouredSurface
from quadpatch.types import FloatArray
from tests.quadpatch.shapes import open_grid

MESH = open_grid(81)
RNG = np.random.default_rng(0)
TRUTH = (128 + RNG.normal(0, 25, (len(MESH.vertices), 3))).clip(0, 255)
CENTRES = np.array([(x, y, 0.0) for x in (-24, -8, 8, 24) for y in (-24, -8, 8, 24)])
DISTANCE = np.linalg.norm(MESH.vertices[:, np.newaxis] - CENTRES, axis=2)
GAP = np.where(DISTANCE.min(axis=1) < 4.5, DISTANCE.argmin(axis=1), -1)
SURFACE = ColouredSurface.of_measured(MESH, TRUTH, GAP, 16, 1.0)
GRAPH = GapGraph.of_gaps(SURFACE, 0, 16)
TRUE_COLOURS = TRUTH[GRAPH.vertices]
LACKING = TRUE_COLOURS - SURFACE.colours[GRAPH.vertices]
# Noise of the same kind, zero at the rims.
OTHER = ColouredSurface.of_measured(MESH, (128 + RNG.normal(0, 25, TRUTH.shape)).clip(0, 255), GAP, 16, 1.0)
FOREIGN = 128 + RNG.normal(0, 25, LACKING.shape) - OTHER.colours[GRAPH.vertices]


class Fixed:
    """Makes the same detail by every choice, in place of a `DetailMaker`."""

    def __init__(self, detail: FloatArray) -> None:
        self.graph, self._detail = GRAPH, detail

    def make(self, choice: Choice) -> FloatArray:
        return self._detail


BEST = Choice(1, 0.0)


def belief_in(detail: FloatArray) -> tuple[Detail, Belief]:
    made = Detail(SURFACE, Fixed(detail), BEST)  # type: ignore[arg-type]
    return made, made.believed(BEST, TRUE_COLOURS, SURFACE.colours)


def test_what_harmonic_colours_lack_is_wholly_true() -> None:
    detail, belief = belief_in(LACKING)
    assert belief.true_part == pytest.approx(1.0)
    assert detail.affordable_share(belief) == 1.0
    verdict = detail.judged(belief, 1.0, TRUE_COLOURS, SURFACE.colours)
    assert verdict.gain_db > 10
    assert verdict.kept == pytest.approx(1.0, abs=0.05)
    assert verdict.n_holes == 16


def test_detail_of_the_right_kind_alone_is_not_true_and_is_taken_as_far_as_it_may_cost() -> None:
    detail, belief = belief_in(FOREIGN)
    assert belief.true_part < 0.1
    share = detail.affordable_share(belief)
    verdict = detail.judged(belief, share, TRUE_COLOURS, SURFACE.colours)
    assert verdict.gain_db == pytest.approx(-MOST_LOST_DB, abs=0.3)
    assert verdict.kept > verdict.kept_harmonic + 0.1
    more = detail.judged(belief, 1.0, TRUE_COLOURS, SURFACE.colours)
    assert more.gain_db < -2
    assert more.kept > verdict.kept


def test_error_and_energy_are_measured_beside_the_roughness_around() -> None:
    _, belief = belief_in(FOREIGN)
    # White noise of variance v: neighbours differ by 2 v, and a harmonic fill misses by little more than v.
    assert 0.5 <= belief.error_per_roughness < 0.65
    assert belief.energy_per_roughness == pytest.approx(1.0, abs=0.1)


def test_a_share_of_nothing_leaves_harmonic_colours() -> None:
    detail, belief = belief_in(FOREIGN)
    assert (detail.coloured(belief, 0.0) == SURFACE.colours[GRAPH.vertices]).all()


def test_colours_stay_in_the_range_of_those_around_their_gap() -> None:
    detail, belief = belief_in(100 * FOREIGN)
    coloured = detail.coloured(replace(belief, energy_per_roughness=1e4), 1.0)
    for gap in range(16):
        around = TRUTH[(DISTANCE[:, gap] < 8.5) & (GAP < 0)]
        assert (coloured[GRAPH.gap == gap] >= around.min(axis=0)).all()
        assert (coloured[GRAPH.gap == gap] <= around.max(axis=0)).all()


@pytest.mark.parametrize(("detail", "is_better"), [(LACKING, True), (FOREIGN, False), (0 * FOREIGN, False)])
def test_detail_counts_where_it_brings_more_than_it_costs(detail: FloatArray, is_better: bool) -> None:
    belief, verdict = calibrate(SURFACE, Fixed(detail), TRUE_COLOURS)  # type: ignore[arg-type]
    assert verdict.is_better is is_better
    assert belief.error_per_roughness > 0


def test_detail_is_wanted_only_where_harmonic_colours_are_a_blur() -> None:
    assert Verdict(0.0, 0.9, 0.5, 16).is_better
    assert not Verdict(0.0, 1.0, 0.8, 16).is_better


def test_a_quarter_of_the_gradients_is_worth_a_decibel() -> None:
    assert Verdict(-1.0, 0.46, 0.2, 16).is_better
    assert not Verdict(-1.0, 0.44, 0.2, 16).is_better
    assert not Verdict(-4.5, 3.0, 0.0, 16).is_better
