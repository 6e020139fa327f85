import numpy as np
import pytest

from quadpatch.inpainters.dictionary import SelfDictionary
from quadpatch.mesh.raycast import RayScene
from quadpatch.options import PatchOptions
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.layout import Sampled
from quadpatch.patches.seeds import Seeds
from quadpatch.restoration.least_squares import extend_smoothly
from quadpatch.restoration.patch_detail import continue_detail, nearest_corners
from quadpatch.stages import Stages
from quadpatch.types import TriangleMesh
from tests.quadpatch.restoration.boxes import scattered
from tests.quadpatch.shapes import open_grid, relief


def test_the_nearest_corner_of_a_bin_is_the_vertex_of_the_grid_next_to_it() -> None:
    grid = open_grid(9)
    seeds = Seeds(np.zeros((1, 3)), np.eye(3)[None], np.zeros(1, np.int64))
    patches = sample_height_maps(RayScene(grid), grid, np.zeros(len(grid.triangles), bool), seeds, 4.4, 4)
    corners = nearest_corners(grid, Sampled(patches, patches.heights))
    # Bin centres at -1.65, -0.55, 0.55 and 1.65: next to -2, -1, 1 and 2.
    np.testing.assert_array_equal(grid.vertices[corners[0, 2], 0], [-2, -1, 1, 2])
    np.testing.assert_array_equal(grid.vertices[corners[0, :, 2], 1], [-2, -1, 1, 2])


@pytest.fixture(scope="module")
def rough() -> TriangleMesh:
    return relief(80, depth=0.08, waves=8)


def test_patches_bring_a_relief_closer_than_the_least_squares_mesh(rough: TriangleMesh) -> None:
    missing = scattered(rough, 0.7)
    first = extend_smoothly(rough.triangles, missing, rough.vertices)
    detail = continue_detail(
        TriangleMesh(first, rough.triangles), missing, SelfDictionary(), PatchOptions(resolution=16), Stages()
    )
    assert detail is not None
    assert not detail.moves[~missing].any()
    before, after = (np.abs(x - rough.vertices)[missing, 2].mean() for x in (first, first + detail.moves))
    assert after < before


def test_a_mesh_of_no_texture_teaches_nothing() -> None:
    plane = open_grid(40)
    missing = scattered(plane, 0.2)
    assert continue_detail(plane, missing, SelfDictionary(), PatchOptions(), Stages()) is None
