"""What a plan says of each loop is what the repair does with it, islands among them."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jobkit.settings import Settings
from quadpatch.inpainters.paper_dictionary import SelfHeights
from quadpatch.options import DictionaryOptions, HoleOptions, HoleRule, RepairOptions
from quadpatch.recipes.default import inpaint
from quadpatch.recipes.paper import inpaint_as_paper
from quadpatch.recipes.result import HoleResult
from quadpatch.repair import inspect_file
from quadpatch.types import TriangleMesh
from quadpatch_client.schema import JobSpec, Plan, ResolvedModel
from service.plan import make_plan
from tests.quadpatch.filling.gaps import cut_torus
from tests.quadpatch.shapes import flipped, joined, moved, open_grid, plate_with_window, write_ply
from worker.facts import mesh_facts

MODEL = ResolvedModel(requested="smooth", kind="none")
# Holes and islands in one another: a wide window with a ring in it, whose window has room for an island.
WIDE, RING = plate_with_window(13, 1), plate_with_window(7, 1)
ISLANDS = {"flat": open_grid(2), "flipped": flipped(open_grid(2)), "ring": RING}
PLACES = st.tuples(st.sampled_from([-4.0, 0.0, 4.0]), st.sampled_from([0.0, 0.2, 9.0]))
IDS = st.lists(st.integers(0, 2), min_size=1, max_size=3, unique=True).map(tuple)
RULES = st.builds(HoleRule, st.sampled_from(["skip", "smooth", "flat"]), st.none() | IDS)
OPTIONS = st.builds(
    HoleOptions,
    max_diameter=st.sampled_from([None, 7.0, 60.0]),
    ids=st.none() | IDS,
    include_borders=st.booleans(),
    rules=st.lists(RULES, max_size=2).map(tuple),
)


def plan_of(mesh: TriangleMesh, options: HoleOptions, folder: Path, method: dict[str, Any]) -> Plan:
    facts = mesh_facts(inspect_file(write_ply(folder / "scan.ply", mesh)))
    spec = JobSpec.model_validate_json(
        JobSpec.model_validate({"mesh_id": "0" * 64, "method": method})
        .model_copy(update={"holes": asdict(options)})
        .model_dump_json(warnings=False)
    )
    return make_plan(spec, facts, MODEL, Settings())


def assert_agree(plan: Plan, results: list[HoleResult]) -> None:
    assert [hole.id for hole in plan.holes] == [result.hole.id for result in results]
    for planned, done in zip(plan.holes, results, strict=True):
        assert planned.selected == (done.verdict != "skipped")
        assert planned.reason == (done.code if done.verdict == "skipped" else None)
        assert (planned.joined_to is not None) == done.reason.startswith("an island in hole ")
        assert (planned.action is not None) == planned.selected
        if planned.joined_to is not None:
            host = results[planned.joined_to]
            assert done.reason.startswith(f"an island in hole {host.hole.id}")
            assert (done.verdict == "refused") == (host.verdict == "refused")
            assert planned.action == plan.holes[planned.joined_to].action


@pytest.mark.parametrize("ids", [None, (0,)])
def test_an_island_is_planned_as_joined_whatever_else_is_chosen(tmp_path: Path, ids: tuple[int, ...] | None) -> None:
    mesh = joined(WIDE, moved(open_grid(2), (1.0, 0.0, 0.0)))
    facts = inspect_file(write_ply(tmp_path / "scan.ply", mesh))
    (window,) = [hole["id"] for hole in facts["holes"] if hole["kind"] == "hole"]
    (island,) = [hole["id"] for hole in facts["holes"] if hole["lies_in"]]
    options = HoleOptions(max_diameter=60.0, ids=None if ids is None else (window,))
    plan = plan_of(mesh, options, tmp_path, {"method": "smooth"})
    assert plan.holes[island].lies_in == [window]
    assert (plan.holes[island].selected, plan.holes[island].joined_to, plan.holes[island].action) == (
        True,
        window,
        "model",
    )
    assert plan.selected == 2
    assert_agree(plan, inpaint(mesh, None, RepairOptions(options)).results)


@given(
    islands=st.lists(st.tuples(st.sampled_from(sorted(ISLANDS)), PLACES), min_size=1, max_size=3),
    options=OPTIONS,
)
@settings(max_examples=6)
def test_plan_and_repair_say_the_same_of_each_loop(
    islands: list[tuple[str, tuple[float, float]]], options: HoleOptions, tmp_path_factory: pytest.TempPathFactory
) -> None:
    # Beside the grid: vertices in one place would be joined in the file.
    pieces = [moved(ISLANDS[name], (x, 0.3 + 0.04 * i, z)) for i, (name, (x, z)) in enumerate(islands)]
    mesh = joined(WIDE, *pieces)
    plan = plan_of(mesh, options, tmp_path_factory.mktemp("mesh"), {"method": "smooth"})
    assert_agree(plan, inpaint(mesh, None, RepairOptions(options)).results)


def test_the_recipe_of_the_paper_knows_no_islands_and_so_does_its_plan(tmp_path: Path) -> None:
    mesh = joined(plate_with_window(13, 4), moved(open_grid(2), (0.3, 0.0, 0.0)))
    options = HoleOptions(max_diameter=60.0)
    method = {"method": "dictionary", "model": "self", "recipe": "paper"}
    plan = plan_of(mesh, options, tmp_path, method)
    assert [hole.joined_to for hole in plan.holes] == [None] * 3
    assert any(hole.lies_in for hole in plan.holes)
    done = inpaint_as_paper(mesh, SelfHeights(DictionaryOptions()), RepairOptions(options, recipe="paper"))
    assert_agree(plan, done.results)


def test_the_border_of_an_island_in_two_holes_lies_in_the_narrower_one_first(tmp_path: Path) -> None:
    mesh = joined(WIDE, RING, moved(open_grid(2), (0.5, 0.0, 0.0)))
    holes = inspect_file(write_ply(tmp_path / "scan.ply", mesh))["holes"]
    diameters = [[round(holes[i]["diameter"]) for i in hole["lies_in"]] for hole in holes if hole["lies_in"]]
    assert diameters == [[14], [6, 14]]
    assert np.all([hole["kind"] == "border" for hole in holes if hole["lies_in"]])


def test_a_plan_lists_bridges_that_are_proposed_and_joins_those_that_are_asked_for(tmp_path: Path) -> None:
    gap = cut_torus(n_around=90)
    asked, other = gap.pairs
    for pairs in ((), (asked[::-1],), ((asked[0], other[0]),)):
        options = HoleOptions(bridges=pairs, include_borders=False)
        plan = plan_of(gap.mesh, options, tmp_path, {"method": "smooth"})
        assert {tuple(bridge.holes) for bridge in plan.bridges if bridge.is_proposed} == {asked, other}
        assert [set(bridge.holes) for bridge in plan.bridges if bridge.selected] == [set(pair) for pair in pairs]
        for bridge in plan.bridges:
            assert (bridge.gap is not None) == (bridge.share is not None) == bridge.is_proposed
        assert [(hole.id, hole.bridged_to) for hole in plan.holes if hole.bridged_to is not None] == sorted(
            [*pairs, *(pair[::-1] for pair in pairs)]
        )
        results = inpaint(gap.mesh, None, RepairOptions(options)).results
        assert [hole.selected for hole in plan.holes] == [result.verdict != "skipped" for result in results]


def test_facts_of_earlier_versions_have_no_proposals(tmp_path: Path) -> None:
    facts = inspect_file(write_ply(tmp_path / "scan.ply", cut_torus(n_around=90).mesh))
    assert len(mesh_facts(facts).bridges) == 2
    assert mesh_facts({name: value for name, value in facts.items() if name != "bridges"}).bridges == []
