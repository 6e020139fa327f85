import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.errors import OptionError
from quadpatch.mesh.holes import AUTO_DIAMETER_SHARE, Hole, find_holes, select_holes
from quadpatch.mesh.measures import diagonal
from quadpatch.options import HoleOptions
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import cylinder, joined, open_grid, punched, random_rotation, sphere


def ring(loop: FloatArray, outward: float = 0.2) -> TriangleMesh:
    """A band of triangles around a clockwise loop (n, 3) in space, so that the loop is the rim of a hole."""
    n = len(loop)
    here, after = np.arange(n), np.roll(np.arange(n), -1)
    triangles = np.concatenate([np.stack([here, after, n + here], 1), np.stack([after, n + after, n + here], 1)])
    return TriangleMesh(np.concatenate([loop, loop * (1 + outward)]), triangles)


def circle(n: int, radius: float = 1.0) -> FloatArray:
    angle = -2 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)


def inner_hole(mesh: TriangleMesh) -> Hole:
    return min(find_holes(mesh), key=lambda hole: hole.perimeter)


def hole(number: int, perimeter: float, diameter: float, *, is_manifold: bool = True, is_border: bool = False) -> Hole:
    return Hole(number, np.arange(3), perimeter, diameter, 1.0, 0.0, is_manifold, is_border)


@pytest.mark.parametrize("n", [6, 64, 400, 401, 1000, 5000])
def test_a_circle_has_the_measures_of_its_polygon(n: int) -> None:
    found = inner_hole(ring(circle(n, 2.5)))
    assert found.n_edges == n
    assert found.perimeter == pytest.approx(2.5 * n * 2 * np.sin(np.pi / n), rel=1e-12)
    assert found.area == pytest.approx(2.5**2 * n / 2 * np.sin(2 * np.pi / n), rel=1e-12)
    assert found.diameter == pytest.approx(5.0 if n % 2 == 0 else 5.0 * np.cos(np.pi / n / 2), rel=1e-9)
    assert found.planarity < 1e-15
    assert found.is_manifold
    assert not found.is_border


@given(n=st.integers(3, 900), seed=st.integers(0, 2**32 - 1), flat=st.booleans())
@settings(max_examples=40, deadline=None)
def test_the_diameter_is_the_largest_distance_between_two_vertices(n: int, seed: int, flat: bool) -> None:
    rng = np.random.default_rng(seed)
    loop = circle(n) * rng.uniform(0.5, 2, (n, 1)) * [1.0, 0.3, 1.0]
    loop += np.array([0, 0, 0 if flat else 1]) * rng.normal(0, 0.2, (n, 1))
    loop = loop @ random_rotation(rng)
    apart = max(float(np.linalg.norm(loop - point, axis=1).max()) for point in loop)
    assert inner_hole(ring(loop, 1.0)).diameter == pytest.approx(apart, rel=1e-9)


def test_a_long_loop_whose_every_vertex_is_extreme_is_measured() -> None:
    # On a sphere no vertex of a loop lies inside the others' hull.
    n = 5000
    angle = -2 * np.pi * np.arange(n) / n
    height = 0.3 * np.cos(40 * angle)
    loop = np.stack([np.sqrt(1 - height**2) * np.cos(angle), np.sqrt(1 - height**2) * np.sin(angle), height], axis=1)
    assert inner_hole(ring(loop)).diameter == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize("n_corners", [3, 5])
def test_a_long_flat_loop_of_even_width_is_measured_exactly(n_corners: int) -> None:
    # Arcs around the corners of a polygon, as wide in all directions: only exact corners give the exact width.
    corner = circle(n_corners)
    radius = max(float(np.linalg.norm(corner - point, axis=1).max()) for point in corner)
    arcs = []
    for k in range(n_corners):
        far = [(k + n_corners // 2) % n_corners, (k + n_corners // 2 + 1) % n_corners]
        start, end = (corner[i] - corner[k] for i in far)
        way = np.linspace(0, 1, 200, endpoint=False)[:, None]
        between = (1 - way) * start + way * end
        arcs.append(corner[k] + radius * between / np.linalg.norm(between, axis=1, keepdims=True))
    loop = np.concatenate(arcs)
    apart = max(float(np.linalg.norm(loop - point, axis=1).max()) for point in loop)
    assert inner_hole(ring(loop)).diameter == pytest.approx(apart, rel=1e-12)


def test_a_long_loop_on_a_line_is_as_wide_as_the_line_is_long() -> None:
    n = 500
    line = np.column_stack([np.abs(np.arange(n) - n / 2), np.zeros((n, 2))]) @ random_rotation(np.random.default_rng(0))
    found = inner_hole(ring(line + np.array([0, 0, 1]), 0.0))
    assert found.diameter == pytest.approx(n / 2)
    assert found.area == pytest.approx(0, abs=1e-9)


def test_planarity_is_the_distance_from_the_best_plane_in_diameters() -> None:
    n = 64
    saddle = circle(n) + np.stack([np.zeros(n), np.zeros(n), 0.2 * np.cos(4 * np.pi * np.arange(n) / n)], axis=1)
    found = inner_hole(ring(saddle))
    assert found.planarity == pytest.approx(0.2 / np.sqrt(2) / 2, rel=0.03)
    assert found.area == pytest.approx(n / 2 * np.sin(2 * np.pi / n), rel=1e-12)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20, deadline=None)
def test_measures_move_with_the_mesh(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = punched(sphere(3), (0, 0, 1), (0, -0.9, 0.4), radius=0.4)
    moved = TriangleMesh(mesh.vertices @ random_rotation(rng).T + rng.normal(0, 10, 3), mesh.triangles)
    for before, after in zip(find_holes(mesh), find_holes(moved), strict=True):
        assert (before.loop == after.loop).all()
        assert before.is_border == after.is_border
        for name in ("perimeter", "diameter", "area", "planarity"):
            assert getattr(after, name) == pytest.approx(getattr(before, name), rel=1e-9, abs=1e-12)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20, deadline=None)
def test_an_open_end_of_a_tube_is_no_border_however_it_is_turned(seed: int) -> None:
    # Normals at its rim all but cancel out: what is left of them must decide nothing.
    rng = np.random.default_rng(seed)
    tube = cylinder(24, 12)
    tube.vertices[:, :2] *= 1 + 0.05 * tube.vertices[:, 2:] ** 2
    turned = TriangleMesh(tube.vertices @ random_rotation(rng).T + rng.normal(0, 10, 3), tube.triangles)
    assert [found.is_border for found in find_holes(turned)] == [False, False]


def test_ids_count_up_from_the_longest_perimeter() -> None:
    mesh = punched(open_grid(30), (-8, -8, 0), (8, -8, 0), (8, 8, 0), radius=1.2)
    mesh = punched(mesh, (-8, 8, 0), radius=3.2)
    found = find_holes(mesh)
    assert [one.id for one in found] == list(range(5))
    perimeters = [one.perimeter for one in found]
    assert perimeters == sorted(perimeters, reverse=True)
    # Equal ones stand in the order of their first vertex.
    assert int(found[2].loop[0]) < int(found[3].loop[0]) < int(found[4].loop[0])


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


def test_closed_meshes_have_no_holes() -> None:
    assert find_holes(sphere(1)) == []
    assert select_holes([], HoleOptions(), 1.0).chosen == []


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


def test_borders_are_left_open_by_the_automatic_rule_only() -> None:
    holes = [hole(0, 9.0, 3.0, is_border=True)]
    assert select_holes(holes, HoleOptions(), 100.0).skipped[0][0] == "border"
    assert select_holes(holes, HoleOptions(ids=(0,)), 100.0).chosen == holes
    assert select_holes(holes, HoleOptions(max_diameter=5.0), 100.0).chosen == holes


@pytest.mark.parametrize("options", [HoleOptions(), HoleOptions(ids=(0,)), HoleOptions(max_diameter=100.0)])
def test_a_rim_that_is_no_manifold_is_never_filled(options: HoleOptions) -> None:
    selection = select_holes([hole(0, 9.0, 3.0, is_manifold=False)], options, 100.0)
    assert selection.chosen == []
    assert selection.skipped[0][0] == "non_manifold_rim"


@pytest.mark.parametrize(("ids", "named"), [((4,), 4), ((0, 9, 7), 7), ((-1,), -1)])
def test_an_unknown_id_is_named(ids: tuple[int, ...], named: int) -> None:
    with pytest.raises(OptionError, match=f"no hole has the id {named}; this mesh has 4 holes"):
        select_holes(HOLES, HoleOptions(ids=ids), 1.0)


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
