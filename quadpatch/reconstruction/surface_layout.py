"""Where the patches of a whole mesh lie: quads over the smoothed mesh, seeds, gaps, and the vertices in each patch.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section 3.

Tested in `tests/quadpatch/reconstruction/test_whole_surface.py`.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.errors import OptionError
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.options import PatchOptions
from quadpatch.patches.connectivity import Connectivity, merged, vertices_in_patches
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.gaps import gap_seeds
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.layout import Sampled, pick, sample_over_base, together
from quadpatch.patches.scale import EDGES_PER_BIN, OVERLAP, PatchScale, base_surface_iterations
from quadpatch.patches.seeds import Seeds, seed_points
from quadpatch.quads.frames import quad_frames
from quadpatch.quads.mesher import quadrangulate
from quadpatch.reconstruction.coding import PatchDictionary
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, QuadMesh, TriangleMesh

# Bins along a patch where neither options nor model say how many. Patches of 24 bins span half as much again: fewer of
# them, and on the benchmark's bunny 5 dB less at the same size of the dictionary.
RESOLUTION = 16


@dataclass(frozen=True)
class SurfaceLayout:
    """The quad mesh of a surface, and the anchors of its patches.

    Attributes
    ----------
    base_surface : TriangleMesh
        The smoothed mesh.
    quad_mesh : QuadMesh
    seeds : Seeds
        4 k + 1 for every quad.
    scale : PatchScale
    """

    base_surface: TriangleMesh
    quad_mesh: QuadMesh
    seeds: Seeds
    scale: PatchScale


def surface_scale(mesh: TriangleMesh, options: PatchOptions, dictionary: PatchDictionary | None = None) -> PatchScale:
    """Choose the scale of patches over a whole mesh: bins a little finer than its edges, unless a length is given.

    Raises
    ------
    OptionError
        If the options ask for another resolution than the dictionary has.
    """
    own = None if dictionary is None else dictionary.dictionary.resolution
    if own and options.resolution and options.resolution != own:
        raise OptionError(f"patches.resolution is {options.resolution}; the model's patches have {own} bins a side")
    resolution = own or options.resolution or RESOLUTION
    length = options.length or EDGES_PER_BIN * mean_edge_length(mesh) * resolution
    return PatchScale(float(length), resolution, OVERLAP if options.overlap is None else options.overlap)


def lay_out_surface(mesh: TriangleMesh, scale: PatchScale, stages: Stages | None = None) -> SurfaceLayout:
    """Smooth a mesh, cover it with quads of the patch length, and give every quad its seeds.

    Raises
    ------
    NoQuadsError
        If the mesh is too small or too thin to carry one quad.
    """
    stages = stages or Stages()
    with stages.stage("smooth"):
        base_surface = laplacian_smooth(mesh, base_surface_iterations(scale.length, mean_edge_length(mesh)))
    with stages.stage("quadrangulate"):
        quad_mesh = quadrangulate(base_surface, scale.length)
        seeds = seed_points(quad_mesh, quad_frames(quad_mesh), scale.overlap)
    return SurfaceLayout(base_surface, quad_mesh, seeds, scale)


def patches_with_vertices(
    mesh: TriangleMesh, invented: BoolArray, layout: SurfaceLayout, *, with_base: bool
) -> tuple[Sampled, Connectivity]:
    """Cut the patches of a layout, and more where the quads leave gaps, and find the vertices in them.

    Parameters
    ----------
    mesh : TriangleMesh
    invented : (n_triangles,) bool
        True for triangles that were not measured.
    layout : SurfaceLayout
        Its base surface has the vertices of `mesh`.
    with_base : bool
        Sample the base surface too; without it the base heights are 0, and heights alone can be coded.

    Returns
    -------
    sampled : Sampled
        The patches whose surface is a height map: those of the quads, then those of the gaps.
    connectivity : Connectivity
        Of all vertices of `mesh`.
    """
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    parts = []
    seeds, unseen = layout.seeds, np.ones(len(mesh.vertices), bool)
    for _ in range(2):
        sampled = _sampled(mesh, invented, layout, seeds, with_base)
        sampled = pick(sampled, is_unfolded(sampled.patches))
        parts.append((sampled, vertices_in_patches(mesh.vertices, normals, sampled.patches)))
        unseen[parts[-1][1].vertex] = False
        seeds = gap_seeds(layout.base_surface, unseen, layout.seeds, layout.scale.length)
    (of_quads, seen), (of_gaps, also_seen) = parts
    return together(of_quads, of_gaps), merged(seen, also_seen, len(of_quads.patches))


def _sampled(mesh: TriangleMesh, invented: BoolArray, layout: SurfaceLayout, seeds: Seeds, with_base: bool) -> Sampled:
    scale = layout.scale
    if with_base:
        return sample_over_base(mesh, invented, layout.base_surface, seeds, scale)
    patches = sample_height_maps(RayScene(mesh), mesh, invented, seeds, scale.length, scale.resolution)
    return Sampled(patches, np.zeros_like(patches.heights))
