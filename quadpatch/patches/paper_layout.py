"""Patches as the paper lays and samples them: section 3, from the smoothed mesh to height maps.

Repairs by the recipe `paper` and the training of its models both cut their patches here, so that a model meets in a
repair what it learned from: the same smoothing, quads of the same length, the same bins, the same rule for folds.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section 3.
"""

import numpy as np

from quadpatch.mesh.meshlab import two_step_smooth
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.layout import lay_out, pick_patches, take
from quadpatch.patches.point_heights import ball_radius, point_height_maps, sample_cloud
from quadpatch.patches.scale import PatchScale
from quadpatch.patches.seeds import Seeds, project_seeds
from quadpatch.types import BoolArray, Patches, TriangleMesh

SMOOTHING_ITERATIONS = 30
# Patches to learn from are known in at least this share of their bins. On scans with a hole in every patch, none is
# known everywhere.
LEAST_KNOWN = 0.7


def smooth_for_quads(mesh: TriangleMesh) -> TriangleMesh:
    """Smooth a closed mesh as the paper does before it lays quads: MeshLab's two steps, 30 times.

    Raises
    ------
    StageError
        If MeshLab refuses the mesh.
    """
    return two_step_smooth(mesh, SMOOTHING_ITERATIONS)


def seeds_on_surface(smoothed: TriangleMesh, scale: PatchScale) -> Seeds:
    """Cover a smoothed mesh with quads of the patch length, and put 4 k + 1 seeds for each of them on its surface.

    Raises
    ------
    NoQuadsError
        If the mesh is too small or too thin to carry one quad.
    """
    seeds = lay_out(smoothed, scale)
    return project_seeds(RayScene(smoothed), smoothed, seeds, ball_radius(scale.length))


def measured_patches(mesh: TriangleMesh, seeds: Seeds, scale: PatchScale, rng: np.random.Generator) -> Patches:
    """Sample the height maps at some seeds from a cloud of points on a mesh; there are none in its holes."""
    points, normals = sample_cloud(mesh, seeds, scale.length, scale.resolution, rng)
    return point_height_maps(points, normals, seeds, scale.length, scale.resolution)


def cut_patches(
    mesh: TriangleMesh, smoothed: TriangleMesh, scale: PatchScale, rng: np.random.Generator, n_most: int | None = None
) -> Patches:
    """Cut the patches of a whole mesh, in the order of their seeds.

    Parameters
    ----------
    mesh : TriangleMesh
        Its holes stay holes: bins in them are unknown.
    smoothed : TriangleMesh
        The same mesh, as `smooth_for_quads` gives it.
    scale : PatchScale
    rng : numpy.random.Generator
        Draws the points, and the places where there are too many.
    n_most : int, optional
        Patches at so many places, at most.

    Raises
    ------
    NoQuadsError
        If the mesh is too small or too thin to carry one quad.
    """
    seeds = seeds_on_surface(smoothed, scale)
    if n_most is not None and len(seeds) > n_most:
        seeds = take(seeds, np.sort(rng.choice(len(seeds), n_most, replace=False)))
    return measured_patches(mesh, seeds, scale, rng)


def is_learnable(patches: Patches) -> BoolArray:
    """Say which patches (n_patches,) can be learned from: known well enough, and height maps."""
    return np.asarray((patches.known.mean(axis=(1, 2)) >= LEAST_KNOWN) & is_unfolded(patches))


def learnable(patches: Patches) -> Patches:
    """Pick the patches that can be learned from."""
    return pick_patches(patches, is_learnable(patches))
