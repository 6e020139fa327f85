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

from quadpatch.errors import OptionError, StageError
from quadpatch.inpainters.paper_dictionary import learn_heights
from quadpatch.mesh.measures import diagonal, mean_edge_length
from quadpatch.mesh.normals import vertex_normals
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.options import DictionaryOptions, PatchOptions
from quadpatch.patches.connectivity import Connectivity, merged, vertices_in_patches
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.gaps import gap_seeds
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.layout import Sampled, pick, sample_over_base, together
from quadpatch.patches.scale import EDGES_PER_BIN, OVERLAP, PatchScale, base_surface_iterations
from quadpatch.patches.seeds import Seeds, seed_points
from quadpatch.quads.frames import quad_frames
from quadpatch.quads.mesher import quadrangulate
from quadpatch.reconstruction.coding import PatchCodes, PatchDictionary, code_patches, decoded_heights
from quadpatch.reconstruction.placement import mean_moves
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, FloatArray, IntArray, QuadMesh, TriangleMesh, Vertices

# Bins along a patch where neither options nor model say how many. Patches of 24 bins span half as much again: fewer of
# them, and on the benchmark's bunny 5 dB less at the same size of the dictionary.
RESOLUTION = 16


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
        if isinstance(self.seed, bool) or not isinstance(self.seed, int) or self.seed < 0:
            raise OptionError(f"seed must be a whole number of 0 or more; it is {self.seed}")

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "ReconstructOptions":
        """Build from nested plain values; an unknown name raises OptionError."""
        try:
            patches = PatchOptions(**(values.get("patches") or {}))
            dictionary = DictionaryOptions(**(values.get("dictionary") or {}))
            rest = {name: value for name, value in values.items() if name not in ("patches", "dictionary")}
            return cls(patches, dictionary, **rest)
        except (TypeError, ValueError) as error:
            raise OptionError(f"options don't fit: {error}") from error


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
