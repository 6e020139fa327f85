import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jobkit.shadows.figures import LEAST_JOBS, Measured, figures_of

ratios = st.lists(st.floats(0.2, 5.0), min_size=2, max_size=40)


def measured(*ratios: float) -> list[Measured]:
    return [Measured(3, ratio) for ratio in ratios]


def test_nothing_measured_says_so() -> None:
    figures = figures_of(None, [])
    assert (figures.jobs, figures.ratio, figures.standard_error, figures.may_be_default) == (0, None, None, False)
    assert figures.verdict == "nothing is measured yet"


def test_a_candidate_that_is_surely_better_may_be_made_default() -> None:
    figures = figures_of("general-dictionary@1", measured(*31 * [0.8], *9 * [1.0]))
    assert (figures.better, figures.worse, figures.jobs, figures.holes) == (31, 0, 40, 120)
    assert figures.ratio == pytest.approx(0.8 ** (31 / 40), abs=1e-5)
    assert (figures.verdict, figures.may_be_default) == ("better on 31 of 40 jobs: may be made default", True)


def test_few_jobs_are_no_ground_however_much_better_they_are() -> None:
    figures = figures_of("auto", measured(*(LEAST_JOBS - 1) * [0.5]))
    assert not figures.may_be_default
    assert figures.verdict == "better on 9 of 9 jobs: too few to judge by, 10 are needed"


@pytest.mark.parametrize(
    ("values", "verdict"),
    [
        (20 * [1.2], "worse on 20 of 20 jobs: not to be made default"),
        (10 * [0.5] + 10 * [1.9], "better on 10 and worse on 10 of 20 jobs: no sure gain, not to be made default"),
        (20 * [1.0], "better on 0 and worse on 0 of 20 jobs: no sure gain, not to be made default"),
        # Better on most, and worse by more on the others.
        (12 * [0.9] + 8 * [1.15], "better on 12 and worse on 8 of 20 jobs: no sure gain, not to be made default"),
    ],
)
def test_without_a_sure_gain_it_stays_a_candidate(values: list[float], verdict: str) -> None:
    figures = figures_of("auto", measured(*values))
    assert (figures.verdict, figures.may_be_default) == (verdict, False)


@given(ratios)
def test_the_standard_error_is_that_of_the_mean_of_logarithms(values: list[float]) -> None:
    figures = figures_of("auto", measured(*values))
    logs = [math.log(value) for value in values]
    mean = sum(logs) / len(logs)
    deviation = math.sqrt(sum((log - mean) ** 2 for log in logs) / (len(logs) - 1))
    assert figures.ratio == pytest.approx(math.exp(mean), abs=1e-4)
    assert figures.standard_error == pytest.approx(math.exp(mean) * deviation / math.sqrt(len(logs)), abs=1e-4)
    assert figures.better + figures.worse <= figures.jobs
