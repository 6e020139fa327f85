import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.filling.flat_cap import flat_caps
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.shapes import cylinder, is_oriented_manifold, joined, random_rotation

SEEDS = st.integers(0, 2**32 - 1)


def wall(outline: FloatArray, height: float = 1.0) -> TriangleMesh:
    """One ring of faces over a counter-clockwise outline (n, 2), normals outwards."""
    n = len(outline)
    i, after = np.arange(n), np.roll(np.arange(n), -1)
    vertices = np.concatenate([np.column_stack([outline, np.full(n, z)]) for z in (0.0, height)])
    return TriangleMesh(
        vertices, np.concatenate([np.stack([i, after, i + n], 1), np.stack([after, after + n, i + n], 1)])
    )


def circle(n: int, radius: float = 1.0) -> FloatArray:
    angle = 2 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def polygon_area(outline: FloatArray) -> float:
    x, y = outline.T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


def capped(mesh: TriangleMesh) -> FilledMesh:
    return flat_caps(mesh, [[loop] for loop in boundary_loops(mesh.triangles).loops])


def new_triangles(filled: FilledMesh) -> FloatArray:
    return filled.mesh.vertices[filled.mesh.triangles[filled.n_measured_triangles :]]


def area_vectors(corners: FloatArray) -> FloatArray:
    return np.asarray(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2)


def volume(mesh: TriangleMesh) -> float:
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def angles(corners: FloatArray) -> FloatArray:
    found = []
    for k in range(3):
        u, v = corners[:, k - 1] - corners[:, k], corners[:, k - 2] - corners[:, k]
        found.append(np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), np.einsum("ij,ij->i", u, v)))
    return np.asarray(np.degrees(np.stack(found, axis=1)))


@pytest.mark.parametrize("n", [3, 4, 5, 8, 24, 48, 130])
def test_a_capped_tube_is_closed_with_the_volume_of_its_prism(n: int) -> None:
    tube = wall(circle(n), 4.0)
    filled = capped(tube)
    assert filled.unfilled == []
    assert is_oriented_manifold(filled.mesh.triangles)
    assert boundary_loops(filled.mesh.triangles).loops == []
    assert volume(filled.mesh) == pytest.approx(4.0 * polygon_area(circle(n)), rel=1e-12)
    assert (filled.mesh.vertices[: len(tube.vertices)] == tube.vertices).all()
    assert (filled.mesh.triangles[: len(tube.triangles)] == tube.triangles).all()


@given(seed=SEEDS, n=st.integers(6, 100))
@settings(max_examples=10)
def test_a_round_cap_has_well_shaped_triangles_about_as_large_as_its_rim_is_dense(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    tube = cylinder(n, 6)
    turned = TriangleMesh(tube.vertices @ random_rotation(rng).T + rng.normal(0, 100, 3), tube.triangles)
    filled = capped(turned)
    corners = new_triangles(filled)
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    rim = 2 * np.sin(np.pi / n)
    # Of 951 random rims, 6 to 100 edges long, the worst had 15.9 degrees and edges of 0.22 and 1.57 of the rim's.
    assert angles(corners).min() > 10
    assert sides.max() < 2.0 * rim
    assert sides.min() > 0.15 * rim


def star(seed: int) -> FloatArray:
    """An outline with deep bays, its vertices unevenly spaced."""
    rng = np.random.default_rng(seed)
    n, n_tips = int(rng.integers(30, 150)), int(rng.integers(2, 7))
    angle = np.sort(rng.uniform(0, 2 * np.pi, n) * 0.3 + 0.7 * 2 * np.pi * np.arange(n) / n)
    radius = 1 - rng.uniform(0.2, 0.8) * (0.5 + 0.5 * np.cos(n_tips * angle))
    return np.asarray(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


@given(seed=SEEDS)
@settings(max_examples=15)
def test_a_cap_has_the_area_of_its_outline_and_never_folds(seed: int) -> None:
    outline = star(seed)
    rng = np.random.default_rng(seed)
    mesh = wall(outline)
    turn, shift = random_rotation(rng), rng.normal(0, 10, 3)
    filled = capped(TriangleMesh(mesh.vertices @ turn.T + shift, mesh.triangles))
    assert filled.unfilled == []
    assert is_oriented_manifold(filled.mesh.triangles)
    corners = (new_triangles(filled) - shift) @ turn
    for cap, (facing, height) in {0: (-1, 0.0), 1: (1, 1.0)}.items():
        part = corners[filled.triangle_hole == cap]
        vectors = area_vectors(part)
        assert np.abs(part[:, :, 2] - height).max() < 1e-12
        # All of them face outwards, so areas add up only where none overlaps another.
        assert (facing * vectors[:, 2]).min() > -1e-12
        assert facing * vectors[:, 2].sum() == pytest.approx(polygon_area(outline), rel=1e-9)


def test_straight_sides_with_many_vertices_are_capped() -> None:
    side = np.linspace(0, 1, 20, endpoint=False)
    square = np.concatenate(
        [
            np.column_stack(rows)
            for rows in ((side, 0 * side), (1 + 0 * side, side), (1 - side, 1 + 0 * side), (0 * side, 1 - side))
        ]
    )
    filled = capped(wall(square))
    corners = new_triangles(filled)
    assert np.linalg.norm(area_vectors(corners), axis=1).sum() == pytest.approx(2.0)
    assert angles(corners).min() > 15


def test_a_thick_walled_pipe_gets_rings() -> None:
    outer, inner = wall(circle(60)), wall(circle(40, 0.6))
    pipe = joined(outer, TriangleMesh(inner.vertices, inner.triangles[:, ::-1]))
    bottom, top, inner_bottom, inner_top = boundary_loops(pipe.triangles).loops
    filled = flat_caps(pipe, [[bottom, inner_bottom], [top, inner_top]])
    assert filled.unfilled == []
    assert is_oriented_manifold(filled.mesh.triangles)
    assert boundary_loops(filled.mesh.triangles).loops == []
    assert volume(filled.mesh) == pytest.approx(polygon_area(circle(60)) - polygon_area(circle(40, 0.6)), rel=1e-12)
    assert angles(new_triangles(filled)).min() > 20


def test_no_chord_gives_an_edge_of_the_rim_a_third_face() -> None:
    # A face that cuts off every second corner of the rim: the edge under it would be the cap's own.
    n = 12
    tube = wall(circle(n))
    ears = np.array([[n + i, n + (i + 1) % n, n + (i + 2) % n] for i in range(0, n, 2)])
    flat = TriangleMesh(tube.vertices, np.concatenate([tube.triangles, ears]))
    filled = capped(flat)
    assert filled.unfilled == []
    assert is_oriented_manifold(filled.mesh.triangles)


def test_an_edge_across_the_rim_is_not_used_again() -> None:
    # Two walls that meet in one edge, whose ends lie on the rim of both: it is a chord of neither.
    tube = wall(circle(16))
    apex = np.array([[0.0, 0.0, 0.5]])
    across = np.array([[16, 24, 32]])
    mesh = TriangleMesh(np.concatenate([tube.vertices, apex]), np.concatenate([tube.triangles, across]))
    loops = [loop for loop in boundary_loops(tube.triangles).loops if loop.min() >= 16]
    filled = flat_caps(mesh, [loops])
    edges = np.sort(filled.mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert ((edges == [16, 24]).all(axis=1)).sum() == 1


@pytest.mark.parametrize("noise", [0.001, 0.02])
def test_a_rim_that_is_not_quite_flat_is_capped_by_a_plane(noise: float) -> None:
    tube = cylinder(48, 12)
    rough = TriangleMesh(tube.vertices + np.random.default_rng(0).normal(0, noise, tube.vertices.shape), tube.triangles)
    filled = capped(rough)
    assert is_oriented_manifold(filled.mesh.triangles)
    added = filled.mesh.vertices[filled.n_measured_vertices :][filled.vertex_hole == 0]
    assert np.linalg.svd(added - added.mean(axis=0), compute_uv=False)[-1] < 1e-12
    assert volume(filled.mesh) == pytest.approx(4.0 * np.pi, rel=0.05)


@pytest.mark.parametrize(
    "outline",
    [
        np.array([[0.0, 0], [1, 1], [1, 0], [0, 1.5]]),
        np.array([[0.0, 0], [1, 0], [2, 0], [1.5, 0]]),
    ],
    ids=["crosses itself", "no area"],
)
def test_a_rim_without_an_inside_is_left_open(outline: FloatArray) -> None:
    tube = wall(outline)
    filled = capped(tube)
    assert filled.unfilled == [0, 1]
    assert (filled.mesh.triangles == tube.triangles).all()


@pytest.mark.parametrize("scale", [1e-12, 1e12])
def test_caps_scale_with_the_mesh(scale: float) -> None:
    tube = wall(star(3))
    one, scaled = capped(tube), capped(TriangleMesh(tube.vertices * scale, tube.triangles))
    assert len(one.mesh.triangles) == pytest.approx(len(scaled.mesh.triangles), rel=0.05)
    assert is_oriented_manifold(scaled.mesh.triangles)
    assert volume(scaled.mesh) == pytest.approx(volume(one.mesh) * scale**3)


def test_no_caps_change_nothing() -> None:
    tube = cylinder(8, 3)
    filled = flat_caps(tube, [])
    assert (filled.mesh.triangles == tube.triangles).all()
    assert len(filled.vertex_hole) == len(filled.disagreement) == 0
