import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.fairing import THIN_PLATE, Energy, FairingEquations, fair, triangles_around
from quadpatch.filling.laplacian import Connectivity, cotangent_weights
from quadpatch.types import BoolArray, FloatArray, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, cylinder, open_grid, random_rotation, sphere

VARIATION = Energy(variation=1.0)
BLEND = Energy(plate=1.0, variation=20.0)
MEMBRANE = Energy(membrane=1.0)
STEEP = Energy(membrane=0.1, plate=1.0, slope=2.0)
ENERGIES = {"membrane": MEMBRANE, "plate": THIN_PLATE, "variation": VARIATION, "blend": BLEND, "steep": STEEP}


def within(mesh: TriangleMesh, centre: tuple[float, float, float], radius: float) -> BoolArray:
    return np.asarray(np.linalg.norm(mesh.vertices - np.array(centre), axis=1) < radius)


def dented(mesh: TriangleMesh, free: BoolArray, size: float, seed: int = 0) -> FloatArray:
    """Vertices, the free ones moved about."""
    vertices = mesh.vertices.copy()
    vertices[free] += np.random.default_rng(seed).normal(0, size, (int(free.sum()), 3))
    return vertices


def settled(mesh: TriangleMesh, start: FloatArray, free: BoolArray, energy: Energy) -> FloatArray:
    """Fair again and again: the weights depend on the shape."""
    for _ in range(8):
        start = fair(start, mesh.triangles, free, energy)
    return start


@pytest.mark.parametrize("name", ENERGIES)
def test_a_plane_stays_a_plane(name: str) -> None:
    mesh = bumpy_plate(30, 2.0)
    flat = TriangleMesh(mesh.vertices * [1, 1, 0], mesh.triangles)
    tilted = flat.vertices @ random_rotation(np.random.default_rng(1)).T + [3.0, 2.0, 1.0]
    free = within(flat, (0, 0, 0), 0.5)
    faired = fair(tilted, mesh.triangles, free, ENERGIES[name])
    normal = np.cross(tilted[1] - tilted[0], tilted[900 - 1] - tilted[0])
    normal /= np.linalg.norm(normal)
    assert np.abs((faired - tilted[0]) @ normal).max() < 1e-9


@pytest.mark.parametrize("name", ENERGIES)
def test_fixed_vertices_keep_their_bits_and_inputs_are_left_alone(name: str) -> None:
    mesh = bumpy_plate(30, 2.0)
    free = within(mesh, (0, 0, 0), 0.4)
    start = dented(mesh, free, 0.01)
    before = start.copy()
    faired = fair(start, mesh.triangles, free, ENERGIES[name])
    assert start.tobytes() == before.tobytes()
    assert faired[~free].tobytes() == mesh.vertices[~free].tobytes()
    assert (faired[free] != start[free]).any(axis=1).all()


def test_without_free_vertices_nothing_moves() -> None:
    mesh = bumpy_plate(8, 1.0)
    faired = fair(mesh.vertices, mesh.triangles, np.zeros(64, bool), THIN_PLATE)
    assert faired.tobytes() == mesh.vertices.tobytes()


def test_the_same_input_gives_the_same_bytes() -> None:
    mesh = sphere(4)
    free = within(mesh, (0, 0, 1), 0.5)
    start = dented(mesh, free, 0.01)
    assert fair(start, mesh.triangles, free, BLEND).tobytes() == fair(start, mesh.triangles, free, BLEND).tobytes()


def test_minimum_variation_finds_the_sphere_again_and_the_thin_plate_flattens_it() -> None:
    mesh = sphere(4)
    free = within(mesh, (0, 0, 1), 0.5)
    start = dented(mesh, free, 0.005)
    errors = {
        name: np.abs(np.linalg.norm(settled(mesh, start, free, energy)[free], axis=1) - 1).mean()
        for name, energy in ENERGIES.items()
    }
    assert errors["variation"] < 0.1 * errors["plate"] < 0.1 * errors["membrane"]
    assert errors["plate"] > errors["blend"]
    assert errors["variation"] < 2e-4


def test_minimum_variation_finds_the_cylinder_again() -> None:
    mesh = cylinder(60, 40)
    free = within(mesh, (1, 0, 0), 0.4)
    start = dented(mesh, free, 0.005)
    errors = {
        name: np.abs(np.linalg.norm(settled(mesh, start, free, energy)[free, :2], axis=1) - 1).mean()
        for name, energy in ENERGIES.items()
    }
    assert errors["variation"] < 0.2 * errors["plate"] < 0.2 * errors["membrane"]


def test_the_membrane_on_equal_triangles_is_the_graph_laplacian() -> None:
    # On a right-angled grid, all but flat, the cotangent of the diagonal is zero and all others are equal.
    mesh = open_grid(12)
    free = within(mesh, (0, 0, 0), 3.1)
    start = mesh.vertices.copy()
    start[~free, 2] = 1e-7 * np.sin(mesh.vertices[~free, 0])
    faired = fair(start, mesh.triangles, free, MEMBRANE).reshape(12, 12, 3)
    cross = (faired[:-2, 1:-1] + faired[2:, 1:-1] + faired[1:-1, :-2] + faired[1:-1, 2:]) / 4
    inner = free.reshape(12, 12)[1:-1, 1:-1]
    np.testing.assert_allclose(faired[1:-1, 1:-1][inner][:, 2], cross[inner][:, 2], atol=1e-18)


@given(
    seed=st.integers(0, 2**32 - 1),
    name=st.sampled_from(sorted(ENERGIES)),
    scale=st.sampled_from([1e-3, 1.0, 1e3]),
)
@settings(max_examples=20)
def test_fairing_moves_turns_and_grows_with_the_mesh(seed: int, name: str, scale: float) -> None:
    rng = np.random.default_rng(seed)
    mesh = bumpy_plate(20, 2.0, seed=seed)
    free = within(mesh, (0, 0, 0), 0.5)
    start = dented(mesh, free, 0.01, seed)
    rotation, shift = random_rotation(rng), rng.normal(0, 3 * scale, 3)
    moved = fair(scale * start @ rotation.T + shift, mesh.triangles, free, ENERGIES[name])
    expected = scale * fair(start, mesh.triangles, free, ENERGIES[name]) @ rotation.T + shift
    assert np.abs(moved - expected).max() < 1e-9 * scale


def test_slivers_and_triangles_without_area_leave_the_result_finite() -> None:
    mesh = bumpy_plate(20, 2.0)
    start = mesh.vertices.copy()
    start[210] = start[211]
    start[190] = (start[189] + start[191]) / 2
    free = within(mesh, (0, 0, 0), 0.5)
    for energy in ENERGIES.values():
        assert np.isfinite(fair(start, mesh.triangles, free, energy)).all()


def test_a_uniform_start_untangles_what_has_no_shape_yet() -> None:
    mesh = bumpy_plate(20, 2.0)
    free = within(mesh, (0, 0, 0), 0.6)
    heap = mesh.vertices.copy()
    heap[free] = 0.0
    faired = fair(heap, mesh.triangles, free, THIN_PLATE, uniform=True)
    step = 2.0 / 19
    assert np.linalg.norm(faired[free] - mesh.vertices[free], axis=1).max() < step


@pytest.mark.parametrize("n_rings", [1, 2, 3])
def test_rings_are_counted_by_triangles(n_rings: int) -> None:
    mesh = open_grid(15)
    centre = 7 * 15 + 7
    found = triangles_around(mesh.triangles, np.array([centre]), 225, n_rings)
    assert (np.diff(found) > 0).all()
    reached = {centre}
    expected: set[int] = set()
    for _ in range(n_rings):
        expected = {i for i, t in enumerate(mesh.triangles.tolist()) if reached & set(t)}
        reached |= {vertex for i in expected for vertex in mesh.triangles[i].tolist()}
    assert found.tolist() == sorted(expected)


def test_no_ring_is_no_triangle() -> None:
    assert len(triangles_around(open_grid(4).triangles, np.zeros(0, np.int64), 16, 4)) == 0


def with_sliver(mesh: TriangleMesh, triangle: int, height: float) -> TriangleMesh:
    """Split a triangle, close to one of its edges: the surface stays as it is, and one part has hardly a height."""
    a, b, c = mesh.triangles[triangle]
    foot = 0.45 * mesh.vertices[a] + 0.55 * mesh.vertices[b]
    new = len(mesh.vertices)
    vertices = np.concatenate([mesh.vertices, [foot + height * (mesh.vertices[c] - foot)]])
    parts = np.array([[a, b, new], [b, c, new], [c, a, new]])
    return TriangleMesh(vertices, np.concatenate([np.delete(mesh.triangles, triangle, axis=0), parts]))


# In edges: how far a sliver at the rim may move a fill. Cotangents cut off one by one move it by 2.5 to 69,000.
WORST = {"membrane": 0.1, "plate": 0.3, "variation": 2.2, "blend": 2.2, "steep": 0.5}


@pytest.mark.parametrize("height", [0.0, 1e-17, 1e-12, 1e-9, 1e-6, 1e-4])
@pytest.mark.parametrize("name", ENERGIES)
def test_a_sliver_at_the_rim_does_not_crumple_the_fill(name: str, height: float) -> None:
    mesh = bumpy_plate(20, 2.0)
    free = within(mesh, (0, 0, 0), 0.5)
    worst = 0.0
    plain = fair(mesh.vertices, mesh.triangles, free, ENERGIES[name])
    for triangle in np.flatnonzero(free[mesh.triangles].sum(axis=1) == 1)[::3]:
        # The long edge of the sliver is the rim edge.
        triangles = mesh.triangles.copy()
        triangles[triangle] = np.roll(triangles[triangle], 2 - int(free[triangles[triangle]].argmax()))
        split = with_sliver(TriangleMesh(mesh.vertices, triangles), int(triangle), height)
        faired = fair(split.vertices, split.triangles, np.append(free, False), ENERGIES[name])
        worst = max(worst, float(np.linalg.norm(faired[:-1] - plain, axis=1).max()))
    assert worst < WORST[name] * 2.0 / 19


def test_what_one_shape_is_solved_by_serves_another_in_which_other_links_have_no_weight() -> None:
    # In a flat grid of right triangles the diagonals have the cotangent 0; on a rough one they have not.
    flat = open_grid(9)
    rough = flat.vertices + 0.2 * np.random.default_rng(0).normal(size=flat.vertices.shape)
    free = np.zeros(81, bool)
    free[[10, 20, 30, 40, 42, 60, 70]] = True
    connectivity = Connectivity(flat.triangles, free)
    FairingEquations(flat.vertices, connectivity).minimise(THIN_PLATE)
    for energy in ENERGIES.values():
        found = FairingEquations(rough, connectivity).minimise(energy)
        np.testing.assert_allclose(found, fair(rough, flat.triangles, free, energy), atol=1e-9)


def test_matrices_have_narrow_indices() -> None:
    """Products of them take a third longer with wide ones."""
    mesh = open_grid(6, 1.0)
    connectivity = Connectivity(mesh.triangles, within(mesh, (0, 0, 0), 0.5))
    laplacian = connectivity.laplacian(cotangent_weights(mesh.vertices, mesh.triangles)[0])
    assert laplacian.indices.dtype == laplacian.indptr.dtype == np.int32
