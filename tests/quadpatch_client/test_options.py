"""Also tests `quadpatch_client.method_options`."""

from typing import get_args

import pytest

from quadpatch_client.errors import UsageError
from quadpatch_client.options import HoleChoice, MethodChoice, MethodName, tolerance
from quadpatch_client.schema import AutoMethod, CnnMethod, DictionaryMethod, Fitting, HoleRule, PatchOptions
from quadpatch_client.spec import make_spec
from quadpatch_rules.option_words import Effort

MESH_ID = "0" * 64


def test_a_recipe_reaches_the_spec_and_is_the_services_default_otherwise() -> None:
    by_default = make_spec(MESH_ID, HoleChoice(), MethodChoice(recipe="paper"))
    assert by_default.method == DictionaryMethod(method="dictionary", recipe="paper")
    chosen = make_spec(MESH_ID, HoleChoice(), MethodChoice(model="self", recipe="paper"))
    assert chosen.method == DictionaryMethod(method="dictionary", model="self", recipe="paper")
    usual = make_spec(MESH_ID, HoleChoice(), MethodChoice(model="self"))
    assert usual.method == DictionaryMethod(method="dictionary", model="self")


def test_what_is_not_asked_for_is_left_to_the_service() -> None:
    usual = make_spec(MESH_ID, HoleChoice(), MethodChoice())
    assert "method" not in usual.model_fields_set
    assert usual.method == AutoMethod(method="auto", effort="standard")


def test_recipes_go_with_learned_models() -> None:
    network = make_spec(MESH_ID, HoleChoice(), MethodChoice("cnn", recipe="paper", preset="type2"))
    assert network.method == CnnMethod(method="cnn", recipe="paper", patches=PatchOptions(preset="type2"))
    with pytest.raises(UsageError, match="the method 'smooth' takes no model, no recipe"):
        make_spec(MESH_ID, HoleChoice(), MethodChoice("smooth", recipe="paper"))
    with pytest.raises(UsageError, match="the recipe paper fits no network to a mesh"):
        make_spec(MESH_ID, HoleChoice(), MethodChoice("cnn", "self", recipe="paper"))


def test_auto_finds_the_model_by_itself() -> None:
    chosen = make_spec(MESH_ID, HoleChoice(), MethodChoice("auto", overlap=1))
    assert chosen.method == AutoMethod(method="auto", patches=PatchOptions(overlap=1))
    for given in ({"model": "self"}, {"recipe": "paper"}):
        with pytest.raises(UsageError, match="name another method for a model or a recipe"):
            make_spec(MESH_ID, HoleChoice(), MethodChoice("auto", **given))  # type: ignore[arg-type]


@pytest.mark.parametrize("effort", get_args(Effort))
@pytest.mark.parametrize("method", ["auto", None])
def test_an_effort_reaches_the_spec(effort: Effort, method: MethodName | None) -> None:
    chosen = make_spec(MESH_ID, HoleChoice(), MethodChoice(method, effort=effort))
    assert chosen.method == AutoMethod(method="auto", effort=effort)


def test_the_effort_best_can_be_told_how_long_to_fit() -> None:
    chosen = make_spec(MESH_ID, HoleChoice(), MethodChoice(effort="best", fit_steps=30, fit_seconds=12.5, overlap=1))
    fitting, patches = Fitting(steps=30, seconds=12.5), PatchOptions(overlap=1)
    assert chosen.method == AutoMethod(method="auto", effort="best", fitting=fitting, patches=patches)
    for effort in (None, "fast", "standard"):
        with pytest.raises(UsageError, match="only 'best' fits a network"):
            make_spec(MESH_ID, HoleChoice(), MethodChoice(effort=effort, fit_steps=30))


@pytest.mark.parametrize(
    ("choice", "method"),
    [
        (MethodChoice("smooth", effort="fast"), "smooth"),
        (MethodChoice("cnn", "self", effort="best"), "cnn"),
        (MethodChoice(model="self", effort="standard"), "dictionary"),
        (MethodChoice(recipe="paper", effort="best"), "dictionary"),
    ],
)
def test_an_effort_goes_with_no_other_method_than_auto(choice: MethodChoice, method: str) -> None:
    with pytest.raises(UsageError, match=f"an effort goes with the method 'auto' alone, not with '{method}'"):
        make_spec(MESH_ID, HoleChoice(), choice)


def test_a_preset_takes_the_place_of_a_length_and_a_resolution() -> None:
    for given in ({"length": 3.0}, {"resolution": 24}):
        with pytest.raises(UsageError, match=r"method\.patches\.preset says length and resolution"):
            make_spec(MESH_ID, HoleChoice(), MethodChoice(preset="type1", **given))


def test_how_long_to_fit_a_network_reaches_the_spec_and_is_the_services_default_otherwise() -> None:
    chosen = make_spec(MESH_ID, HoleChoice(), MethodChoice("cnn", "self", fit_steps=30, fit_seconds=12.5))
    assert chosen.method == CnnMethod(method="cnn", model="self", fitting=Fitting(steps=30, seconds=12.5))
    usual = make_spec(MESH_ID, HoleChoice(), MethodChoice("cnn", "self"))
    assert usual.method == CnnMethod(method="cnn", model="self")


@pytest.mark.parametrize(
    ("method", "model"),
    [("cnn", None), ("cnn", "general-residual@1"), ("dictionary", "self"), ("dictionary", None), ("smooth", None)],
)
def test_only_a_network_can_be_told_how_long_to_be_fitted(method: MethodName, model: str | None) -> None:
    for choice in (MethodChoice(method, model, fit_steps=30), MethodChoice(method, model, fit_seconds=5.0)):
        with pytest.raises(UsageError, match="the method 'cnn' with the model 'self' fit a network"):
            make_spec(MESH_ID, HoleChoice(), choice)


def test_smooth_takes_neither_a_model_nor_patch_options() -> None:
    for choice in (MethodChoice("smooth", model="self"), MethodChoice("smooth", overlap=1)):
        with pytest.raises(UsageError, match="takes no model, no recipe and no patch options"):
            make_spec(MESH_ID, HoleChoice(), choice)


@pytest.mark.parametrize(("word", "value"), [("auto", "auto"), ("0", 0.0), ("0.25", 0.25)])
def test_a_weld_tolerance_reaches_the_spec(word: str, value: float | str) -> None:
    chosen = make_spec(MESH_ID, HoleChoice(), MethodChoice(), weld_tolerance=tolerance(word))
    assert chosen.weld_tolerance == value
    assert make_spec(MESH_ID, HoleChoice(), MethodChoice(), weld_tolerance=tolerance(None)).weld_tolerance == "auto"


@pytest.mark.parametrize("word", ["-1", "nan", "near"])
def test_a_weld_tolerance_that_is_none_is_named(word: str) -> None:
    with pytest.raises(UsageError, match="--weld-tolerance has to be"):
        make_spec(MESH_ID, HoleChoice(), MethodChoice(), weld_tolerance=tolerance(word))


def test_colours_reach_the_spec() -> None:
    assert make_spec(MESH_ID, HoleChoice(), MethodChoice(), colours="harmonic").colours == "harmonic"
    assert make_spec(MESH_ID, HoleChoice(), MethodChoice(), colours=None).colours == "auto"
    with pytest.raises(UsageError, match="colours"):
        make_spec(MESH_ID, HoleChoice(), MethodChoice(), colours="red")


def test_an_option_out_of_its_range_is_named() -> None:
    with pytest.raises(UsageError, match="resolution"):
        make_spec(MESH_ID, HoleChoice(), MethodChoice(resolution=7))
    with pytest.raises(UsageError, match="--fit-steps has to be at least 1, not 0"):
        make_spec(MESH_ID, HoleChoice(), MethodChoice("cnn", "self", fit_steps=0))


def test_which_holes_reaches_the_spec() -> None:
    rules = ["id=3,id=4:skip", "kind=open_end,min_diameter=1,max_diameter=2.5,max_perimeter=9:flat", " smooth "]
    holes = make_spec(MESH_ID, HoleChoice(5.0, None, False, [1], True, "flat", rules), MethodChoice()).holes
    assert (holes.max_diameter, holes.ids, holes.include_borders, holes.cap) == (5.0, [1], True, "flat")
    assert holes.rules == [
        HoleRule(action="skip", ids=[3, 4]),
        HoleRule(action="flat", kind="open_end", min_diameter=1.0, max_diameter=2.5, max_perimeter=9.0),
        HoleRule(action="smooth"),
    ]


@pytest.mark.parametrize(
    "holes",
    [HoleChoice(cap="flat"), HoleChoice(rules=["max_diameter=5:smooth"]), HoleChoice(rules=["id=1:skip", "flat"])],
)
def test_options_that_exclude_each_other_are_told_before_anything_is_sent(holes: HoleChoice) -> None:
    with pytest.raises(UsageError, match="go with the recipe default only"):
        make_spec(MESH_ID, holes, MethodChoice(model="self", recipe="paper"))
    make_spec(MESH_ID, holes, MethodChoice(model="self"))
    with pytest.raises(UsageError, match="drop one of the two"):
        make_spec(MESH_ID, HoleChoice(rules=["id=1:skip"]), MethodChoice(), weld_tolerance=0.5)


@pytest.mark.parametrize(
    "rule", ["", "fill", "max_diameter=wide:flat", "colour=red:flat", "kind=window:flat", "id=x:skip"]
)
def test_a_rule_that_can_not_be_read_is_a_usage_error(rule: str) -> None:
    with pytest.raises(UsageError):
        make_spec(MESH_ID, HoleChoice(rules=[rule]), MethodChoice())


def test_bridges_are_read_and_what_is_none_is_a_usage_error() -> None:
    assert make_spec(MESH_ID, HoleChoice(bridges=["3:17", "0:4"]), MethodChoice()).holes.bridges == [[3, 17], [0, 4]]
    for texts, message in ((["3"], "like 3:17"), (["3:3"], "named twice"), (["3:4", "4:5"], "named twice")):
        with pytest.raises(UsageError, match=message):
            make_spec(MESH_ID, HoleChoice(bridges=texts), MethodChoice())
