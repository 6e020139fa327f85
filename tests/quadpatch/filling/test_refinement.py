"""Also tests `quadpatch/filling/edge_flips.py`."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quadpatch.filling.refinement import Refined, flip_to_delaunay, refine, relax
from quadpatch.filling.triangulation import EdgeSet, Forbidden, triangulate_loops
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.normals import area_vectors, vertex_normals
from quadpatch.mesh.topology import directed_edges
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices
from tests.quadpatch.shapes import (
    bumpy_plate,
    cylinder,
    euler_characteristic,
    faces_per_edge,
    is_oriented_manifold,
    open_grid,
    punched,
    sphere,
)

NOTHING = EdgeSet(np.zeros((0, 2), np.int64))


def coarse(mesh: TriangleMesh, n_holes: int = 1) -> tuple[Refined, EdgeSet]:
    """The shortest loops of a mesh, triangulated; wanted spacing everywhere that of the mesh."""
    loops = sorted(boundary_loops(mesh.triangles).loops, key=len)[:n_holes]
    existing_edges = EdgeSet(directed_edges(mesh.triangles))
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    flat = triangulate_loops(loops, mesh.vertices, [normals[loop] for loop in loops], Forbidden(existing_edges))
    found = [triangles for triangles in flat if triangles is not None]
    assert len(found) == n_holes
    hole = np.repeat(np.arange(n_holes), [len(triangles) for triangles in found])
    spacing = np.full(len(mesh.vertices), mean_length(mesh.vertices, mesh.triangles))
    return Refined(mesh.vertices, np.concatenate(found), hole, spacing, len(mesh.vertices)), existing_edges


def edge_lengths(vertices: Vertices, triangles: Triangles) -> FloatArray:
    edges = np.unique(np.sort(directed_edges(triangles), axis=1), axis=0)
    return np.asarray(np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1))


def mean_length(vertices: Vertices, triangles: Triangles) -> float:
    return float(edge_lengths(vertices, triangles).mean())


def angles_across(vertices: Vertices, triangles: Triangles) -> FloatArray:
    """Sum of the two angles that face each interior edge, in radians."""
    total: dict[frozenset[int], list[float]] = {}
    for triangle in triangles.tolist():
        for k in range(3):
            a, b, apex = triangle[k], triangle[k - 2], triangle[k - 1]
            u, v = vertices[a] - vertices[apex], vertices[b] - vertices[apex]
            cosine = u @ v / np.sqrt((u @ u) * (v @ v))
            total.setdefault(frozenset((a, b)), []).append(float(np.arccos(np.clip(cosine, -1, 1))))
    return np.array([sum(pair) for pair in total.values() if len(pair) == 2])


MESHES = {
    "plane": punched(open_grid(21, 2.0), (0, 0, 0), radius=0.52),
    "plate": punched(bumpy_plate(25, 2.0), (0.1, 0.1, 0), radius=0.5),
    "sphere": punched(sphere(4), (0, 0, 1), radius=0.5),
    "cylinder": punched(cylinder(60, 50), (1, 0, 0), radius=0.5),
    "cylinder's end": cylinder(60, 30),
}


@pytest.mark.parametrize("name", MESHES)
def test_refinement_adds_vertices_and_leaves_everything_else_as_it_was(name: str) -> None:
    mesh = MESHES[name]
    patch, existing_edges = coarse(mesh)
    fine = refine(patch, existing_edges)
    assert fine.n_measured == len(mesh.vertices)
    assert fine.vertices[: fine.n_measured].tobytes() == mesh.vertices.tobytes()
    assert fine.is_new.sum() == len(fine.vertices) - len(mesh.vertices) > 0
    assert np.isin(np.flatnonzero(fine.is_new), fine.triangles).all()
    assert (fine.hole == 0).all()
    before, after = (np.concatenate([mesh.triangles, part.triangles]) for part in (patch, fine))
    assert is_oriented_manifold(after)
    assert euler_characteristic(after) == euler_characteristic(before)
    assert sorted(len(loop) for loop in boundary_loops(fine.triangles).loops) == [len(np.unique(patch.triangles))]


@pytest.mark.parametrize("name", MESHES)
def test_edges_of_the_fill_are_a_little_shorter_than_those_around_it(name: str) -> None:
    mesh = MESHES[name]
    patch, existing_edges = coarse(mesh)
    fine = refine(patch, existing_edges)
    wanted = mean_length(mesh.vertices, mesh.triangles)
    lengths = edge_lengths(fine.vertices, fine.triangles)
    assert 0.55 * wanted < np.median(lengths) < 1.0 * wanted
    assert lengths.max() < 2.5 * wanted
    assert np.percentile(lengths, 5) > 0.2 * wanted
    assert lengths.min() > 0.1 * wanted


@pytest.mark.parametrize("name", ["plane", "sphere"])
def test_one_to_two_times_as_many_vertices_come_back_as_were_lost(name: str) -> None:
    mesh = MESHES[name]
    lost = len(mesh.vertices) - len(np.unique(mesh.triangles))
    patch, existing_edges = coarse(mesh)
    assert lost < refine(patch, existing_edges).is_new.sum() < 2 * lost


def test_a_flat_fill_is_delaunay_when_it_is_done() -> None:
    patch, existing_edges = coarse(punched(bumpy_plate(25, 2.0), (0.1, 0.1, 0), radius=0.5))
    flat = Refined(patch.vertices * [1, 1, 0], patch.triangles, patch.hole, patch.spacing, patch.n_measured)
    fine = refine(flat, existing_edges)
    assert angles_across(fine.vertices, fine.triangles).max() <= np.pi + 1e-7
    assert (area_vectors(fine.vertices, fine.triangles)[:, 2] > 0).all()


@pytest.mark.parametrize("name", MESHES)
def test_no_edge_is_left_that_could_be_flipped(name: str) -> None:
    patch, existing_edges = coarse(MESHES[name])
    rng = np.random.default_rng(0)
    fine = refine(patch, existing_edges)
    shaken = fine.vertices + np.where(fine.is_new[:, None], rng.normal(0, 0.02, fine.vertices.shape), 0.0)
    flipped = flip_to_delaunay(replace(fine, vertices=shaken), existing_edges)
    assert (flipped.triangles != fine.triangles).any()
    # The second time, all edges are looked at again.
    again = flip_to_delaunay(flipped, existing_edges)
    np.testing.assert_array_equal(again.triangles, flipped.triangles)


def test_a_fill_that_is_fine_enough_gets_no_vertex() -> None:
    patch, existing_edges = coarse(punched(open_grid(9), (0, 0, 0), radius=0.5))
    patch = replace(patch, spacing=2 * patch.spacing)
    assert len(refine(patch, existing_edges).vertices) == len(patch.vertices)


def test_no_triangle_at_all_stays_none() -> None:
    nothing = Refined(np.zeros((3, 3)), np.zeros((0, 3), np.int64), np.zeros(0, np.int64), np.zeros(3), 3)
    assert len(refine(nothing, NOTHING).triangles) == 0
    assert len(relax(nothing, np.array([[0, 1, 2]]), NOTHING).triangles) == 0


def test_holes_are_refined_together_as_they_are_alone() -> None:
    mesh = punched(bumpy_plate(40, 2.0), (-0.5, -0.5, 0.0), (0.5, 0.4, 0.05), radius=0.3)
    both, existing_edges = coarse(mesh, 2)
    together = refine(both, existing_edges)
    for hole in range(2):
        alone = both.triangles[both.hole == hole]
        fine = refine(
            Refined(both.vertices, alone, np.zeros(len(alone), np.int64), both.spacing, both.n_measured), existing_edges
        )
        corners = together.vertices[together.triangles[together.hole == hole]]
        assert canonical(corners) == canonical(fine.vertices[fine.triangles])


def canonical(corners: FloatArray) -> list[list[list[float]]]:
    """Triangles (m, 3, 3) by their corners, whatever the order."""
    return sorted(sorted(triangle) for triangle in corners.tolist())


@given(n=st.integers(4, 30), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_flipping_keeps_the_rim_and_never_doubles_an_edge(n: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle = -2 * np.pi * (np.arange(n) + rng.uniform(-0.4, 0.4, n)) / n
    vertices = np.stack([np.cos(angle), np.sin(angle), rng.normal(0, 0.3, n)], axis=1) * rng.uniform(0.4, 1, (n, 1))
    patch = Refined(vertices, fan(np.arange(n)), np.zeros(n - 2, np.int64), np.zeros(n), n)
    flipped = flip_to_delaunay(patch, NOTHING)
    assert is_oriented_manifold(flipped.triangles)
    assert euler_characteristic(flipped.triangles) == 1
    (before,), (after,) = (boundary_loops(part.triangles).loops for part in (patch, flipped))
    assert before.tolist() == after.tolist()


def fan(loop: IntArray) -> Triangles:
    """Close a loop by triangles that all meet in its first vertex."""
    return np.stack([np.full(len(loop) - 2, loop[0]), loop[2:], loop[1:-1]], axis=1)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_flipping_uses_no_edge_that_is_taken(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = 16
    angle = -2 * np.pi * np.arange(n) / n
    vertices = np.stack([2 * np.cos(angle), np.sin(angle), np.zeros(n)], axis=1) + rng.normal(0, 0.05, (n, 3))
    patch = Refined(vertices, fan(np.arange(n)), np.zeros(n - 2, np.int64), np.zeros(n), n)
    before = {frozenset(edge) for edge in directed_edges(patch.triangles).tolist()}
    chords = np.array([(i, j) for j in range(n) for i in range(j) if frozenset((i, j)) not in before])
    existing_edges = chords[rng.random(len(chords)) < 0.5]
    after = {
        frozenset(edge) for edge in directed_edges(flip_to_delaunay(patch, EdgeSet(existing_edges)).triangles).tolist()
    }
    assert not after & {frozenset(edge) for edge in existing_edges.tolist()}


@pytest.mark.parametrize("seed", range(30))
def test_two_holes_with_common_corners_never_flip_to_one_edge(seed: int) -> None:
    # Both lenses over the corners 0 and 1 are cut by the short chord 0-1 if they may.
    rng = np.random.default_rng(seed)
    n = 12
    angle = -2 * np.pi * (np.arange(n) + rng.uniform(-0.3, 0.3, n)) / n
    lens = np.stack([4 * np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)
    top, bottom = int(lens[:, 1].argmax()), int(lens[:, 1].argmin())
    small = np.array([[-1.5, 0.0, 1.0], [1.5, 0.1, 1.0]])
    vertices = np.concatenate([lens, small])
    large_fan = fan(np.roll(np.arange(n), -int(lens[:, 0].argmax())))
    small_pair = np.array([[n, n + 1, top], [n + 1, n, bottom]])
    triangles, hole = np.concatenate([large_fan, small_pair]), np.repeat([0, 1], [n - 2, 2])
    flipped = flip_to_delaunay(Refined(vertices, triangles, hole, np.zeros(n + 2), n + 2), NOTHING)
    assert faces_per_edge(flipped.triangles).max() <= 2


def test_relaxing_evens_out_triangles_and_stays_on_the_surface() -> None:
    mesh = MESHES["plane"]
    patch, existing_edges = coarse(mesh)
    fine = refine(patch, existing_edges)
    relaxed = relax(fine, mesh.triangles, existing_edges)
    assert relaxed.vertices[: fine.n_measured].tobytes() == mesh.vertices.tobytes()
    assert (relaxed.vertices[:, 2] == 0).all()
    assert is_oriented_manifold(np.concatenate([mesh.triangles, relaxed.triangles]))
    spread = [edge_lengths(part.vertices, part.triangles).std() for part in (fine, relaxed)]
    assert spread[1] < spread[0]
