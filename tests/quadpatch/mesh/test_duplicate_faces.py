"""Faces that repeat others: left out where the surface is whole without them, and nowhere else."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.duplicate_faces import repeated_triangles, with_same_corners
from quadpatch.mesh.weld import Weld, weld
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles
from tests.quadpatch.shapes import bumpy_plate, is_oriented_manifold, joined, open_grid, punched, sphere

BALL = punched(sphere(3), (0, 0, 1), (0, 0.8, -0.6), radius=0.3)


def same_surface(welded: Weld, mesh: TriangleMesh) -> bool:
    """Whether both have the same triangles, as sets of three positions, and the same rims."""
    return corners(welded.mesh) == corners(mesh) and rims(welded.mesh) == rims(mesh)


def corners(mesh: TriangleMesh) -> set[frozenset[tuple[float, ...]]]:
    return {frozenset(map(tuple, t)) for t in mesh.vertices[mesh.triangles].tolist()}


def rims(mesh: TriangleMesh) -> list[tuple[list[list[float]], bool]]:
    boundary = boundary_loops(mesh.triangles)
    found = [sorted(mesh.vertices[loop].tolist()) for loop in boundary.loops]
    return sorted(zip(found, boundary.is_manifold, strict=True))


def soup(mesh: TriangleMesh) -> TriangleMesh:
    """Give every triangle vertices of its own."""
    return TriangleMesh(mesh.vertices[mesh.triangles.ravel()], np.arange(mesh.triangles.size).reshape(-1, 3))


def flipped(triangles: Triangles, *, chosen: IntArray | slice = slice(None)) -> Triangles:
    result = triangles.copy()
    result[chosen] = result[chosen][:, ::-1]
    return result


@pytest.mark.parametrize("n_copies", [1, 2])
@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("has_own_vertices", [False, True])
def test_a_surface_that_is_doubled_as_a_whole_is_taken_once(
    n_copies: int, direction: int, has_own_vertices: bool
) -> None:
    copy = TriangleMesh(BALL.vertices, BALL.triangles[:, ::direction])
    whole = joined(BALL, *[copy] * n_copies)
    n = len(BALL.triangles)
    if not has_own_vertices:
        whole = TriangleMesh(BALL.vertices, np.concatenate([BALL.triangles, *[copy.triangles] * n_copies]))
    welded = weld(whole.vertices, whole.triangles)
    assert same_surface(welded, BALL)
    assert welded.counts.duplicate_triangles == n_copies * n
    assert is_oriented_manifold(welded.mesh.triangles)
    assert corners(TriangleMesh(welded.mesh.vertices, welded.ignored_triangles)) == corners(BALL)


@given(seed=st.integers(0, 1000), share=st.sampled_from([0.02, 0.5, 0.9]), own=st.booleans(), flat=st.booleans())
def test_any_part_may_be_doubled_in_any_order(seed: int, share: float, own: bool, flat: bool) -> None:
    rng = np.random.default_rng(seed)
    mesh = punched(bumpy_plate(12, 2.0), (0, 0, 0), radius=0.4) if flat else BALL
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    # The part is what lies below a plane: its copy ends in the middle of the surface.
    direction = rng.normal(size=3)
    below = middles @ direction <= np.quantile(middles @ direction, share)
    part = TriangleMesh(mesh.vertices, mesh.triangles[below])
    both = joined(mesh, part) if own else TriangleMesh(mesh.vertices, np.concatenate([mesh.triangles, part.triangles]))
    welded = weld(both.vertices, rng.permutation(both.triangles))
    assert same_surface(welded, TriangleMesh(mesh.vertices, mesh.triangles))
    assert welded.counts.duplicate_triangles == below.sum()


@pytest.mark.parametrize("as_soup", [False, True])
def test_single_faces_repeated_at_a_rim_leave_its_hole_sound(as_soup: bool) -> None:
    loops = boundary_loops(BALL.triangles).loops
    at_rim = np.flatnonzero(np.isin(BALL.triangles, loops[0]).sum(axis=1) == 2)[:3]
    faces = np.concatenate([BALL.triangles, flipped(BALL.triangles[at_rim], chosen=np.array([1]))])
    mesh = TriangleMesh(BALL.vertices, faces)
    welded = weld(*vars(soup(mesh) if as_soup else mesh).values())
    assert same_surface(welded, BALL)
    assert welded.counts.duplicate_triangles == 3


def box(corner: tuple[float, float, float]) -> TriangleMesh:
    """A closed cube of unit edges, every face cut along a diagonal through one of two corners."""
    bits = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)], np.float64)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    rows = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return TriangleMesh(bits + np.array(corner), np.array(rows))


def mirrored(mesh: TriangleMesh) -> TriangleMesh:
    """The mirror image in the plane x = 1, closed and facing outwards."""
    return TriangleMesh(mesh.vertices * [-1, 1, 1] + [2, 0, 0], mesh.triangles[:, ::-1])


@pytest.mark.parametrize("is_open", [False, True])
def test_two_solids_that_touch_keep_the_wall_between_them(is_open: bool) -> None:
    left = box((0, 0, 0))
    both = joined(left, mirrored(left))
    assert len(with_same_corners(places(both)[both.triangles])[0]) > 0
    kept = np.ones(24, dtype=bool)
    if is_open:
        kept[0] = False
    welded = weld(both.vertices, both.triangles[kept])
    assert welded.counts.duplicate_triangles == 0
    boundary = boundary_loops(welded.mesh.triangles)
    assert [len(loop) for loop in boundary.loops] == [3] * is_open
    assert all(boundary.is_manifold)


def places(mesh: TriangleMesh) -> IntArray:
    return np.unique(mesh.vertices, axis=0, return_inverse=True)[1].reshape(-1)


def test_a_mesh_without_repetition_comes_back_as_it_was() -> None:
    mesh = open_grid(7)
    assert not repeated_triangles(mesh.triangles, np.arange(49)).any()
    assert not repeated_triangles(mesh.triangles[:0], np.arange(49)).any()


@given(seed=st.integers(0, 1000), n=st.integers(1, 40))
def test_the_first_of_equal_triangles_is_found_in_any_direction(seed: int, n: int) -> None:
    rows = np.random.default_rng(seed).integers(0, 4, (n, 3))
    again, found = with_same_corners(rows)
    first = np.arange(n)
    first[again] = found
    for i, row in enumerate(rows.tolist()):
        same = [j for j in range(i + 1) if sorted(rows[j].tolist()) == sorted(row)]
        assert first[i] == (same[0] if len(set(row)) == 3 else i)


def test_a_doubled_surface_with_noise_is_taken_once() -> None:
    mesh = soup(BALL)
    rng = np.random.default_rng(0)
    copies = [_noisy(mesh.vertices, rng) for _ in range(2)]
    whole = joined(*(TriangleMesh(vertices, mesh.triangles) for vertices in copies))
    welded = weld(whole.vertices, whole.triangles, "auto")
    assert len(welded.mesh.triangles) == len(BALL.triangles) == welded.counts.duplicate_triangles
    rims_of = [sorted(map(len, boundary_loops(m.triangles).loops)) for m in (welded.mesh, BALL)]
    assert rims_of[0] == rims_of[1]


def _noisy(vertices: FloatArray, rng: np.random.Generator) -> FloatArray:
    single = vertices.astype(np.float32)
    moved = np.nextafter(single, rng.choice(np.array([-9, 0, 9], np.float32), single.shape))
    return np.where(rng.random(single.shape) < 0.5, single, moved).astype(np.float64)
