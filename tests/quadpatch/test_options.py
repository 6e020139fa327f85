from typing import Any

import pytest

from quadpatch.errors import OptionError
from quadpatch.options import DictionaryOptions, HoleOptions, NetworkOptions, PatchOptions, RepairOptions


def test_nothing_given_means_every_automatic_rule() -> None:
    assert RepairOptions.from_dict({}) == RepairOptions()
    assert RepairOptions.from_dict({"holes": None, "patches": {}}) == RepairOptions()


def test_plain_values_become_options() -> None:
    options = RepairOptions.from_dict(
        {
            "holes": {"max_diameter": 2, "ids": [3, 1]},
            "patches": {"length": 0.5, "resolution": 24, "overlap": 0},
            "seed": 7,
            "recipe": "paper",
            "dictionary": {"atoms": 50, "nonzero": 5},
            "network": {"steps": 30, "seconds": 4},
        }
    )
    holes, patches = HoleOptions(max_diameter=2, ids=(3, 1)), PatchOptions(0.5, 24, 0)
    assert options == RepairOptions(holes, patches, 7, "paper", DictionaryOptions(50, 5), NetworkOptions(30, 4))


@pytest.mark.parametrize(
    "values",
    [
        {"holes": {"max_diameter": 0}},
        {"holes": {"cap": "round"}},
        {"holes": {"rules": [{}]}},
        {"holes": {"rules": [{"action": "fill"}]}},
        {"holes": {"rules": [{"action": "skip", "kind": "window"}]}},
        {"holes": {"rules": [{"action": "skip", "max_diameter": -1.0}]}},
        {"holes": {"rules": [{"action": "skip", "colour": "red"}]}},
        {"holes": {"rules": ["skip"]}},
        {"holes": {"rules": 7}},
        {"holes": {"max_diameter": -1.0}},
        {"holes": {"max_diameter": float("nan")}},
        {"holes": {"max_perimeter": float("inf")}},
        {"holes": {"max_diameter": "wide"}},
        {"holes": {"ids": ["first"]}},
        {"holes": {"ids": 3}},
        {"holes": {"depth": 1}},
        {"holes": [1]},
        {"patches": {"length": 0.0}},
        {"patches": {"length": float("inf")}},
        {"patches": {"resolution": 7}},
        {"patches": {"resolution": 129}},
        {"patches": {"resolution": 16.5}},
        {"patches": {"overlap": -1}},
        {"patches": {"overlap": 9}},
        {"seed": -1},
        {"seed": 0.5},
        {"seed": "today"},
        {"colour": "red"},
        {"recipe": "ours"},
        {"recipe": None},
        {"recipe": ["paper"]},
        {"dictionary": {"atoms": 50}},
        {"recipe": "default", "dictionary": {"nonzero": 5}},
        {"recipe": "paper", "dictionary": {"atoms": 1}},
        {"recipe": "paper", "dictionary": {"atoms": 2.5}},
        {"recipe": "paper", "dictionary": {"nonzero": 0}},
        {"recipe": "paper", "dictionary": {"size": 3}},
        {"recipe": "paper", "dictionary": [3]},
        {"network": {"steps": 0}},
        {"network": {"steps": 100_001}},
        {"network": {"steps": 2.5}},
        {"network": {"seconds": 0}},
        {"network": {"seconds": float("inf")}},
        {"network": {"seconds": float("nan")}},
        {"network": {"seconds": "long"}},
        {"network": {"hours": 1}},
        *({"weld_tolerance": value} for value in (-1.0, float("nan"), float("inf"), "near", True, None, [1])),
    ],
)
def test_what_can_not_be_meant_is_refused_with_a_code(values: dict[str, Any]) -> None:
    with pytest.raises(OptionError) as caught:
        RepairOptions.from_dict(values)
    assert caught.value.code == "invalid_option"


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"holes": {"max_diameter": -1.0}}, r"holes\.max_diameter must be finite and greater than 0; it is -1"),
        ({"patches": {"resolution": 7}}, r"patches\.resolution must be a whole number between 8 and 128; it is 7"),
        ({"weld_tolerance": -1}, "weld_tolerance must be auto, or finite and 0 or more; it is -1"),
        ({"seed": -1}, "seed must be a whole number of 0 or more; it is -1"),
        ({"colour": "red"}, "colour"),
        ({"colours": "red"}, "colours must be one of auto, harmonic; it is 'red'"),
        ({"recipe": "ours"}, "recipe must be one of default, paper; it is 'ours'"),
        ({"dictionary": {"atoms": 9}}, r"dictionary\.atoms and dictionary\.nonzero go with the recipe paper only"),
        ({"network": {"steps": 0}}, r"network\.steps must be a whole number between 1 and 100000; it is 0"),
        ({"network": {"seconds": -1}}, r"network\.seconds must be finite and greater than 0; it is -1"),
        ({"dictionary": {"atoms": 1}}, r"dictionary\.atoms must be a whole number between 2 and 4096; it is 1"),
    ],
)
def test_the_message_names_the_option_its_value_and_the_limit(values: dict[str, Any], message: str) -> None:
    with pytest.raises(OptionError, match=message):
        RepairOptions.from_dict(values)
