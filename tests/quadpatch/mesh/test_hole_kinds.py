"""Slits are never borders, ends of tubes are told apart, and real holes stay holes.

Also tests `quadpatch.mesh.slits`.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.holes import find_holes, select_holes
from quadpatch.mesh.measures import diagonal
from quadpatch.options import HoleOptions
from quadpatch.types import BoolArray, FloatArray, TriangleMesh
from tests.quadpatch.mesh.chimneys import plate_with_chimneys
from tests.quadpatch.shapes import bumpy_plate, cylinder, joined, open_grid, punched, random_rotation, sphere

SEEDS = st.integers(0, 2**32 - 1)


def kinds(mesh: TriangleMesh) -> list[str]:
    return [found.kind for found in find_holes(mesh)]


def moved(mesh: TriangleMesh, seed: int) -> TriangleMesh:
    rng = np.random.default_rng(seed)
    return TriangleMesh(mesh.vertices @ random_rotation(rng).T + rng.normal(0, 10, 3), mesh.triangles)


def noisy(mesh: TriangleMesh, size: float, seed: int) -> TriangleMesh:
    rng = np.random.default_rng(seed)
    return TriangleMesh(mesh.vertices + rng.normal(0, size, mesh.vertices.shape), mesh.triangles)


def without(mesh: TriangleMesh, lost: BoolArray) -> TriangleMesh:
    """Remove triangles with a lost vertex."""
    return TriangleMesh(mesh.vertices, mesh.triangles[~lost[mesh.triangles].any(axis=1)])


def slit_sheet(n: int, reach: float, width: float = 0.0) -> TriangleMesh:
    """Cut a square sheet of 2 x 2 along y = 0 for x in -reach..reach, and bend it open to a width."""
    sheet = open_grid(n, 2.0)
    x, y = sheet.vertices[:, 0], sheet.vertices[:, 1]
    on_cut = np.flatnonzero((np.abs(y) < 1e-9) & (np.abs(x) < reach - 1e-9))
    copy = np.arange(n * n)
    copy[on_cut] = n * n + np.arange(len(on_cut))
    above = sheet.vertices[sheet.triangles][:, :, 1].mean(axis=1) > 0
    triangles = np.where(above[:, None], copy[sheet.triangles], sheet.triangles)
    vertices = np.concatenate([sheet.vertices, sheet.vertices[on_cut]])
    opened = width / 2 * (1 - (x[on_cut] / reach) ** 2)
    vertices[on_cut, 1] -= opened
    vertices[n * n :, 1] += opened
    return TriangleMesh(vertices, triangles)


def rolled(mesh: TriangleMesh, radius: float) -> TriangleMesh:
    x, y, z = mesh.vertices.T
    return TriangleMesh(
        np.stack([(radius + z) * np.sin(x / radius), y, (radius + z) * np.cos(x / radius)], axis=1), mesh.triangles
    )


def t_junctions(mesh: TriangleMesh, n_split: int, seed: int) -> TriangleMesh:
    """Split an edge in the middle for one of its two faces only, again and again."""
    rng = np.random.default_rng(seed)
    vertices, triangles = [mesh.vertices], mesh.triangles.copy()
    split, touched = 0, np.zeros(len(mesh.vertices), bool)
    for row in rng.permutation(len(mesh.triangles)):
        a, b, c = mesh.triangles[row]
        if split == n_split or touched[[a, b, c]].any():
            continue
        touched[[a, b, c]] = True
        new = len(mesh.vertices) + split
        vertices.append((mesh.vertices[a] + mesh.vertices[b])[None] / 2)
        triangles[row] = a, new, c
        triangles = np.concatenate([triangles, [[new, b, c]]])
        split += 1
    return TriangleMesh(np.concatenate(vertices), triangles)


@given(seed=SEEDS, noise=st.sampled_from([0.0, 1e-7, 1e-4]))
@settings(max_examples=30)
def test_t_junctions_are_slits(seed: int, noise: float) -> None:
    mesh = moved(noisy(t_junctions(sphere(2), 12, seed), noise, seed), seed)
    assert kinds(mesh) == ["slit"] * 12


@pytest.mark.parametrize("reach", [0.5, 0.95])
@pytest.mark.parametrize("width", [0.0, 1e-9, 0.005, 0.02])
@pytest.mark.parametrize("bend", [None, 0.8, 3.0])
def test_a_cut_is_a_slit_and_chosen_also_as_long_as_the_object(reach: float, width: float, bend: float | None) -> None:
    mesh = slit_sheet(41, reach, width)
    mesh = moved(rolled(mesh, bend) if bend else mesh, 1)
    holes = find_holes(mesh)
    assert sorted(found.kind for found in holes) == ["border", "slit"]
    assert [found.kind for found in select_holes(holes, HoleOptions(), diagonal(mesh)).chosen] == ["slit"]


def test_a_slit_with_a_longer_rim_than_the_border_is_still_no_border() -> None:
    # A saw-tooth cut: its rim is longer than the outer border of the sheet.
    sheet = slit_sheet(121, 0.95)
    x, y = sheet.vertices[:, 0], sheet.vertices[:, 1]
    zigzag = 0.25 * np.abs((x * 10) % 2 - 1) * np.clip(1 - np.abs(y), 0, 1)
    mesh = TriangleMesh(sheet.vertices + np.stack([0 * x, zigzag, 0 * x], axis=1), sheet.triangles)
    assert kinds(mesh) == ["border", "slit"] or kinds(mesh) == ["slit", "border"]


def test_a_cut_is_told_from_a_hole_by_its_width() -> None:
    # A fifth of its length: a hole.
    assert sorted(kinds(slit_sheet(41, 0.5, 0.2))) == ["border", "hole"]


def taco(gap_degrees: float) -> TriangleMesh:
    """Fold a sheet along a line until its halves almost touch."""
    sheet = open_grid(21, 2.0)
    x, y, _ = sheet.vertices.T
    angle = np.radians(gap_degrees / 2)
    return TriangleMesh(np.stack([np.abs(x) * np.cos(angle), y, x * np.sin(angle)], axis=1), sheet.triangles)


def strip(n: int, width: float) -> TriangleMesh:
    """A band of two rows of triangles, 2 long."""
    x = np.linspace(-1, 1, n)
    rows = [np.stack([x, np.full(n, y), np.zeros(n)], axis=1) for y in (-width / 2, width / 2)]
    i = np.arange(n - 1)
    return TriangleMesh(
        np.concatenate(rows), np.concatenate([np.stack([i, i + 1, n + i], 1), np.stack([i + 1, n + i + 1, n + i], 1)])
    )


def open_seam(gap: float) -> TriangleMesh:
    """A sheet rolled to a tube whose sides all but meet."""
    sheet = open_grid(41, 2.0)
    radius = 2.0 / (2 * np.pi - gap)
    return rolled(TriangleMesh(sheet.vertices * [1, 2, 1], sheet.triangles), radius)


FLAKES = {
    "sheet": open_grid(9, 1.0),
    "taco": taco(30),
    "closed taco": taco(0.5),
    "strip": strip(40, 0.05),
    "narrow strip": strip(400, 0.004),
    "bent strip": rolled(strip(100, 0.02), 0.5),
    "folded strip": TriangleMesh(taco(2).vertices * [1, 0.03, 1], taco(2).triangles),
    "open seam": open_seam(0.05),
    "triangle": TriangleMesh(np.eye(3), np.array([[0, 1, 2]])),
    "needle": TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 0.002, 0]]), np.array([[0, 1, 2]])),
}


@pytest.mark.parametrize("name", FLAKES)
@pytest.mark.parametrize("options", [HoleOptions(), HoleOptions(max_diameter=50.0), HoleOptions(max_perimeter=500.0)])
def test_the_border_of_a_loose_flake_is_a_border(name: str, options: HoleOptions) -> None:
    flake = FLAKES[name]
    mesh = joined(sphere(2, 4.0), TriangleMesh(flake.vertices + np.array([9.0, 0, 0]), flake.triangles))
    holes = find_holes(mesh)
    assert [found.kind for found in holes] == ["border"]
    selection = select_holes(holes, options, diagonal(mesh))
    assert selection.skipped[0][0] == "border"


@given(seed=SEEDS)
@settings(max_examples=15)
def test_a_ragged_border_is_no_slit(seed: int) -> None:
    mesh = bumpy_plate(60, 2.0, seed)
    lost = np.random.default_rng(seed).random(len(mesh.vertices)) < 0.5
    ragged = without(mesh, lost & (np.abs(mesh.vertices[:, :2]).max(axis=1) > 0.75))
    assert kinds(ragged)[0] == "border"


@given(seed=SEEDS, n_around=st.integers(8, 60), length=st.floats(0.2, 20.0))
@settings(max_examples=30)
def test_both_ends_of_a_tube_are_open_ends(seed: int, n_around: int, length: float) -> None:
    angle = 2 * np.pi * np.arange(n_around) / n_around
    tube = extruded(np.stack([np.cos(angle), np.sin(angle)], axis=1), length, 0.9)
    assert kinds(moved(tube, seed)) == ["open_end", "open_end"]


@given(seed=SEEDS, n_around=st.integers(24, 160))
@settings(max_examples=30)
def test_noise_of_one_percent_leaves_an_open_end(seed: int, n_around: int) -> None:
    # Down to faces that are smaller than the noise.
    tube = noisy(cylinder(n_around, n_around, 1.0, 4.0), 0.02 * 0.5, seed)
    assert kinds(tube) == ["open_end", "open_end"]
    rough = noisy(cylinder(n_around, n_around, 1.0, 4.0), 0.02, seed)
    assert kinds(rough).count("open_end") == 2


def extruded(outline: FloatArray, height: float = 1.0, top: float = 1.0) -> TriangleMesh:
    """A wall of ten rings over a counter-clockwise outline (n, 2), scaled towards the top."""
    n, n_rings = len(outline), 10
    levels = np.linspace(0, 1, n_rings)
    scale = (1 + (top - 1) * levels)[:, None, None]
    rings = np.concatenate([outline * scale, np.broadcast_to(height * levels[:, None, None], (n_rings, n, 1))], axis=2)
    i = np.arange(n)
    walls = [
        part
        for k in range(n_rings - 1)
        for here, after in [(k * n + i, k * n + np.roll(i, -1))]
        for part in (np.stack([here, after, here + n], 1), np.stack([after, after + n, here + n], 1))
    ]
    return TriangleMesh(rings.reshape(-1, 3), np.concatenate(walls))


def star(n: int, inner: float) -> FloatArray:
    angle = 2 * np.pi * np.arange(n) / n
    radius = 1 - (1 - inner) * (0.5 + 0.5 * np.cos(5 * angle))
    return np.asarray(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


@pytest.mark.parametrize("inner", [1.0, 0.6, 0.3])
@pytest.mark.parametrize("top", [1.0, 0.6, 1.4])
def test_ends_of_walls_of_any_outline_are_open_ends(inner: float, top: float) -> None:
    assert kinds(extruded(star(100, inner), 1.5, top)) == ["open_end", "open_end"]


@pytest.mark.parametrize("height", [-0.7, -0.3, 0.0, 0.3, 0.6])
def test_a_cut_off_base_is_an_open_end(height: float) -> None:
    ball = sphere(4)
    assert kinds(moved(without(ball, ball.vertices[:, 2] < height), 2)) == ["open_end"]


@pytest.mark.parametrize("height", [0.8, 0.9, 0.97])
def test_a_hole_in_a_ball_is_a_hole(height: float) -> None:
    ball = sphere(4)
    assert kinds(without(ball, ball.vertices[:, 2] > height)) == ["hole"]


@given(seed=SEEDS)
@settings(max_examples=20)
def test_a_ragged_hole_at_the_tip_of_a_finger_is_a_hole(seed: int) -> None:
    rng = np.random.default_rng(seed)
    ball = sphere(4)
    x, y, z = ball.vertices.T
    angle = np.arctan2(y, x)
    depth = sum(rng.uniform(0.1, 0.2) * np.sin(k * angle + rng.uniform(0, 6)) for k in (1, 2, 3))
    finger = TriangleMesh(ball.vertices * [1, 1, 4], ball.triangles)
    assert kinds(without(finger, z > 0.7 + 0.5 * depth)) == ["hole"]


def test_a_hole_in_the_side_of_a_tube_or_in_a_wall_is_a_hole() -> None:
    tube = cylinder(48, 40, 1.0, 5.0)
    assert sorted(kinds(punched(tube, (1, 0, 0), radius=0.4))) == ["hole", "open_end", "open_end"]
    box = extruded(star(100, 1.0), 1.5)
    assert sorted(kinds(punched(box, (1, 0, 0.7), radius=0.3))) == ["hole", "open_end", "open_end"]


def test_an_end_that_its_piece_reaches_beyond_does_not_end_the_object() -> None:
    tube = cylinder(24, 12)
    spike = TriangleMesh(
        np.concatenate([tube.vertices, [[3.0, 0.0, 9.0]]]),
        np.concatenate([tube.triangles, [[1, 0, len(tube.vertices)]]]),
    )
    assert kinds(spike).count("open_end") == 0


def test_many_ends_of_one_piece_are_all_found() -> None:
    # Forty chimneys on one plate, more than are compared with every vertex of it.

    found = kinds(plate_with_chimneys(5, 8))
    assert found.count("open_end") == 40


def test_a_sheet_with_a_hole_longer_than_its_border_keeps_both_apart() -> None:
    sheet = bumpy_plate(80, 2.0)
    x, y, _ = sheet.vertices.T
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    mesh = without(sheet, radius < 0.55 + 0.25 * np.sin(7 * angle))
    holes = find_holes(mesh)
    assert [found.kind for found in holes] == ["border", "hole"]
    assert holes[0].perimeter < holes[1].perimeter
