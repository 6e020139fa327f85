"""The page about training, held to the code it speaks of."""

import re
from pathlib import Path

from training.autoencoder import PLANS
from training.export import PARITY
from training.holes import LARGEST
from training.paper_task import PERCENTILES
from training.trainer import WARM_UP_STEPS, TrainOptions

PAGE = Path(__file__).resolve().parents[2] / "docs" / "training.md"


def test_the_numbers_of_the_page_are_those_of_the_code() -> None:
    sections = dict(part.split("\n", 1) for part in PAGE.read_text("utf-8").split("\n## ")[1:])
    options = TrainOptions()
    low, high = (f"{percentile:g}" for percentile in PERCENTILES)
    for section, numbers in {
        "A run": (WARM_UP_STEPS, options.n_validations, options.patience),
        "What a network sees": (low, high, LARGEST),
        "The file that comes out": (f"{PARITY:g}".replace("1e-05", "1e-5"),),
    }.items():
        found = re.findall(r"\d+(?:\.\d+)?(?:e-\d+)?", sections[section])
        assert {str(number) for number in numbers} <= set(found), section


def test_every_network_is_in_the_table_with_its_bins() -> None:
    page = PAGE.read_text("utf-8")
    for name, plan in PLANS.items():
        assert f"| `{name}` | {plan.resolution} x {plan.resolution} |" in page
