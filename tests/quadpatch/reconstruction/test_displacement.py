from dataclasses import replace

import numpy as np
import pytest

from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.filling.fill import close_holes, fair_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.seeds import Seeds
from quadpatch.reconstruction.displacement import displace, join_at_rim, rim_vertices
from quadpatch.types import FloatArray, IntArray, Patches, TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, open_grid, punched, random_rotation


@pytest.fixture(scope="module")
def filled() -> FilledMesh:
    mesh = punched(open_grid(41, 2.0), (0, 0, 0), (0.6, 0.6, 0), radius=0.27)
    loops = sorted(boundary_loops(mesh.triangles).loops, key=len)[:-1]
    return fair_holes(close_holes(mesh, loops), THIN_PLATE)


def patches_over(filled: FilledMesh, places: FloatArray, frames: FloatArray | None = None) -> Patches:
    frames = np.tile(np.eye(3), (len(places), 1, 1)) if frames is None else frames
    seeds = Seeds(places, frames, np.arange(len(places)))
    return sample_height_maps(RayScene(filled.mesh), filled.mesh, filled.invented_triangles, seeds, 0.8, 16)


def places(spacing: float = 0.2) -> FloatArray:
    x, y = np.meshgrid(np.arange(-0.8, 0.81, spacing), np.arange(-0.8, 0.81, spacing))
    return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)


def new_vertices(filled: FilledMesh) -> IntArray:
    return np.flatnonzero(filled.invented_vertices)


def test_patches_that_say_what_is_there_displace_nothing_at_all(filled: FilledMesh) -> None:
    patches = patches_over(filled, places())
    found = displace(filled, new_vertices(filled), patches, patches.heights)
    rim, _ = rim_vertices(filled)
    at_rim = displace(filled, rim, patches, patches.heights)
    assert (found.mean == 0).all()
    assert (found.deviation == 0).all()
    assert (found.overlap > 0).all()
    assert (join_at_rim(filled, found.mean, rim, at_rim.mean) == 0).all()


def test_patches_that_agree_displace_by_exactly_what_they_say(filled: FilledMesh) -> None:
    patches = patches_over(filled, places())
    found = displace(filled, new_vertices(filled), patches, patches.heights + 0.03)
    np.testing.assert_allclose(found.mean, np.tile([0, 0, 0.03], (len(found.mean), 1)), rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(found.deviation, 0, atol=1e-15)


def test_a_displacement_that_is_the_same_everywhere_is_all_misfit_at_the_rim(filled: FilledMesh) -> None:
    # Harmonic functions that are constant on the rim are constant inside: the join takes all of it off.
    rim, _ = rim_vertices(filled)
    inside = np.tile([0.1, 0.2, 0.3], (len(new_vertices(filled)), 1))
    joined_there = join_at_rim(filled, inside, rim, np.tile([0.1, 0.2, 0.3], (len(rim), 1)))
    np.testing.assert_allclose(joined_there, 0, atol=1e-14)


def test_the_join_is_the_displacement_less_the_mean_of_what_was_taken_off_around(filled: FilledMesh) -> None:
    rng = np.random.default_rng(0)
    rim, _ = rim_vertices(filled)
    first = filled.n_measured_vertices
    inside, at_rim = rng.normal(size=(len(new_vertices(filled)), 3)), rng.normal(size=(len(rim), 3))
    taken_off = {**dict(zip(rim.tolist(), at_rim, strict=True))}
    for i, correction in enumerate(inside - join_at_rim(filled, inside, rim, at_rim)):
        taken_off[first + i] = correction
    around: dict[int, set[int]] = {}
    for a, b, c in filled.mesh.triangles[filled.n_measured_triangles :].tolist():
        for one, other in ((a, b), (b, c), (c, a)):
            around.setdefault(one, set()).add(other)
            around.setdefault(other, set()).add(one)
    for vertex in new_vertices(filled).tolist():
        mean = np.mean([taken_off[other] for other in around[vertex]], axis=0)
        np.testing.assert_allclose(taken_off[vertex], mean, atol=1e-12)


def test_without_misfit_at_the_rim_nothing_is_taken_off(filled: FilledMesh) -> None:
    rim, _ = rim_vertices(filled)
    inside = np.random.default_rng(0).normal(size=(len(new_vertices(filled)), 3))
    assert (join_at_rim(filled, inside, rim, np.zeros((len(rim), 3))) == inside).all()


def test_a_misfit_at_one_rim_does_not_reach_another_hole(filled: FilledMesh) -> None:
    rim, rim_hole = rim_vertices(filled)
    inside = np.zeros((len(new_vertices(filled)), 3))
    at_rim = np.where(rim_hole[:, None] == 0, 1.0, 0.0) * np.ones(3)
    taken_off = -join_at_rim(filled, inside, rim, at_rim)
    assert (taken_off[filled.vertex_hole == 1] == 0).all()
    np.testing.assert_allclose(taken_off[filled.vertex_hole == 0], 1, atol=1e-12)


def test_the_rim_is_every_measured_vertex_of_an_invented_triangle(filled: FilledMesh) -> None:
    rim, hole = rim_vertices(filled)
    loops = sorted(boundary_loops(filled.mesh.triangles[: filled.n_measured_triangles]).loops, key=len)[:-1]
    assert {frozenset(rim[hole == i].tolist()) for i in range(2)} == {frozenset(loop.tolist()) for loop in loops}


def test_two_patches_that_differ_are_averaged_and_their_spread_is_told(filled: FilledMesh) -> None:
    # Both lie in one place, so both weigh the same.
    patches = patches_over(filled, np.zeros((2, 3)))
    says = patches.heights + np.array([0.0, 0.1])[:, None, None]
    found = displace(filled, new_vertices(filled), patches, says)
    seen = found.overlap > 0
    assert set(found.overlap[seen].tolist()) == {2}
    np.testing.assert_allclose(found.mean[seen], np.tile([0, 0, 0.05], (int(seen.sum()), 1)), atol=1e-14)
    np.testing.assert_allclose(found.deviation[seen], 0.05, atol=1e-14)
    assert (found.mean[~seen] == 0).all()


def test_a_patch_counts_more_at_its_centre_than_at_its_border(filled: FilledMesh) -> None:
    patches = patches_over(filled, np.array([[0.0, 0, 0], [0.3, 0, 0]]))
    says = patches.heights + np.array([0.0, 0.1])[:, None, None]
    near_first, near_second = (
        displace(filled, vertices_at(filled, x), patches, says).mean[:, 2].mean() for x in (-0.05, 0.35)
    )
    assert near_first < 0.02
    assert near_second > 0.08


def vertices_at(filled: FilledMesh, x: float) -> IntArray:
    """Vertices of the fill around (x, 0)."""
    return np.flatnonzero((np.abs(filled.mesh.vertices[:, :2] - [x, 0]) < 0.06).all(axis=1))


def test_displacements_turn_with_the_mesh() -> None:
    plate = punched(bumpy_plate(40, 2.0), (0.2, 0.1, 0), radius=0.3)
    (loop, _) = sorted(boundary_loops(plate.triangles).loops, key=len)
    here = fair_holes(close_holes(plate, [loop]), THIN_PLATE)
    rotation = random_rotation(np.random.default_rng(3))
    turned = TriangleMesh(here.mesh.vertices @ rotation.T, here.mesh.triangles)
    there = replace(here, mesh=turned)
    seeds = places(0.3)
    patches = patches_over(here, seeds)
    moved = patches_over(there, seeds @ rotation.T, np.tile(rotation.T, (len(seeds), 1, 1)))
    offset = np.random.default_rng(0).normal(0, 0.01, patches.heights.shape)
    one = displace(here, new_vertices(here), patches, patches.heights + offset)
    other = displace(there, new_vertices(there), moved, moved.heights + offset)
    assert (one.overlap == other.overlap).all()
    np.testing.assert_allclose(other.mean, one.mean @ rotation.T, atol=1e-9)
    np.testing.assert_allclose(other.deviation, one.deviation, atol=1e-9)


def test_no_new_vertex_needs_no_join() -> None:
    mesh = open_grid(5)
    nothing = fair_holes(close_holes(mesh, []), THIN_PLATE)
    assert join_at_rim(nothing, np.zeros((0, 3)), np.zeros(0, np.int64), np.zeros((0, 3))).shape == (0, 3)
