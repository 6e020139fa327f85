import numpy as np

from quadpatch.denoising.atoms import Exemplars, lay_patches
from quadpatch.denoising.patch_filter import filter_by_patches
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.normals import vertex_normals
from quadpatch.patches.scale import PatchScale
from quadpatch.types import TriangleMesh
from tests.quadpatch.denoising.noisy_shapes import normal_error, with_noise
from tests.quadpatch.shapes import relief


def test_patches_of_a_clean_relief_take_noise_off_another_piece_of_it() -> None:
    clean, other = relief(60, waves=5), relief(64, waves=5)
    noisy, noise = with_noise(clean, 0.2)
    scale = PatchScale(7 * mean_edge_length(clean), 11, 2)
    patches = lay_patches(noisy, scale)
    atoms = Exemplars.of(patches, lay_patches(other, scale), False, np.random.default_rng(0))
    probe = np.random.default_rng(1).choice([-1.0, 1.0], len(noisy.vertices))
    coded = filter_by_patches(noisy, noisy, patches, atoms, noise, probe)
    vertices = noisy.vertices + coded.shift[:, None] * vertex_normals(noisy.vertices, noisy.triangles)
    assert coded.is_shown.mean() > 0.6
    assert normal_error(clean, vertices) < 0.6 * normal_error(clean, noisy.vertices)
    # A filter that takes off most of the noise follows little of the probe.
    assert 0 < (coded.response * probe).mean() < 0.5


def test_a_vertex_that_no_patch_shows_stays() -> None:
    clean = relief(60, waves=5)
    lonely = TriangleMesh(np.concatenate([clean.vertices, [[50.0, 0.0, 0.0]]]), clean.triangles)
    patches = lay_patches(lonely, PatchScale(7 * mean_edge_length(clean), 11, 2))
    atoms = Exemplars.of(patches, patches, True, np.random.default_rng(0))
    coded = filter_by_patches(lonely, lonely, patches, atoms, 0.01, np.ones(len(lonely.vertices)))
    assert not coded.is_shown[-1]
    assert coded.shift[-1] == 0.0
