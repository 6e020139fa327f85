from itertools import pairwise

import numpy as np
import pytest

from quadpatch.html_report.histogram import HEIGHT, WIDTH, bars, histogram


def test_every_value_is_counted_once_between_the_bounds() -> None:
    values = np.linspace(1.0, 3.0, 101)
    counted = histogram(values)
    assert counted is not None
    assert sum(counted["counts"]) == 101
    assert len(counted["edges"]) == len(counted["counts"]) + 1
    assert (counted["edges"][0], counted["edges"][-1]) == (1.0, 3.0)


def test_one_value_makes_a_histogram_and_none_make_none() -> None:
    one = histogram([0.5])
    assert one is not None
    assert sum(one["counts"]) == 1
    assert histogram([]) is None
    assert histogram([1.0, float("nan")]) is None


def test_bars_lie_side_by_side_in_the_picture_as_high_as_their_counts() -> None:
    laid_out = bars({"edges": [0.0, 1.0, 2.0, 3.0], "counts": [4, 0, 2]})
    assert [bar.count for bar in laid_out] == [4, 0, 2]
    assert laid_out[0].height == pytest.approx(2 * laid_out[2].height)
    assert laid_out[1].height == 0
    for bar, following in pairwise(laid_out):
        assert bar.high == following.low
        assert bar.x + bar.width <= following.x
    assert all(bar.x >= 0 and bar.x + bar.width <= WIDTH and 0 <= bar.y <= HEIGHT for bar in laid_out)


def test_bins_without_any_value_have_flat_bars() -> None:
    assert [bar.height for bar in bars({"edges": [0.0, 1.0], "counts": [0]})] == [0]
