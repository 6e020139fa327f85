"""Denoising of a whole mesh: from a noisy surface to shifts of its vertices.

Filters of the whole mesh are weighed by the error that they are expected to have; their mean, the pilot, carries the
patches; patches are coded over atoms that are learned from clean ones; pilot and patches are weighed once more. At last
no vertex moves farther than allowed, none outside the region, and none into a fold.
"""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from quadpatch.denoising.atoms import LEAST_PATCHES, Atoms, DictionaryAtoms, Exemplars, lay_patches, smooth_heights
from quadpatch.denoising.folds import Unfolded, n_turned, without_new_folds
from quadpatch.denoising.noise import estimate_noise
from quadpatch.denoising.options import Box, DenoiseOptions
from quadpatch.denoising.patch_filter import filter_by_patches
from quadpatch.denoising.risk import PROBE_SHARE, least_risk_weights
from quadpatch.denoising.surface_filters import FILTER_NAMES, SurfaceFilters
from quadpatch.errors import NoQuadsError, OptionError
from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.measures import diagonal, longest_side, mean_edge_length
from quadpatch.mesh.normals import length, vertex_normals
from quadpatch.patches.scale import EDGES_PER_BIN, OVERLAP, PatchScale, preset_scale
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, FloatArray, IntArray, TriangleMesh, Vertices
from quadpatch_rules.coded_warnings import warning

__all__ = ["Box", "DenoiseOptions", "Denoised", "PatchModel", "denoise"]

# An error of more than four standard deviations is one vertex in 16,000.
SHIFT_PER_NOISE = 4.0
# Bins along a patch of 7 mean edges: wider patches have fewer like them.
RESOLUTION = 11
# Patches with a smaller share are left out: their risk is a little underestimated, since it leaves out that atoms and
# pilot follow the noise too.
_LEAST_SHARE = 0.2
# A float32 file rounds coordinates by at most this share of the largest, in all three together.
_ROUNDING = 1.1e-7


@dataclass(frozen=True)
class PatchModel:
    """What patches are coded over.

    Attributes
    ----------
    kind : str
        `none` leaves the patches out, `self` takes the mesh's own, `reference` those of another mesh, `dictionary`
        the atoms of a dictionary.
    reference : TriangleMesh, optional
        Clean, and in the same unit.
    dictionary : Dictionary, optional
    of_heights : bool
        Whether the dictionary was learned from heights over the plane of a patch, not over its smoothed surface.
    """

    kind: Literal["none", "self", "reference", "dictionary"] = "self"
    reference: TriangleMesh | None = None
    dictionary: Dictionary | None = None
    of_heights: bool = False


@dataclass(frozen=True)
class Denoised:
    """A denoised mesh.

    Attributes
    ----------
    vertices : (n, 3) float64
        Those that did not move have the numbers that they came with.
    shift : (n,) float64
        How far each moved, in mesh units.
    noise, max_shift : float
        In mesh units.
    at_bound : (n,) bool
        Vertices that would have moved farther.
    shares : dict of str to float
        Share of each filter in the result; of the noisy vertices themselves, `none`.
    scale : PatchScale or None
        None where no patches took part.
    n_patches : int
    unfolded : Unfolded
    n_turned : int
        Triangles whose normal turned by more than a right angle.
    warnings : list of str
    """

    vertices: Vertices
    shift: FloatArray
    noise: float
    max_shift: float
    at_bound: BoolArray
    shares: dict[str, float]
    scale: PatchScale | None
    n_patches: int
    unfolded: Unfolded
    n_turned: int
    warnings: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class _Estimate:
    """A denoised surface, and what its risk is found from.

    Attributes
    ----------
    moves : (n, 3) float64
        From the noisy vertices.
    response : (n,) float64
        See `least_risk_weights`.
    shares : dict of str to float
    """

    moves: FloatArray
    response: FloatArray
    shares: dict[str, float]


@dataclass(frozen=True)
class _Noisy:
    """The mesh as it came, and what all weighing needs."""

    mesh: TriangleMesh
    noise: float
    edges: IntArray
    probe: FloatArray

    def weigh(self, names: list[str], parts: list[_Estimate], normals: FloatArray) -> _Estimate:
        """Mean of least risk of some estimates."""
        shifts = np.stack([np.einsum("ij,ij->i", part.moves, normals) for part in parts], axis=1)
        responses = np.stack([part.response for part in parts], axis=1)
        weights = least_risk_weights(shifts, responses, self.probe, self.edges, self.noise)
        moves = sum((weight * part.moves for weight, part in zip(weights, parts, strict=True)), np.zeros_like(normals))
        shares: dict[str, float] = {}
        for name, weight, part in zip(names, weights.tolist(), parts, strict=True):
            for inner, share in (part.shares or {name: 1.0}).items():
                shares[inner] = shares.get(inner, 0.0) + weight * share
        return _Estimate(moves, responses @ weights, shares)


def denoise(
    mesh: TriangleMesh,
    options: DenoiseOptions | None = None,
    model: PatchModel | None = None,
    movable: BoolArray | None = None,
    stages: Stages | None = None,
) -> Denoised:
    """Move the vertices of a mesh back onto the surface that was measured.

    Parameters
    ----------
    mesh : TriangleMesh
        Finite; open, in pieces or not a manifold, as it comes. Vertices that no triangle uses stay.
    options : DenoiseOptions, optional
        A region that names a property of a file is not looked at: see `movable`.
    model : PatchModel, optional
    movable : (n,) bool, optional
        Vertices that may move, besides the box of the options.
    stages : Stages, optional
        Gets progress and seconds.

    Raises
    ------
    OptionError
        If the noise is larger than the mesh, or the region holds no vertex.
    """
    options, model, stages = options or DenoiseOptions(), model or PatchModel(), stages or Stages()
    allowed = _allowed(mesh, options, movable)
    rng = np.random.default_rng(options.seed)
    with stages.stage("smooth"):
        noise = options.noise or estimate_noise(mesh)
    if noise > diagonal(mesh):
        raise OptionError(f"noise is {noise:.4g}, and the mesh only {diagonal(mesh):.4g} wide")
    if not noise > 0:
        return _unchanged(mesh, options)
    with stages.stage("smooth"):
        noisy, pilot = _pilot(mesh, noise, rng)
    scale, n_patches, warnings, estimate = None, 0, list[str](), pilot
    if model.kind != "none":
        scale = denoising_scale(mesh, options, model)
        try:
            estimate, n_patches = _with_patches(noisy, pilot, scale, model, rng, stages)
        except NoQuadsError as error:
            warnings.append(warning("no_patches_to_denoise", reason=str(error)))
            scale = None
    with stages.stage("judge"):
        max_shift = options.max_shift or SHIFT_PER_NOISE * noise
        moves, at_bound = _bounded(mesh, np.where(allowed[:, None], estimate.moves, 0.0), max_shift)
        unfolded = without_new_folds(mesh, moves)
        vertices = mesh.vertices + unfolded.moves
    shares = {**estimate.shares, "none": max(0.0, 1.0 - sum(estimate.shares.values()))}
    if len(unfolded.left):
        warnings.append(warning("folds_left", folds=len(unfolded.left)))
    return Denoised(
        vertices,
        length(unfolded.moves),
        noise,
        max_shift,
        at_bound,
        shares,
        scale,
        n_patches,
        unfolded,
        n_turned(mesh, vertices),
        warnings,
    )


def denoising_scale(mesh: TriangleMesh, options: DenoiseOptions, model: PatchModel) -> PatchScale:
    """Choose length, resolution and overlap of patches where neither the user nor the model does."""
    chosen, dictionary = preset_scale(options.patches, longest_side(mesh)), model.dictionary
    resolution = dictionary.resolution if dictionary else chosen.resolution or RESOLUTION
    default_length = EDGES_PER_BIN * mean_edge_length(mesh) * resolution
    return PatchScale(
        chosen.length or default_length, resolution, OVERLAP if chosen.overlap is None else chosen.overlap
    )


def _allowed(mesh: TriangleMesh, options: DenoiseOptions, movable: BoolArray | None) -> BoolArray:
    allowed = np.ones(len(mesh.vertices), bool) if movable is None else movable.copy()
    if isinstance(options.region, Box):
        inside = (mesh.vertices >= np.array(options.region.min)) & (mesh.vertices <= np.array(options.region.max))
        allowed &= inside.all(axis=1)
    if not allowed.any():
        raise OptionError("the region holds no vertex of the mesh")
    return allowed


def _unchanged(mesh: TriangleMesh, options: DenoiseOptions) -> Denoised:
    n = len(mesh.vertices)
    nothing = without_new_folds(mesh, np.zeros((n, 3)))
    warnings: list[str] = [warning("no_noise")]
    bound = options.max_shift or 0.0
    return Denoised(
        mesh.vertices, np.zeros(n), 0.0, bound, np.zeros(n, bool), {"none": 1.0}, None, 0, nothing, 0, warnings
    )


def _pilot(mesh: TriangleMesh, noise: float, rng: np.random.Generator) -> tuple[_Noisy, _Estimate]:
    """Weigh the filters of the whole mesh."""
    filters = SurfaceFilters(mesh)
    normals = filters.normals(mesh.vertices)
    has_normal = np.einsum("ij,ij->i", normals, normals) > 0.5
    probe = np.where(has_normal, rng.choice([-1.0, 1.0], len(normals)), 0.0)
    step = PROBE_SHARE * noise
    moved = mesh.vertices + step * probe[:, None] * normals
    parts = []
    for at, beside in zip(filters.apply(mesh.vertices), filters.apply(moved), strict=True):
        response = np.einsum("ij,ij->i", beside - moved - (at - mesh.vertices), normals) / step
        parts.append(_Estimate(at - mesh.vertices, response, {}))
    edges = group_edges(mesh.triangles, len(mesh.vertices)).ends()
    noisy = _Noisy(mesh, noise, edges, probe)
    return noisy, noisy.weigh(list(FILTER_NAMES), parts, normals)


def _with_patches(
    noisy: _Noisy,
    pilot: _Estimate,
    scale: PatchScale,
    model: PatchModel,
    rng: np.random.Generator,
    stages: Stages,
) -> tuple[_Estimate, int]:
    """Code the patches of the pilot, and weigh both."""
    surface = TriangleMesh(noisy.mesh.vertices + pilot.moves, noisy.mesh.triangles)
    with stages.stage("quadrangulate"):
        patches = lay_patches(surface, scale)
    with stages.stage("learn"):
        if model.kind == "dictionary" and model.dictionary is not None:
            base = smooth_heights(surface, patches, scale, model.of_heights)
            atoms: Atoms = DictionaryAtoms.of(patches, base, model.dictionary)
        else:
            clean = patches if model.reference is None else lay_patches(model.reference, scale)
            if len(clean) < LEAST_PATCHES:
                raise NoQuadsError(f"there are only {len(clean)} patches to learn from")
            atoms = Exemplars.of(patches, clean, model.reference is None, rng)
    with stages.stage("reconstruct"):
        coded = filter_by_patches(noisy.mesh, surface, patches, atoms, noisy.noise, noisy.probe)
        normals = vertex_normals(surface.vertices, surface.triangles)
        response = np.where(coded.is_shown, coded.response - noisy.probe, pilot.response)
        by_patches = _Estimate(pilot.moves + coded.shift[:, None] * normals, response, {})
        weighed = noisy.weigh(["smoothed", "patches"], [pilot, by_patches], normals)
        return (weighed if weighed.shares["patches"] >= _LEAST_SHARE else pilot), len(patches)


def _bounded(mesh: TriangleMesh, moves: FloatArray, max_shift: float) -> tuple[FloatArray, BoolArray]:
    """Shorten moves (n, 3) so that vertices stay within the bound even where a file rounds them."""
    largest = float(np.abs(mesh.vertices[mesh.triangles]).max(initial=0.0))
    limit = max(0.0, max_shift - _ROUNDING * (max_shift + largest))
    shift = length(moves)
    at_bound = shift > limit
    factor = np.divide(limit, shift, out=np.ones_like(shift), where=at_bound)
    return moves * factor[:, None], at_bound
