"""From a filled mesh to its patches: base surface, quad mesh, frames, seeds, height maps (section 3 of the paper)."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.scale import PatchScale
from quadpatch.patches.seeds import Seeds, seed_points
from quadpatch.quads.frames import quad_frames
from quadpatch.quads.mesher import quadrangulate
from quadpatch.types import BoolArray, FloatArray, IntArray, Patches, TriangleMesh, Vertices


@dataclass(frozen=True)
class Sampled:
    """Patches, and the smoothed surface in the same patches.

    Attributes
    ----------
    patches : Patches
    base_heights : (n_patches, N, N) float64
        Heights of the base surface, in mesh units.
    """

    patches: Patches
    base_heights: FloatArray


def lay_out(base_surface: TriangleMesh, scale: PatchScale) -> Seeds:
    """Quadrangulate the base surface with quads of the patch length, and give every quad its seeds.

    Raises
    ------
    NoQuadsError
        If the base surface is too small or too thin to carry one quad.
    """
    quad_mesh = quadrangulate(base_surface, scale.length)
    return seed_points(quad_mesh, quad_frames(quad_mesh), scale.overlap)


def patchify(filled: FilledMesh, base_surface: TriangleMesh, seeds: Seeds, scale: PatchScale) -> Sampled:
    """Sample the filled mesh and its base surface in the patches at some seeds.

    A bin where the base surface can't be seen is not known: there is no detail to be coded.
    """
    return sample_over_base(filled.mesh, filled.invented_triangles, base_surface, seeds, scale)


def sample_over_base(
    mesh: TriangleMesh, invented: BoolArray, base_surface: TriangleMesh, seeds: Seeds, scale: PatchScale
) -> Sampled:
    """Sample any mesh and its base surface in the patches at some seeds; see `patchify`.

    Parameters
    ----------
    mesh : TriangleMesh
    invented : (n_triangles,) bool
        True for the triangles of `mesh` that were not measured.
    base_surface : TriangleMesh
    seeds : Seeds
    scale : PatchScale

    Returns
    -------
    Sampled
    """
    surface = sample_height_maps(RayScene(mesh), mesh, invented, seeds, scale.length, scale.resolution)
    smooth = sample_height_maps(
        RayScene(base_surface),
        base_surface,
        np.zeros(len(base_surface.triangles), bool),
        seeds,
        scale.length,
        scale.resolution,
    )
    both = replace(surface, known=surface.known & smooth.seen)
    return Sampled(both, np.where(smooth.seen, smooth.heights, surface.heights))


def seeds_near(seeds: Seeds, points: Vertices, length: float) -> BoolArray:
    """Which seeds (n_seeds,) have one of some points inside the circle around their patch."""
    if not len(points):
        return np.zeros(len(seeds.origins), bool)
    distance, _ = cKDTree(points).query(seeds.origins, distance_upper_bound=length * np.sqrt(0.5))
    near: BoolArray = np.isfinite(distance)
    return near


def take(seeds: Seeds, which: BoolArray | IntArray) -> Seeds:
    """Pick some of the seeds."""
    return Seeds(seeds.origins[which], seeds.frames[which], seeds.quad[which])


def pick(sampled: Sampled, which: BoolArray) -> Sampled:
    """Pick some of the patches, with their part of the base surface."""
    return Sampled(pick_patches(sampled.patches, which), sampled.base_heights[which])


def unfolded(sampled: Sampled) -> Sampled:
    """Leave out patches whose surface is folded, see `quadpatch.patches.folding`."""
    return pick(sampled, is_unfolded(sampled.patches))


def pick_patches(patches: Patches, which: BoolArray | IntArray) -> Patches:
    """Pick some of the patches, without a base surface."""
    return Patches(
        patches.origins[which],
        patches.frames[which],
        patches.length,
        patches.heights[which],
        patches.known[which],
        patches.seen[which],
        patches.triangle[which],
    )


def together(one: Sampled, other: Sampled) -> Sampled:
    """Put two sets of patches of one length and resolution behind each other."""
    patches = joined_patches(one.patches, other.patches)
    return Sampled(patches, np.concatenate([one.base_heights, other.base_heights]))


def joined_patches(a: Patches, b: Patches) -> Patches:
    """Put two sets of patches of one length and resolution behind each other, without base surfaces."""
    return Patches(
        np.concatenate([a.origins, b.origins]),
        np.concatenate([a.frames, b.frames]),
        a.length,
        np.concatenate([a.heights, b.heights]),
        np.concatenate([a.known, b.known]),
        np.concatenate([a.seen, b.seen]),
        np.concatenate([a.triangle, b.triangle]),
    )
