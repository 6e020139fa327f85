import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.height_map import REACH, bin_centres, sample_height_maps
from quadpatch.patches.seeds import Seeds
from quadpatch.types import FloatArray, Patches, TriangleMesh


def surface(height: FloatArray, width: float = 1.0) -> TriangleMesh:
    """Heights (n, n) over the square [-width, width]²."""
    n = len(height)
    x, y = np.meshgrid(np.linspace(-width, width, n), np.linspace(-width, width, n))
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return TriangleMesh(np.stack([x.ravel(), y.ravel(), height.ravel()], axis=1), triangles)


def wave(n: int = 120) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    return surface(0.1 * np.sin(5 * x) * np.cos(4 * y))


def upright(*origins: tuple[float, float, float]) -> Seeds:
    return Seeds(np.array(origins), np.tile(np.eye(3), (len(origins), 1, 1)), np.arange(len(origins)))


def random_seeds(rng: np.random.Generator, n: int) -> Seeds:
    """Frames tilted by up to about 20 degrees, origins near the wave."""
    z = np.column_stack([rng.uniform(-0.25, 0.25, (n, 2)), np.ones(n)])
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    x = np.cross(rng.normal(size=(n, 3)), z)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    origins = np.column_stack([rng.uniform(-0.5, 0.5, (n, 2)), rng.uniform(-0.05, 0.05, n)])
    return Seeds(origins, np.stack([x, np.cross(z, x), z], axis=1), np.arange(n))


def sample(mesh: TriangleMesh, seeds: Seeds, length: float = 0.3, resolution: int = 12) -> Patches:
    nothing = np.zeros(len(mesh.triangles), dtype=bool)
    return sample_height_maps(RayScene(mesh), mesh, nothing, seeds, length, resolution)


def surface_points(patches: Patches) -> FloatArray:
    plane = bin_centres(patches.origins, patches.frames, patches.length, patches.resolution)
    return plane + patches.heights[..., None] * patches.frames[:, None, None, 2]


def random_rotation(rng: np.random.Generator) -> FloatArray:
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.asarray(q * np.sign(np.linalg.det(q)))


def test_a_plane_has_zero_heights_and_every_bin_is_known() -> None:
    patches = sample(surface(np.zeros((30, 30))), upright((0, 0, 0), (0.2, -0.3, 0)))
    assert patches.known.all()
    np.testing.assert_allclose(patches.heights, 0, atol=1e-15)


@given(seed=st.integers(0, 2**32 - 1))
def test_a_tilted_plane_under_its_own_frame_has_zero_heights(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rotation, shift = random_rotation(rng), rng.uniform(-10, 10, 3)
    flat = surface(np.zeros((20, 20)))
    mesh = TriangleMesh(flat.vertices @ rotation + shift, flat.triangles)
    seeds = Seeds(shift[None], rotation[None], np.zeros(1, dtype=np.int64))
    patches = sample(mesh, seeds)
    assert patches.known.all()
    np.testing.assert_allclose(patches.heights, 0, atol=1e-13)


def test_height_is_the_signed_distance_along_z_above_and_below() -> None:
    patches = sample(surface(np.zeros((20, 20))), upright((0, 0, 0.07), (0, 0, -0.04)))
    np.testing.assert_allclose(patches.heights[0], -0.07, atol=1e-14)
    np.testing.assert_allclose(patches.heights[1], 0.04, atol=1e-14)


def test_rows_run_along_y_and_columns_along_x() -> None:
    x, y = np.meshgrid(np.linspace(-1, 1, 41), np.linspace(-1, 1, 41))
    patches = sample(surface(0.1 * x + 0.02 * y), upright((0, 0, 0)), length=0.4, resolution=4)
    steps = 0.1 * (np.arange(4) - 1.5)
    np.testing.assert_allclose(patches.heights[0], 0.1 * steps[None] + 0.02 * steps[:, None], atol=1e-14)


def test_heights_of_a_wave_are_the_analytic_ones_to_the_chords_of_the_mesh() -> None:
    n = 400
    patches = sample(wave(n), upright((0.1, 0.2, 0), (-0.4, 0.1, 0.05)))
    points = bin_centres(patches.origins, patches.frames, 0.3, 12)
    expected = 0.1 * np.sin(5 * points[..., 0]) * np.cos(4 * points[..., 1]) - points[..., 2]
    # A chord of length h misses a curve of second derivative k by k h² / 8; here in two directions.
    chord = 2 / (n - 1)
    np.testing.assert_allclose(patches.heights, expected, atol=0.1 * (5 + 4) ** 2 * chord**2 / 8)


def test_heights_of_a_sphere_cap_are_the_analytic_ones() -> None:
    n = 300
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    radius = 3.0
    patches = sample(surface(np.sqrt(radius**2 - x**2 - y**2)), upright((0, 0, radius)), length=0.8, resolution=16)
    steps = 0.8 * ((np.arange(16) + 0.5) / 16 - 0.5)
    expected = np.sqrt(radius**2 - steps[None] ** 2 - steps[:, None] ** 2) - radius
    np.testing.assert_allclose(patches.heights[0], expected, atol=2 * (2 / n) ** 2 / (8 * radius) * 1.5)


@given(seed=st.integers(0, 2**32 - 1))
def test_surface_points_lie_on_the_triangle_that_was_hit(seed: int) -> None:
    mesh = wave(60)
    patches = sample(mesh, random_seeds(np.random.default_rng(seed), 5))
    points = surface_points(patches)[patches.seen]
    a, b, c = (mesh.vertices[mesh.triangles[patches.triangle[patches.seen], k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    np.testing.assert_allclose(np.einsum("ij,ij->i", points - a, normal), 0, atol=1e-15)
    for start, end in ((a, b), (b, c), (c, a)):
        inside = np.einsum("ij,ij->i", np.cross(end - start, points - start), normal)
        assert (inside >= -1e-6 * np.einsum("ij,ij->i", normal, normal)).all()


@given(seed=st.integers(0, 2**32 - 1))
def test_heights_do_not_change_when_mesh_and_seeds_move_together(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh, seeds = wave(60), random_seeds(rng, 8)
    rotation, shift = random_rotation(rng), rng.uniform(-50, 50, 3)
    here = sample(mesh, seeds)
    there = sample(
        TriangleMesh(mesh.vertices @ rotation + shift, mesh.triangles),
        Seeds(seeds.origins @ rotation + shift, seeds.frames @ rotation, seeds.quad),
    )
    # At an edge, or at the very limit of reach and slope, a ray may see the triangle next door.
    same = here.triangle == there.triangle
    assert same.mean() > 0.99
    np.testing.assert_allclose(there.heights[same], here.heights[same], atol=1e-9)


def test_coordinates_of_a_million_keep_heights_to_a_millionth() -> None:
    mesh, seeds = wave(80), random_seeds(np.random.default_rng(7), 20)
    shift = np.array([1e6, -1e6, 1e6])
    here = sample(mesh, seeds)
    there = sample(
        TriangleMesh(mesh.vertices + shift, mesh.triangles), Seeds(seeds.origins + shift, seeds.frames, seeds.quad)
    )
    np.testing.assert_array_equal(there.seen, here.seen)
    np.testing.assert_allclose(there.heights, here.heights, atol=1e-6)


def test_unknown_bins_are_exactly_those_over_the_invented_triangles() -> None:
    mesh = wave(61)
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    invented = (np.abs(centres[:, :2]) < 0.1).all(axis=1)
    patches = sample_height_maps(
        RayScene(mesh), mesh, invented, upright((0, 0, 0), (0.16, 0, 0), (0.5, 0.5, 0)), 0.48, 24
    )
    points = bin_centres(patches.origins, patches.frames, 0.48, 24)
    # The mesh has grid lines at ±0.1 and the patches have none, so that the invented region is a clear square.
    is_invented = np.asarray((np.abs(points[..., :2]) < 0.1).all(axis=-1))
    assert patches.seen.all()
    np.testing.assert_array_equal(patches.known, ~is_invented)
    assert is_invented[0].any()
    assert not is_invented[2].any()


def test_bins_over_a_gap_see_nothing_and_have_height_zero() -> None:
    mesh = wave(61)
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    gap = (np.abs(centres[:, :2]) < 0.1).all(axis=1)
    patches = sample(TriangleMesh(mesh.vertices, mesh.triangles[~gap]), upright((0, 0, 0)), 0.48, 24)
    points = bin_centres(patches.origins, patches.frames, 0.48, 24)
    over_gap = (np.abs(points[..., :2]) < 0.1).all(axis=-1)
    np.testing.assert_array_equal(patches.seen, ~over_gap)
    assert not patches.known[over_gap].any()
    assert (patches.triangle[over_gap] == -1).all()
    assert (patches.heights[over_gap] == 0).all()


def test_the_underside_of_a_plate_is_never_seen() -> None:
    top = surface(np.zeros((20, 20)))
    n = len(top.vertices)
    plate = TriangleMesh(
        np.concatenate([top.vertices, top.vertices - [0, 0, 0.02]]),
        np.concatenate([top.triangles, top.triangles[:, ::-1] + n]),
    )
    # The plane of the patch lies below the middle of the plate, so that the underside is nearer.
    patches = sample(plate, upright((0, 0, -0.015)))
    assert (patches.triangle < len(top.triangles)).all()
    np.testing.assert_allclose(patches.heights, 0.015, atol=1e-14)


def test_surfaces_out_of_reach_are_not_seen() -> None:
    flat = surface(np.zeros((20, 20)))
    assert sample(flat, upright((0, 0, 0.99 * REACH * 0.3))).seen.all()
    assert not sample(flat, upright((0, 0, 1.01 * REACH * 0.3))).seen.any()


def test_many_patches_give_the_same_as_each_alone() -> None:
    mesh = wave(60)
    seeds = random_seeds(np.random.default_rng(9), 200)
    together = sample(mesh, seeds, resolution=32)
    for k in (0, 150, 199):
        alone = sample(mesh, Seeds(seeds.origins[k : k + 1], seeds.frames[k : k + 1], seeds.quad[:1]), resolution=32)
        np.testing.assert_array_equal(together.heights[k], alone.heights[0])
        np.testing.assert_array_equal(together.triangle[k], alone.triangle[0])


def test_no_seeds_and_no_triangles_are_fine() -> None:
    empty = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    assert not sample(empty, upright((0, 0, 0))).seen.any()
    none = Seeds(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0, dtype=np.int64))
    assert len(sample(wave(10), none)) == 0
