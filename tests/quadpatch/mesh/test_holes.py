import numpy as np
import pytest

from quadpatch.errors import OptionError
from quadpatch.mesh.holes import Hole, find_holes, select_holes
from quadpatch.mesh.measures import diagonal
from quadpatch.options import HoleOptions, HoleRule
from quadpatch.types import TriangleMesh
from quadpatch_rules.hole_selection import AUTO_DIAMETER_SHARE, HoleKind
from tests.quadpatch.shapes import joined, open_grid, punched


def hole(number: int, perimeter: float, diameter: float, *, is_manifold: bool = True, kind: HoleKind = "hole") -> Hole:
    return Hole(number, np.arange(3), perimeter, diameter, 1.0, 0.0, is_manifold, kind)


HOLES = [hole(0, 40.0, 12.0), hole(1, 9.0, 3.0), hole(2, 8.0, 3.5), hole(3, 2.0, 0.5)]


@pytest.mark.parametrize(
    ("options", "chosen", "skipped"),
    [
        (HoleOptions(), [1, 2, 3], {0: ("too_wide", "diameter 12 is over 10, a quarter of the scan's diagonal")}),
        (
            HoleOptions(max_diameter=3.25),
            [1, 3],
            {
                0: ("too_wide", "diameter 12 is over 3.25, the given maximum"),
                2: ("too_wide", "diameter 3.5 is over 3.25, the given maximum"),
            },
        ),
        (
            HoleOptions(max_perimeter=8.0),
            [2, 3],
            {
                0: ("too_long", "perimeter 40 is over 8, the given maximum"),
                1: ("too_long", "perimeter 9 is over 8, the given maximum"),
            },
        ),
        (
            HoleOptions(all_but_largest=True),
            [1, 2, 3],
            {0: ("largest", "the largest loop is taken for the border of the scan")},
        ),
        (
            HoleOptions(ids=(3, 0)),
            [0, 3],
            dict.fromkeys((1, 2), ("not_chosen", "not among the chosen ids")),
        ),
        (HoleOptions(ids=()), [], dict.fromkeys(range(4), ("not_chosen", "not among the chosen ids"))),
        (HoleOptions(max_diameter=100.0), [0, 1, 2, 3], {}),
    ],
)
def test_every_rule_says_what_it_leaves_open_and_why(
    options: HoleOptions, chosen: list[int], skipped: dict[int, tuple[str, str]]
) -> None:
    selection = select_holes(HOLES, options, 10.0 / AUTO_DIAMETER_SHARE)
    assert [one.id for one in selection.chosen] == chosen
    assert selection.skipped == skipped


def test_rules_add_up() -> None:
    options = HoleOptions(max_diameter=3.25, max_perimeter=8.5, all_but_largest=True, ids=(0, 1, 2))
    selection = select_holes(HOLES, options, 1.0)
    codes = {number: code for number, (code, _) in selection.skipped.items()}
    assert codes == {0: "largest", 1: "too_long", 2: "too_wide", 3: "not_chosen"}


ANY_SIZE = HoleOptions(max_diameter=100.0, max_perimeter=1000.0)
KINDS: tuple[HoleKind, ...] = ("hole", "slit", "open_end", "border")
ONE_OF_EACH = [hole(i, 9.0, 3.0, kind=kind) for i, kind in enumerate(KINDS)]


@pytest.mark.parametrize(
    ("options", "closed"),
    [
        (HoleOptions(), {"hole", "slit"}),
        (HoleOptions(max_diameter=5.0), {"hole", "slit"}),
        (HoleOptions(max_perimeter=50.0), {"hole", "slit"}),
        (HoleOptions(all_but_largest=True), {"slit"}),
        (ANY_SIZE, {"hole", "slit"}),
        (HoleOptions(include_borders=True), {"hole", "slit", "border"}),
        (HoleOptions(max_diameter=5.0, include_borders=True), {"hole", "slit", "border"}),
        (HoleOptions(cap="flat"), {"hole", "slit", "open_end"}),
        (HoleOptions(ids=(2, 3)), {"open_end", "border"}),
        (HoleOptions(ids=(2, 3), max_diameter=2.0), set()),
        (HoleOptions(rules=(HoleRule("smooth"),)), {"hole", "slit"}),
        (HoleOptions(rules=(HoleRule("flat", max_diameter=50.0),)), {"hole", "slit"}),
        (HoleOptions(rules=(HoleRule("flat", kind="open_end"),)), {"hole", "slit", "open_end"}),
        (HoleOptions(rules=(HoleRule("flat", kind="border"),)), {"hole", "slit", "border"}),
        (HoleOptions(rules=(HoleRule("model", ids=(3,)),)), {"hole", "slit", "border"}),
        (HoleOptions(cap="flat", rules=(HoleRule("skip", kind="open_end", ids=(2,)),)), {"hole", "slit"}),
        (HoleOptions(rules=(HoleRule("skip"),)), set()),
    ],
)
def test_borders_and_open_ends_stay_open_unless_asked_for(options: HoleOptions, closed: set[str]) -> None:
    selection = select_holes(ONE_OF_EACH, options, 100.0)
    assert {one.kind for one in selection.chosen} == closed
    assert set(selection.actions) == {one.id for one in selection.chosen}


def test_what_stays_open_by_its_kind_has_a_code_of_its_own() -> None:
    skipped = select_holes(ONE_OF_EACH, ANY_SIZE, 100.0).skipped
    assert {number: code for number, (code, _) in skipped.items()} == {2: "open_end", 3: "border"}


@pytest.mark.parametrize("options", [HoleOptions(), HoleOptions(include_borders=True), HoleOptions(cap="flat")])
def test_the_automatic_limit_is_for_holes_and_borders(options: HoleOptions) -> None:
    # Slits may be as long as the object; open ends that are capped are as wide as it.
    holes = [hole(i, 90.0, 30.0, kind=kind) for i, kind in enumerate(KINDS)]
    skipped = {number: code for number, (code, _) in select_holes(holes, options, 100.0).skipped.items()}
    assert skipped[0] == "too_wide"
    assert skipped[3] == ("too_wide" if options.include_borders else "border")
    assert 1 not in skipped
    assert (2 in skipped) == (options.cap is None)


def test_the_first_rule_that_a_hole_meets_says_how_it_is_closed() -> None:
    rules = (
        HoleRule("skip", ids=(1,)),
        HoleRule("flat", max_diameter=1.0),
        HoleRule("smooth", min_diameter=3.5, max_perimeter=10.0),
        HoleRule("smooth", min_diameter=12.0),
    )
    selection = select_holes(HOLES, HoleOptions(rules=rules), 100.0)
    assert selection.actions == {0: "smooth", 2: "smooth", 3: "flat"}
    assert selection.skipped == {1: ("rule", "rule 1 leaves it open")}


def test_without_a_rule_a_hole_is_closed_by_the_model_and_an_open_end_as_capped() -> None:
    assert select_holes(ONE_OF_EACH, HoleOptions(cap="flat", include_borders=True), 100.0).actions == {
        0: "model",
        1: "model",
        2: "flat",
        3: "model",
    }
    assert select_holes(ONE_OF_EACH, HoleOptions(ids=(2,)), 100.0).actions == {2: "model"}


@pytest.mark.parametrize(
    ("rule", "is_filled"),
    [
        (HoleRule("smooth"), False),
        (HoleRule("smooth", min_diameter=1.0), False),
        (HoleRule("smooth", kind="hole"), False),
        (HoleRule("smooth", max_diameter=20.0), True),
        (HoleRule("smooth", max_perimeter=50.0), True),
        (HoleRule("smooth", ids=(0,)), True),
    ],
)
def test_a_rule_that_says_up_to_which_size_lifts_the_automatic_limit(rule: HoleRule, is_filled: bool) -> None:
    selection = select_holes(HOLES, HoleOptions(rules=(rule,)), 10.0 / AUTO_DIAMETER_SHARE)
    assert (0 in selection.actions) == is_filled


def test_limits_and_ids_hold_beside_rules() -> None:
    rules = (HoleRule("smooth", max_diameter=100.0),)
    selection = select_holes(HOLES, HoleOptions(max_diameter=3.25, ids=(1, 2), rules=rules), 100.0)
    assert selection.actions == {1: "smooth"}
    assert {code for code, _ in selection.skipped.values()} == {"not_chosen", "too_wide"}


@pytest.mark.parametrize("options", [HoleOptions(), HoleOptions(ids=(0,)), HoleOptions(max_diameter=100.0)])
def test_a_rim_that_is_no_manifold_is_never_filled(options: HoleOptions) -> None:
    selection = select_holes([hole(0, 9.0, 3.0, is_manifold=False)], options, 100.0)
    assert selection.chosen == []
    assert selection.skipped[0][0] == "non_manifold_rim"


@pytest.mark.parametrize(("ids", "named"), [((4,), 4), ((0, 9, 7), 7), ((-1,), -1)])
def test_an_unknown_id_is_named(ids: tuple[int, ...], named: int) -> None:
    with pytest.raises(OptionError, match=f"no hole has the id {named}; this mesh has 4 holes"):
        select_holes(HOLES, HoleOptions(ids=ids), 1.0)


def test_the_borders_of_a_sheet_and_of_a_loose_piece_are_no_holes() -> None:
    sheet = punched(open_grid(40), (0, 0, 0), radius=3.2)
    piece = open_grid(5)
    mesh = joined(sheet, TriangleMesh(piece.vertices + np.array([0, 0, 5]), piece.triangles))
    border_edges = sorted(one.n_edges for one in find_holes(mesh) if one.is_border)
    assert border_edges == [16, 156]
    selection = select_holes(find_holes(mesh), HoleOptions(), diagonal(mesh))
    (chosen,) = selection.chosen
    assert not chosen.is_border
    assert {code for code, _ in selection.skipped.values()} == {"border"}


def test_a_mesh_without_holes_gives_an_empty_selection() -> None:
    assert select_holes([], HoleOptions(), 1.0).chosen == []


def test_a_hole_that_would_take_millions_of_vertices_stays_open() -> None:
    loop = np.arange(5000)
    fine = Hole(0, loop, perimeter=5000.0, diameter=1600.0, area=2e6, planarity=0.0, is_manifold=True)
    coarse = Hole(1, loop[:500], perimeter=500.0, diameter=160.0, area=2e4, planarity=0.0, is_manifold=True)
    selection = select_holes([fine, coarse], HoleOptions(ids=(0, 1)), diagonal=1e4)
    assert selection.chosen == [coarse]
    assert selection.skipped[0] == (
        "too_many_vertices",
        "a fill as dense as its rim takes about 2309401 new vertices, over 200000",
    )


def test_an_unknown_id_of_a_rule_is_named() -> None:
    with pytest.raises(OptionError, match="no hole has the id 9"):
        select_holes(HOLES, HoleOptions(rules=(HoleRule("flat", ids=(1, 9)),)), 1.0)
