"""A whole mesh coded and rebuilt: every patch by a dictionary, every vertex from its bins.

This is the machine that all uses of the paper stand on. The smoothed mesh is covered with quads, each quad carries
4 k + 1 patches, a patch is a height map over its plane, and connectivity says which bins a vertex falls in. Codes give
back the height maps, and a vertex comes to lie at the mean of what the patches that see it say. How far it moves by
that is the error of the codes.

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, sections 3 and 4.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from quadpatch.errors import StageError
from quadpatch.inpainters.paper_dictionary import learn_heights
from quadpatch.mesh.measures import diagonal
from quadpatch.options import DictionaryOptions, PatchOptions, built, check_seed
from quadpatch.patches.connectivity import Connectivity
from quadpatch.patches.layout import Sampled
from quadpatch.reconstruction.coding import PatchCodes, PatchDictionary, code_patches, decoded_heights
from quadpatch.reconstruction.placement import mean_moves
from quadpatch.reconstruction.surface_layout import (
    SurfaceLayout,
    lay_out_surface,
    patches_with_vertices,
    surface_scale,
)
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices


@dataclass(frozen=True)
class ReconstructOptions:
    """Everything that a reconstruction can be told.

    Attributes
    ----------
    patches : PatchOptions
    dictionary : DictionaryOptions
        Of the dictionary that is learned from the mesh itself.
    seed : int
        Starts every random choice.
    """

    patches: PatchOptions = field(default_factory=PatchOptions)
    dictionary: DictionaryOptions = field(default_factory=DictionaryOptions)
    seed: int = 0

    def __post_init__(self) -> None:
        check_seed(self.seed)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "ReconstructOptions":
        """Build from nested plain values; an unknown name raises OptionError."""
        return built(cls, values, patches=PatchOptions, dictionary=DictionaryOptions)


@dataclass(frozen=True)
class CodedSurface:
    """The codes of all patches of a surface.

    Attributes
    ----------
    layout : SurfaceLayout
    sampled : Sampled
        The patches that were coded: those whose surface is a height map.
    connectivity : Connectivity
        Of all vertices of the mesh in these patches.
    dictionary : PatchDictionary
    codes : PatchCodes
    """

    layout: SurfaceLayout
    sampled: Sampled
    connectivity: Connectivity
    dictionary: PatchDictionary
    codes: PatchCodes

    def heights(self) -> FloatArray:
        """Decode the heights (n_patches, N, N) of all patches, in mesh units."""
        return decoded_heights(self.codes, self.dictionary, self.sampled.base_heights)


@dataclass(frozen=True)
class Reconstruction:
    """A mesh rebuilt from the codes of its patches.

    Attributes
    ----------
    vertices : (n, 3) float64
        In mesh units; those that no patch sees keep their place.
    overlap : (n,) int64
        Count of patches that see each vertex.
    error : (n,) float64
        How far each vertex moved, in mesh units.
    rms, psnr : float
        Root mean square error of the vertices that patches see, in mesh units, and as decibels below the diagonal of
        the bounding box; NaN where none is seen.
    coded : CodedSurface
    """

    vertices: Vertices
    overlap: IntArray
    error: FloatArray
    rms: float
    psnr: float
    coded: CodedSurface

    @property
    def seen(self) -> BoolArray:
        """(n,) bool, True = some patch sees the vertex."""
        return np.asarray(self.overlap > 0)


def reconstruct(
    mesh: TriangleMesh,
    dictionary: PatchDictionary | None = None,
    options: ReconstructOptions | None = None,
    stages: Stages | None = None,
) -> Reconstruction:
    """Code all patches of a mesh and rebuild every vertex from its bins.

    Parameters
    ----------
    mesh : TriangleMesh
    dictionary : PatchDictionary, optional
        None learns one by K-SVD from the heights of the mesh's own patches.
    options : ReconstructOptions, optional
    stages : Stages, optional
        Gets progress and seconds.

    Returns
    -------
    Reconstruction

    Raises
    ------
    NoQuadsError
        If the mesh is too small or too thin to carry one quad.
    StageError
        If no dictionary is given and the mesh shows too little to learn one from.
    """
    options, stages = options or ReconstructOptions(), stages or Stages()
    layout = lay_out_surface(mesh, surface_scale(mesh, options.patches, dictionary), stages)
    with stages.stage("patchify"):
        codes_detail = dictionary is not None and not dictionary.codes_heights
        invented = np.zeros(len(mesh.triangles), bool)
        sampled, connectivity = patches_with_vertices(mesh, invented, layout, with_base=codes_detail)
    if dictionary is None:
        with stages.stage("learn"):
            dictionary = learned_from(sampled, options, stages)
    with stages.stage("inpaint"):
        coded = CodedSurface(layout, sampled, connectivity, dictionary, code_patches(sampled, dictionary))
    with stages.stage("reconstruct"):
        return _rebuilt(mesh, coded)


def learned_from(sampled: Sampled, options: ReconstructOptions, stages: Stages) -> PatchDictionary:
    """Learn a dictionary by K-SVD from the heights of some patches.

    Raises
    ------
    StageError
        If too few of them show enough to learn from.
    """
    rng = np.random.default_rng(options.seed)
    patches = sampled.patches
    learned = learn_heights(patches.heights, patches.known, options.dictionary, rng, stages.progress)
    if learned is None:
        raise StageError(
            f"the mesh shows {len(patches)} patches that are height maps: too few to learn from; take a learned model"
        )
    return PatchDictionary(learned.dictionary)


def _rebuilt(mesh: TriangleMesh, coded: CodedSurface) -> Reconstruction:
    moves = mean_moves(mesh.vertices, coded.connectivity, coded.sampled.patches, coded.heights())
    seen = moves.overlap > 0
    vertices = np.where(seen[:, None], mesh.vertices + moves.mean, mesh.vertices)
    error = np.linalg.norm(vertices - mesh.vertices, axis=1)
    rms = float(np.sqrt((error[seen] ** 2).mean())) if seen.any() else math.nan
    return Reconstruction(vertices, moves.overlap, error, rms, peak_signal_to_noise(rms, diagonal(mesh)), coded)


def peak_signal_to_noise(rms: float, peak: float) -> float:
    """PSNR in decibels, ``20 log10(peak / rms)``: infinite without an error, NaN where the error is."""
    return math.inf if rms == 0 else 20 * math.log10(peak / rms)
