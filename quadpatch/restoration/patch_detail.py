"""What patches add to restored vertices: detail that a dictionary continues from the measured bins.

Patches are cut from the completed mesh, and the model is fitted to all of it: with half of the vertices missing hardly
a patch is known in most of its bins. A bin is known where the corner of the mesh nearest to it was measured. The
code of a patch gives all its bins, and each vertex the displacement that its patches agree on. At measured vertices
the truth is known: what the codes say there is their misfit, and it is continued smoothly to the missing vertices and
taken off.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, sections 3 to 5.
"""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.calibration.training_pairs import TrainingSurface
from quadpatch.errors import OptionError
from quadpatch.inpainters.inpainter import Inpainter, UndamagedSurface
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.normals import vertex_normals
from quadpatch.options import PatchOptions
from quadpatch.patches.connectivity import bilinear
from quadpatch.patches.height_map import bin_centres
from quadpatch.patches.layout import Sampled
from quadpatch.patches.scale import PatchScale, choose_scale
from quadpatch.reconstruction.displacement import mean_displacement
from quadpatch.reconstruction.whole_surface import lay_out_surface, patches_with_vertices
from quadpatch.restoration.least_squares import extend_smoothly
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh

# Bins along a patch of a model that is learned from the mesh: on the benchmark's relief wider patches, of 24 bins, gain
# three times what those of 16 do.
RESOLUTION = 24


@dataclass(frozen=True)
class PatchDetail:
    """What patches say about missing vertices.

    Attributes
    ----------
    moves : (n, 3) float64
        In mesh units; zero where measured or seen by no patch.
    overlap : (n,) int64
        Count of patches that see each vertex.
    scale : PatchScale
    n_patches : int
    """

    moves: FloatArray
    overlap: IntArray
    scale: PatchScale
    n_patches: int


def continue_detail(
    completed: TriangleMesh, missing: BoolArray, inpainter: Inpainter, options: PatchOptions, stages: Stages
) -> PatchDetail | None:
    """Let a model say how missing vertices lie off from where they are.

    Parameters
    ----------
    completed : TriangleMesh
        With positions for all vertices.
    missing : (n,) bool
    inpainter : Inpainter
    options : PatchOptions
    stages : Stages

    Returns
    -------
    PatchDetail or None
        None where the mesh shows too little to learn from.

    Raises
    ------
    NoQuadsError
        If the mesh is too small or too thin to carry one quad.
    """
    scale = _scale(completed, inpainter, options)
    layout = lay_out_surface(completed, scale, stages)
    with stages.stage("patchify"):
        nothing_invented = np.zeros(len(completed.triangles), bool)
        sampled, seen = patches_with_vertices(completed, nothing_invented, layout, with_base=True)
        known = replace(sampled.patches, known=sampled.patches.known & ~missing[nearest_corners(completed, sampled)])
    with stages.stage("learn"):
        fitted = inpainter.fitted_to(UndamagedSurface(sampled.patches, sampled.base_heights, _no_training_surface))
    if fitted is None:
        return None
    with stages.stage("inpaint"):
        predicted = fitted.predict(known, sampled.base_heights)
    with stages.stage("reconstruct"):
        normals = vertex_normals(completed.vertices, completed.triangles)
        said = mean_displacement(normals, seen, known, bilinear(predicted - known.heights, seen))
        moves = np.where(missing[:, None], said.mean - extend_smoothly(completed.triangles, missing, said.mean), 0.0)
        moves[said.overlap == 0] = 0.0
    return PatchDetail(moves, said.overlap, scale, len(known))


def nearest_corners(mesh: TriangleMesh, sampled: Sampled) -> IntArray:
    """Vertex (n_patches, N, N) of the mesh nearest to the surface point of each bin, among the corners of its triangle.

    Bins that see nothing get that of some triangle.
    """
    patches = sampled.patches
    points = bin_centres(patches.origins, patches.frames, patches.length, patches.resolution)
    points = points + patches.heights[..., None] * patches.frames[:, None, None, 2]
    corners = mesh.triangles[np.maximum(patches.triangle, 0)]
    squared = np.stack([((mesh.vertices[corners[..., k]] - points) ** 2).sum(axis=-1) for k in range(3)], axis=-1)
    return np.take_along_axis(corners, squared.argmin(axis=-1)[..., None], axis=-1)[..., 0]


def _scale(mesh: TriangleMesh, inpainter: Inpainter, options: PatchOptions) -> PatchScale:
    if inpainter.resolution is None and options.resolution is None:
        options = replace(options, resolution=RESOLUTION)
    return choose_scale([], mean_edge_length(mesh), options, inpainter.resolution)


def _no_training_surface() -> TrainingSurface:
    raise OptionError("missing vertices are restored by dictionaries, and by networks that need no fitting")
