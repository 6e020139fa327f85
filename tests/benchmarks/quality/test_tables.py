import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from benchmarks.quality.tables import NOTHING, Table, figure, geometric_mean, ratio, scientific

RATIOS = st.lists(st.floats(0.01, 100.0), min_size=1, max_size=12)


@given(values=RATIOS, factor=st.floats(0.1, 10.0))
def test_a_factor_on_every_value_is_one_on_the_mean(values: list[float], factor: float) -> None:
    mean, scaled = geometric_mean(values), geometric_mean(factor * value for value in values)
    assert mean is not None
    assert scaled == pytest.approx(factor * mean)


@given(values=RATIOS)
def test_ratios_turned_over_have_the_mean_turned_over(values: list[float]) -> None:
    mean, turned = geometric_mean(values), geometric_mean(1 / value for value in values)
    assert mean is not None
    assert turned == pytest.approx(1 / mean)


def test_a_mean_with_a_gap_is_none() -> None:
    assert geometric_mean([1.0, None, 2.0]) is None
    assert geometric_mean([]) is None


def test_a_ratio_to_nothing_is_none() -> None:
    assert ratio(None, 2.0) is None
    assert ratio(1.0, None) is None
    assert ratio(1.0, 0.0) is None
    assert ratio(1.0, 2.0) == 0.5


def test_figures_that_are_missing_are_dashes() -> None:
    assert figure(None) == scientific(None) == NOTHING
    assert figure(0.98765) == "0.988"
    assert scientific(0.00048264) == "483"


def test_markdown_has_the_summary_in_bold_and_escapes_pipes() -> None:
    table = Table("ratios", ["mesh", "ours"], [["a|b", "0.9"], ["mean", "0.8"]], n_summary=1)
    assert table.to_markdown().splitlines() == [
        "**ratios**",
        "",
        "| mesh | ours |",
        "| --- | ---: |",
        "| a\\|b | 0.9 |",
        "| **mean** | **0.8** |",
    ]


def test_the_console_shows_every_cell() -> None:
    console = Console(width=80)
    with console.capture() as capture:
        console.print(Table("ratios", ["mesh", "ours"], [["igea", "0.97"]]).to_rich())
    assert all(cell in capture.get() for cell in ("ratios", "mesh", "ours", "igea", "0.97"))
