from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.connectivity import Connectivity, bilinear, vertices_in_balls, vertices_in_patches
from quadpatch.patches.height_map import bin_centres, sample_height_maps
from quadpatch.patches.seeds import Seeds
from quadpatch.types import BoolArray, FloatArray, Patches, TriangleMesh

LENGTH = 0.5
RESOLUTION = 10


def wave(n: int = 60) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    heights = 0.1 * np.sin(3 * x) * np.cos(2 * y)
    return TriangleMesh(np.stack([x.ravel(), y.ravel(), heights.ravel()], axis=1), triangles)


def upright_seeds(rng: np.random.Generator, n: int) -> Seeds:
    angle = rng.uniform(0, 2 * np.pi, n)
    zero, one = np.zeros(n), np.ones(n)
    rows = [[np.cos(angle), np.sin(angle), zero], [-np.sin(angle), np.cos(angle), zero], [zero, zero, one]]
    origins = np.column_stack([rng.uniform(-0.9, 0.9, (n, 2)), rng.uniform(-0.1, 0.1, n)])
    return Seeds(origins, np.moveaxis(np.array(rows), 2, 0), np.arange(n))


def patches_of(mesh: TriangleMesh, seeds: Seeds) -> Patches:
    measured = np.zeros(len(mesh.triangles), dtype=bool)
    return sample_height_maps(RayScene(mesh), mesh, measured, seeds, LENGTH, RESOLUTION)


def connect(mesh: TriangleMesh, patches: Patches) -> Connectivity:
    return vertices_in_patches(mesh.vertices, vertex_normals(mesh.vertices, mesh.triangles), patches)


def local(mesh: TriangleMesh, patches: Patches) -> FloatArray:
    """Place (n_patches, n_vertices, 3) of every vertex in every frame."""
    return np.asarray(np.einsum("pij,pvj->pvi", patches.frames, mesh.vertices[None] - patches.origins[:, None]))


@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_vertex_is_in_exactly_the_patches_whose_square_it_lies_over(seed: int) -> None:
    mesh = wave()
    patches = patches_of(mesh, upright_seeds(np.random.default_rng(seed), 30))
    found = connect(mesh, patches)
    shown = np.zeros((30, len(mesh.vertices)), dtype=bool)
    shown[found.patch, found.vertex] = True
    # The wave is one flat layer, so nothing but the square decides; at the rim of the mesh bins see nothing.
    is_inner = np.abs(mesh.vertices[:, :2]).max(axis=1) < 1 - LENGTH / RESOLUTION
    over = np.asarray((np.abs(local(mesh, patches)[:, :, :2]) <= LENGTH / 2).all(axis=2))
    np.testing.assert_array_equal(shown[:, is_inner], over[:, is_inner])
    assert not shown[~over].any()


@settings(max_examples=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_reading_heights_back_returns_the_vertices(seed: int) -> None:
    mesh = wave()
    patches = patches_of(mesh, upright_seeds(np.random.default_rng(seed), 10))
    found = connect(mesh, patches)
    height = bilinear(patches.heights, found, patches.seen)
    expected = local(mesh, patches)[found.patch, found.vertex, 2]
    inner = (np.abs([found.row, found.column] - np.array((RESOLUTION - 1) / 2)) <= (RESOLUTION - 1) / 2).all(axis=0)
    whole = bilinear(patches.seen.astype(float), found) == 1
    np.testing.assert_allclose(height[inner & whole], expected[inner & whole], atol=2e-3)


def test_rows_and_columns_point_at_bin_centres() -> None:
    mesh = wave()
    seeds = upright_seeds(np.random.default_rng(1), 3)
    patches = patches_of(mesh, Seeds(seeds.origins * [0.5, 0.5, 0], seeds.frames, seeds.quad))
    plane = bin_centres(patches.origins, patches.frames, LENGTH, RESOLUTION)
    points = plane + patches.heights[..., None] * patches.frames[:, None, None, 2]
    found = vertices_in_patches(points[1].reshape(-1, 3), np.tile([0.0, 0, 1], (RESOLUTION**2, 1)), patches)
    own = found.patch == 1
    row, column = np.divmod(found.vertex[own], RESOLUTION)
    assert own.sum() == RESOLUTION**2
    np.testing.assert_allclose(found.row[own], row, atol=1e-9)
    np.testing.assert_allclose(found.column[own], column, atol=1e-9)


def flat_patch(height: float = 0.0, seen: BoolArray | None = None) -> Patches:
    shape = (1, RESOLUTION, RESOLUTION)
    is_seen = np.ones(shape, dtype=bool) if seen is None else seen[None]
    return Patches(
        np.zeros((1, 3)), np.eye(3)[None], LENGTH, np.full(shape, height), is_seen, is_seen, np.where(is_seen, 0, -1)
    )


@pytest.mark.parametrize(("offset", "is_shown"), [(0.0, True), (0.9, True), (-0.9, True), (1.1, False), (-1.1, False)])
def test_a_vertex_farther_than_a_bin_from_the_surface_is_not_shown(offset: float, is_shown: bool) -> None:
    point = np.array([[0.01, 0.02, 0.1 + offset * LENGTH / RESOLUTION]])
    found = vertices_in_patches(point, np.array([[0.0, 0, 1]]), flat_patch(height=0.1))
    assert (len(found.vertex) == 1) is is_shown


@pytest.mark.parametrize("normal", [(0, 0, -1), (1, 0, 0), (0, 0, 0)])
def test_a_vertex_that_looks_away_is_not_shown(normal: tuple[float, float, float]) -> None:
    assert len(vertices_in_patches(np.zeros((1, 3)), np.array([normal], dtype=float), flat_patch()).vertex) == 0


def test_a_vertex_over_bins_that_saw_nothing_is_not_shown() -> None:
    seen = np.ones((RESOLUTION, RESOLUTION), dtype=bool)
    seen[:, :5] = False
    points = np.array([[-0.15, 0, 0], [0.15, 0, 0]])
    found = vertices_in_patches(points, np.tile([0.0, 0, 1], (2, 1)), flat_patch(seen=seen))
    assert found.vertex.tolist() == [1]


def test_pairs_are_sorted_by_vertex_then_patch() -> None:
    mesh = wave()
    found = connect(mesh, patches_of(mesh, upright_seeds(np.random.default_rng(2), 40)))
    order = np.lexsort((found.patch, found.vertex))
    np.testing.assert_array_equal(order, np.arange(len(order)))


def test_bilinear_is_exact_for_a_linear_map_and_constant_beyond_the_outer_centres() -> None:
    rows, columns = np.indices((4, 4))
    maps = (2.0 * rows - 3.0 * columns + 1)[None]
    nowhere = np.zeros(3, dtype=np.int64)
    inside = Connectivity(nowhere, nowhere, np.array([0.0, 1.25, 3.0]), np.array([0.5, 2.75, 3.0]))
    np.testing.assert_allclose(bilinear(maps, inside), 2 * inside.row - 3 * inside.column + 1)
    outside = Connectivity(nowhere, nowhere, np.array([-0.5, 3.5, 1.0]), np.array([0.0, 3.0, 3.5]))
    np.testing.assert_allclose(bilinear(maps, outside), [1, -2, -6])


def test_bilinear_leaves_out_bins_that_do_not_count() -> None:
    maps = np.array([[[1.0, 5.0], [1.0, 1e9]]])
    seen = np.array([[[True, True], [True, False]]])
    zero = np.zeros(2, dtype=np.int64)
    places = Connectivity(zero, zero, np.array([0.5, 1.0]), np.array([0.5, 1.0]))
    values = bilinear(maps, places, seen)
    assert values[0] == pytest.approx(7 / 3)
    assert np.isnan(values[1])


def test_without_patches_or_vertices_there_are_no_pairs() -> None:
    mesh = wave(10)
    no_seeds = Seeds(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0, dtype=np.int64))
    assert len(connect(mesh, patches_of(mesh, no_seeds)).vertex) == 0
    assert len(vertices_in_patches(np.zeros((0, 3)), np.zeros((0, 3)), flat_patch()).vertex) == 0


def test_the_papers_connectivity_asks_for_the_ball_and_the_square_and_for_no_surface() -> None:
    mesh = wave()
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    seen = patches_of(mesh, upright_seeds(np.random.default_rng(0), 30))
    blind = replace(seen, seen=np.zeros_like(seen.seen), known=np.zeros_like(seen.known))
    found = vertices_in_balls(mesh.vertices, normals, blind)
    held = np.zeros((30, len(mesh.vertices)), dtype=bool)
    held[found.patch, found.vertex] = True
    places = local(mesh, seen)
    in_ball = np.linalg.norm(places, axis=2) <= LENGTH * np.sqrt(0.5)
    np.testing.assert_array_equal(held, (np.abs(places[:, :, :2]) <= LENGTH / 2).all(axis=2) & in_ball)
    assert (np.diff(found.vertex) >= 0).all()


def test_a_ball_holds_no_vertex_of_the_back_of_a_wall() -> None:
    mesh = wave()
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    patches = patches_of(mesh, upright_seeds(np.random.default_rng(0), 5))
    assert len(vertices_in_balls(mesh.vertices, -normals, patches).vertex) == 0
    assert len(vertices_in_balls(np.zeros((0, 3)), np.zeros((0, 3)), patches).vertex) == 0
