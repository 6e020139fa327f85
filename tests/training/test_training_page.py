"""The page about training, held to the code it speaks of."""

from pathlib import Path

from training.autoencoder import PLANS
from training.export import PARITY
from training.holes import LARGEST
from training.paper_task import PERCENTILES
from training.trainer import WARM_UP_STEPS, TrainOptions

PAGE = Path(__file__).resolve().parents[2] / "docs" / "training.md"


def test_the_numbers_of_the_page_are_those_of_the_code() -> None:
    prose = " ".join(PAGE.read_text("utf-8").split())
    options = TrainOptions()
    assert (options.n_validations, options.patience) == (20, 6)
    low, high = PERCENTILES
    for claim in (
        f"warm-up of {WARM_UP_STEPS} steps",
        f"the {low}th to the {high}th percentile",
        f"0 to {LARGEST} of the patch length",
        f"to {PARITY:g}".replace("1e-05", "1e-5"),
        "Twenty times over the budget",
        "after six times without gain",
    ):
        assert claim in prose, claim


def test_every_network_is_in_the_table_with_its_bins() -> None:
    page = PAGE.read_text("utf-8")
    for name, plan in PLANS.items():
        assert f"| `{name}` | {plan.resolution} x {plan.resolution} |" in page
