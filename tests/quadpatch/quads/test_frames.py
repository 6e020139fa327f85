import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from quadpatch.quads.frames import quad_frames, quad_normals
from quadpatch.types import FloatArray, Frames, IntArray, QuadMesh, Quads

seeds = st.integers(0, 2**32 - 1)


def grid_quads(n: int, m: int, *, wrap: bool = False) -> Quads:
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    down, right = (i + 1) % n if wrap else i + 1, (j + 1) % m if wrap else j + 1
    width = m if wrap else m + 1
    corners = [i * width + j, i * width + right, down * width + right, down * width + j]
    return np.stack(corners, axis=-1).reshape(-1, 4)


def torus(n: int, m: int) -> QuadMesh:
    u, v = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    radius = 3 + np.cos(v)
    vertices = np.stack([radius * np.cos(u), radius * np.sin(u), np.sin(v)], axis=-1).reshape(-1, 3)
    return QuadMesh(vertices, grid_quads(n, m, wrap=True)[:, ::-1])


def shuffled(quad_mesh: QuadMesh, seed: int) -> tuple[QuadMesh, IntArray]:
    """Reorder the quads and start each at a random corner."""
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(quad_mesh.quads))
    start = rng.integers(0, 4, len(order))
    quads = np.stack([np.roll(quad, -s) for quad, s in zip(quad_mesh.quads[order], start, strict=True)])
    return QuadMesh(quad_mesh.vertices, quads), order


def random_rotation(rng: np.random.Generator) -> FloatArray:
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.asarray(q * np.sign(np.linalg.det(q)))


def assert_orthonormal_and_right_handed(frames: Frames) -> None:
    identity = np.broadcast_to(np.eye(3), frames.shape)
    np.testing.assert_allclose(np.einsum("nij,nkj->nik", frames, frames), identity, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(frames), 1, atol=1e-12)


@given(
    n=st.integers(1, 5),
    m=st.integers(1, 5),
    seed=seeds,
    scale=st.sampled_from([1e-9, 1.0, 1e9]),
    noise=st.sampled_from([0.0, 0.3, 5.0]),
)
def test_frames_are_orthonormal_and_right_handed(n: int, m: int, seed: int, scale: float, noise: float) -> None:
    rng = np.random.default_rng(seed)
    i, j = np.meshgrid(np.arange(n + 1.0), np.arange(m + 1.0), indexing="ij")
    vertices = np.stack([i, j, 0 * i], axis=-1).reshape(-1, 3) + noise * rng.normal(size=((n + 1) * (m + 1), 3))
    assert_orthonormal_and_right_handed(quad_frames(QuadMesh(scale * vertices, grid_quads(n, m))))


@given(
    vertices=arrays(np.float64, (8, 3), elements=st.floats(-2, 2)),
    quads=arrays(np.int64, (6, 4), elements=st.integers(0, 7)),
)
def test_frames_are_orthonormal_even_on_degenerate_quads(vertices: FloatArray, quads: Quads) -> None:
    assert_orthonormal_and_right_handed(quad_frames(QuadMesh(vertices, quads)))


@given(seed=seeds)
def test_z_is_the_normal_of_the_quad(seed: int) -> None:
    quad_mesh, _ = shuffled(torus(9, 7), seed)
    normals = quad_normals(quad_mesh.vertices, quad_mesh.quads)
    z = quad_frames(quad_mesh)[:, 2]
    np.testing.assert_allclose(z, normals / np.linalg.norm(normals, axis=1, keepdims=True), atol=1e-12)


@given(seed=seeds)
def test_x_runs_along_a_side_of_a_rectangle(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rotation = random_rotation(rng)
    width, height = rng.uniform(0.5, 2, size=2)
    corners = np.array([[0, 0, 0], [width, 0, 0], [width, height, 0], [0, height, 0]]) @ rotation
    frames = quad_frames(QuadMesh(corners, np.array([[0, 1, 2, 3]])))
    np.testing.assert_allclose(frames[0], rotation, atol=1e-12)


@given(seed=seeds)
def test_frames_turn_with_the_mesh(seed: int) -> None:
    rng = np.random.default_rng(seed)
    quad_mesh, _ = shuffled(torus(12, 8), seed)
    rotation, shift = random_rotation(rng), rng.uniform(-1e3, 1e3, 3)
    moved = quad_frames(QuadMesh(quad_mesh.vertices @ rotation.T + shift, quad_mesh.quads))
    np.testing.assert_allclose(moved, quad_frames(quad_mesh) @ rotation.T, atol=1e-9)


@given(n=st.integers(10, 24), m=st.integers(8, 16), seed=seeds)
def test_frames_never_jump_on_a_torus(n: int, m: int, seed: int) -> None:
    # A torus of quads has no irregular vertex, so that a frame consistent everywhere exists. Neighbours around the
    # hole differ by 360 / n degrees, which must stay clear of the 45 where the nearest quarter turn is a toss-up.
    quad_mesh, order = shuffled(torus(n, m), seed)
    frames = np.zeros((n * m, 3, 3))
    frames[order] = quad_frames(quad_mesh)
    grid = frames.reshape(n, m, 3, 3)
    for axis in (0, 1):
        # The surface turns by at most 45 degrees from quad to quad; a jump would be a quarter turn on top.
        agreement = np.einsum("ijk,ijk->ij", grid[:, :, 0], np.roll(grid, 1, axis=axis)[:, :, 0])
        assert (agreement > 0.6).all()


def test_frames_agree_over_a_right_angled_edge() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [0, 1, 1]], dtype=float)
    frames = quad_frames(QuadMesh(vertices, np.array([[0, 1, 2, 3], [3, 5, 4, 0]])))
    np.testing.assert_allclose(frames[0], np.eye(3), atol=1e-12)
    # Folded up at the edge along y, the second quad keeps y; its x runs down the wall and on along the floor.
    np.testing.assert_allclose(frames[1], [[0, 0, -1], [0, 1, 0], [1, 0, 0]], atol=1e-12)


def test_separate_pieces_each_get_frames() -> None:
    one = torus(6, 6)
    two = QuadMesh(
        np.concatenate([one.vertices, one.vertices + 100]), np.concatenate([one.quads, one.quads + len(one.vertices)])
    )
    frames = quad_frames(two)
    np.testing.assert_allclose(frames[36:], frames[:36], atol=1e-12)


def test_no_quads_give_no_frames() -> None:
    assert quad_frames(QuadMesh(np.zeros((0, 3)), np.zeros((0, 4), dtype=np.int64))).shape == (0, 3, 3)
