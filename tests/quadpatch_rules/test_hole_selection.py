"""Plans and repairs apply one rule to holes and options of their own types: here they are held together."""

import json
from dataclasses import asdict
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import quadpatch_client.schema as wire
from quadpatch.errors import OptionError
from quadpatch.mesh import holes as method
from quadpatch.options import HoleOptions, HoleRule, RepairOptions
from quadpatch_rules.hole_selection import Cap, Choice, HoleAction, HoleKind, RuleAction, choose_holes, join_islands
from quadpatch_rules.option_words import Recipe

LENGTHS = st.floats(0.1, 100.0)
MAYBE_LENGTHS = st.none() | LENGTHS
KINDS = st.sampled_from(get_args(HoleKind))
HOLES = st.lists(
    st.fixed_dictionaries(
        {
            "perimeter": LENGTHS,
            "diameter": LENGTHS,
            "area": st.floats(0.01, 1e8),
            "is_manifold": st.sampled_from([True, True, True, False]),
            "kind": KINDS,
        }
    ),
    min_size=1,
    max_size=8,
)
IDS = st.none() | st.lists(st.integers(0, 7), min_size=1, max_size=4).map(tuple)
RULES = st.lists(
    st.builds(
        HoleRule,
        st.sampled_from(get_args(RuleAction)),
        IDS,
        st.none() | KINDS,
        MAYBE_LENGTHS,
        MAYBE_LENGTHS,
        MAYBE_LENGTHS,
    ),
    max_size=3,
).map(tuple)
BRIDGES = st.permutations(range(8)).flatmap(
    lambda ids: st.integers(0, 3).map(lambda n: tuple((ids[2 * i], ids[2 * i + 1]) for i in range(n)))
)
OPTIONS = st.builds(
    HoleOptions,
    MAYBE_LENGTHS,
    MAYBE_LENGTHS,
    st.booleans(),
    IDS,
    st.booleans(),
    st.sampled_from([None, *get_args(Cap)]),
    RULES,
    BRIDGES,
)


def on_the_wire(options: HoleOptions) -> wire.HoleSelection:
    return wire.HoleSelection.model_validate_json(json.dumps(asdict(options)))


def with_all_ids(measures: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Pad to eight holes, so that every id in use names one."""
    return [measures[i % len(measures)] for i in range(8)]


@given(measures=HOLES, diagonal=LENGTHS, options=OPTIONS)
def test_a_plan_selects_what_the_method_selects(
    measures: list[dict[str, Any]], diagonal: float, options: HoleOptions
) -> None:
    measures = with_all_ids(measures)
    loop = np.zeros(3, dtype=np.int64)
    theirs = [method.Hole(id=i, loop=loop, planarity=0.0, **row) for i, row in enumerate(measures)]
    ours = [wire.Hole(id=i, planarity=0.0, edges=3, **row) for i, row in enumerate(measures)]
    selection = method.select_holes(theirs, options, diagonal)
    expected = [(selection.skipped.get(hole.id, (None, ""))[0], selection.actions.get(hole.id)) for hole in theirs]
    choices = choose_holes(ours, on_the_wire(options), diagonal)
    assert [(choice.code, choice.action) for choice in choices] == expected


@given(options=OPTIONS, recipe=st.sampled_from(get_args(Recipe)))
def test_options_are_refused_when_a_job_is_made_where_the_method_refuses_them(
    options: HoleOptions, recipe: Recipe
) -> None:
    method = wire.DictionaryMethod(method="dictionary", model="self", recipe=recipe)
    conflict = wire.conflict_of(wire.RepairSpec(method=method, holes=on_the_wire(options)))
    if conflict is None:
        RepairOptions(options, recipe=recipe)
        return
    with pytest.raises(OptionError, match=conflict):
        RepairOptions(options, recipe=recipe)


def test_words_of_the_contract_are_those_of_the_method() -> None:
    assert get_args(wire.HoleKind) == get_args(HoleKind)
    assert get_args(wire.HoleAction) == get_args(HoleAction)
    assert set(wire.HoleRule.model_fields) == set(vars(HoleRule("skip")))
    assert set(wire.HoleSelection.model_fields) == set(vars(HoleOptions()))


@pytest.mark.parametrize(
    ("options", "action"),
    [
        (HoleOptions(), None),
        (HoleOptions(max_diameter=50.0), "model"),
        (HoleOptions(max_perimeter=500.0), "model"),
        (HoleOptions(all_but_largest=True), "model"),
        (HoleOptions(ids=(1,)), "model"),
        (HoleOptions(rules=(HoleRule("flat", ids=(1,)),)), "flat"),
        (HoleOptions(rules=(HoleRule("smooth", max_diameter=50.0),)), "smooth"),
        (HoleOptions(rules=(HoleRule("smooth", kind="hole"),)), None),
        (HoleOptions(rules=(HoleRule("smooth", min_diameter=1.0),)), None),
    ],
)
def test_any_size_that_is_chosen_takes_the_place_of_the_automatic_limit(
    options: HoleOptions, action: HoleAction | None
) -> None:
    wide = [wire.Hole(id=i, planarity=0.0, edges=40, perimeter=120.0, diameter=40.0, area=1e3) for i in range(2)]
    choice = choose_holes(wide, options, 100.0)[1]
    assert (choice.action, choice.code) == (action, None if action else "too_wide")


@pytest.mark.parametrize(
    ("hosts", "joined_to"),
    [([[], [0]], [None, 0]), ([[], [9, 0]], [None, 0]), ([[], [9]], [None, None]), ([[1], []], [None, None])],
)
def test_an_island_is_joined_to_the_first_of_its_hosts_that_is_filled(
    hosts: list[list[int]], joined_to: list[int | None]
) -> None:
    joined = join_islands(hosts, [Choice("flat"), Choice(None, "border", "outer border")])
    assert [choice.joined_to for choice in joined] == joined_to
    assert [choice.action for choice in joined] == ["flat", None if joined_to[1] is None else "flat"]


@given(measures=HOLES, options=OPTIONS)
def test_loops_of_bridges_are_joined_whatever_else_is_said_of_them(
    measures: list[dict[str, Any]], options: HoleOptions
) -> None:
    holes = [method.Hole(i, np.zeros(4, np.int64), planarity=0.0, **m) for i, m in enumerate(with_all_ids(measures))]
    choices = join_islands([[0]] * 8, choose_holes(holes, options, 10.0))
    ends = {i for pair in options.bridges for i in pair}
    for first, second in options.bridges:
        is_possible = holes[first].is_manifold and holes[second].is_manifold
        for i, other in ((first, second), (second, first)):
            if is_possible:
                assert choices[i] == Choice("model", bridged_to=other)
            else:
                assert choices[i].bridged_to is None
                assert choices[i].code in {"non_manifold_rim", None}
    assert all(choice.bridged_to is None for i, choice in enumerate(choices) if i not in ends)
    assert all(choice.joined_to not in ends for choice in choices if choice.joined_to is not None)
