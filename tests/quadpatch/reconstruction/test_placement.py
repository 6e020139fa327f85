import numpy as np
import pytest

from quadpatch.filling.fill import close_flat
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.boundary import boundary_loops
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.seeds import Seeds
from quadpatch.reconstruction.placement import place
from quadpatch.types import FloatArray, IntArray, Patches
from tests.quadpatch.shapes import open_grid, punched

LENGTH = 0.8


@pytest.fixture(scope="module")
def filled() -> FilledMesh:
    mesh = punched(open_grid(41, 2.0), (0, 0, 0), (0.6, 0.6, 0), radius=0.27)
    return close_flat(mesh, sorted(boundary_loops(mesh.triangles).loops, key=len)[:-1])


def patches_over(filled: FilledMesh, origins: FloatArray, frames: FloatArray | None = None) -> Patches:
    frames = np.tile(np.eye(3), (len(origins), 1, 1)) if frames is None else frames
    seeds = Seeds(origins, frames, np.arange(len(origins)))
    return sample_height_maps(RayScene(filled.mesh), filled.mesh, filled.invented_triangles, seeds, LENGTH, 16)


def new_vertices(filled: FilledMesh) -> IntArray:
    return np.flatnonzero(filled.invented_vertices)


def positions(filled: FilledMesh, patches: Patches, predicted: FloatArray) -> FloatArray:
    vertices = new_vertices(filled)
    return np.asarray(filled.mesh.vertices[vertices] + place(filled, vertices, patches, predicted).mean)


def test_a_vertex_is_placed_at_its_place_in_the_plane_and_the_predicted_height(filled: FilledMesh) -> None:
    """The height replaces that of the closing; the plane of the patch need not be that of the surface."""
    patches = patches_over(filled, np.array([[0.05, 0.0, 0.1]]))
    before = filled.mesh.vertices[new_vertices(filled)]
    over = np.abs(before[:, :2] - [0.05, 0.0]).max(axis=1) <= LENGTH / 2
    after = positions(filled, patches, np.full((1, 16, 16), 0.07))
    assert over.any()
    np.testing.assert_allclose(after[over], before[over] * [1, 1, 0] + [0, 0, 0.17], atol=1e-15)


def test_heights_between_bins_are_read_bilinearly(filled: FilledMesh) -> None:
    patches = patches_over(filled, np.zeros((1, 3)))
    steps = ((np.arange(16) + 0.5) / 16 - 0.5) * LENGTH
    slope = 0.3 * steps[None, None, :] + 0.1 * steps[None, :, None]
    before = filled.mesh.vertices[new_vertices(filled)]
    inside = np.abs(before[:, :2]).max(axis=1) < LENGTH / 2 * 15 / 16
    after = positions(filled, patches, slope)
    np.testing.assert_allclose(after[inside, 2], (before[inside, :2] @ [0.3, 0.1]), atol=1e-15)


def test_patches_count_alike_wherever_the_vertex_lies_in_them(filled: FilledMesh) -> None:
    """A plain mean: a vertex at the centre of one patch and near the border of another lies halfway between them."""
    patches = patches_over(filled, np.array([[0.0, 0.0, 0.0], [0.25, 0.1, 0.0], [0.6, 0.6, 0.0]]))
    predicted = np.broadcast_to(np.array([0.0, 0.04, 0.01])[:, None, None], (3, 16, 16))
    vertices = new_vertices(filled)
    found = place(filled, vertices, patches, predicted)
    both = (found.overlap == 2) & (np.linalg.norm(filled.mesh.vertices[vertices], axis=1) < 0.3)
    assert both.any()
    np.testing.assert_allclose(found.mean[both], np.tile([0, 0, 0.02], (both.sum(), 1)), atol=1e-15)
    np.testing.assert_allclose(found.deviation[both], 0.02, atol=1e-15)


def test_tilted_patches_move_vertices_along_their_own_normal(filled: FilledMesh) -> None:
    tilt = np.array([[np.cos(0.3), 0, np.sin(0.3)], [0, 1, 0], [-np.sin(0.3), 0, np.cos(0.3)]])
    patches = patches_over(filled, np.zeros((1, 3)), tilt[None])
    found = place(filled, new_vertices(filled), patches, patches.heights + 0.05)
    seen = found.overlap > 0
    assert seen.any()
    np.testing.assert_allclose(found.mean[seen], np.tile(0.05 * tilt[2], (seen.sum(), 1)), atol=1e-12)


def test_a_vertex_that_no_patch_sees_stays(filled: FilledMesh) -> None:
    patches = patches_over(filled, np.array([[0.0, 0.0, 0.0]]))
    vertices = new_vertices(filled)
    found = place(filled, vertices, patches, patches.heights + 1.0)
    unseen = found.overlap == 0
    assert unseen.any()
    assert (unseen == (filled.mesh.vertices[vertices, 0] > LENGTH / 2)).mean() > 0.9
    assert (found.mean[unseen] == 0).all()
    none = place(filled, vertices, patches_over(filled, np.zeros((0, 3))), np.zeros((0, 16, 16)))
    assert (none.mean == 0).all()
