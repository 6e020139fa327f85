"""Training patches: the detail of measured surface, cut out by the method's own stages.

The detail of a patch is its heights minus those of the base surface over the same bins; for the paper's own recipe
it is the heights themselves. Repairing codes the same quantity, made by the same functions, so a dictionary meets in a
repair what it has seen here.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quadpatch.errors import NoQuadsError
from quadpatch.filling.fill import close_flat
from quadpatch.formats.reading import read_scan
from quadpatch.mesh.measures import longest_side, mean_edge_length
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.mesh.weld import weld
from quadpatch.options import PatchOptions
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.layout import lay_out, patchify, take
from quadpatch.patches.normalisation import HEIGHTS, NORMALISATION, to_signals
from quadpatch.patches.paper_layout import cut_patches as cut_patches_as_paper
from quadpatch.patches.paper_layout import learnable, smooth_for_quads
from quadpatch.patches.scale import EDGES_PER_BIN, PatchScale, base_surface_iterations, preset_scale
from quadpatch.recipes.paper import LEAST_EDGES_PER_BIN
from quadpatch.recipes.paper import RESOLUTION as USUAL_RESOLUTION
from quadpatch.types import BoolArray, FloatArray, Patches, TriangleMesh
from quadpatch_rules.option_words import Preset

# Patches that vary less than this part of their side show noise, not a pattern worth an atom.
LEAST_RELIEF = 1e-4
# Scans have holes, folds and borders; atoms are learned from patches that are known almost everywhere.
LEAST_KNOWN = 0.8
# Training wants more patches than a repair: the quads that carry them are smaller by this factor than the patches.
QUADS_PER_LENGTH = 2.0


@dataclass(frozen=True)
class PatchRecipe:
    """How patches are cut out of a training mesh.

    Attributes
    ----------
    resolution : int
        Bins along one side.
    length : float or None
        Side of the smallest patches in mesh units; None: bins as wide as in a repair, relative to the mean edge.
    scales : tuple of float
        Patches are cut at each of these multiples of the length.
    overlap : int
        k: besides its centre, every quad carries 4 k offset patches.
    max_seeds : int
        At most so many places of one mesh, drawn at random, so that a large scan does not drown a small one.
    normalisation : str
        How signals are made of them, one of `quadpatch.patches.normalisation.NORMALISATIONS`.
    preset : str or None
        Of the paper, in place of a length: a share of the longest side of each mesh.
    """

    resolution: int = 24
    length: float | None = None
    scales: tuple[float, ...] = (1.0, 1.5, 2.0)
    overlap: int = 1
    max_seeds: int = 1000
    normalisation: str = NORMALISATION
    preset: Preset | None = None

    def base_length(self, mesh: TriangleMesh) -> float:
        """Side of the smallest patches of a mesh, in its units."""
        options = preset_scale(PatchOptions(self.length, preset=self.preset), longest_side(mesh))
        edges = (
            LEAST_EDGES_PER_BIN * USUAL_RESOLUTION if self.normalisation == HEIGHTS else EDGES_PER_BIN * self.resolution
        )
        return options.length or edges * mean_edge_length(mesh)


@dataclass(frozen=True)
class TrainingPatches:
    """Patches to learn from.

    Attributes
    ----------
    detail : (n, N, N) float64
        Over the base surface, in mesh units; for the paper's recipe over the plane of the patch, in patch lengths, so
        that meshes of any unit go together. 0 in unknown bins.
    known : (n, N, N) bool
    """

    detail: FloatArray
    known: BoolArray

    def __len__(self) -> int:
        """Count of patches."""
        return len(self.detail)

    @property
    def is_clean(self) -> BoolArray:
        """(n,) bool, True = known in every bin."""
        return np.asarray(self.known.all(axis=(1, 2)))

    @staticmethod
    def joined(parts: "list[TrainingPatches]", resolution: int) -> "TrainingPatches":
        """Join patches of several meshes."""
        none = np.zeros((0, resolution, resolution))
        return TrainingPatches(
            np.concatenate([none, *(part.detail for part in parts)]),
            np.concatenate([none > 0.0, *(part.known for part in parts)]),
        )


def read_mesh(path: Path) -> TriangleMesh:
    """Read a training mesh from any format that can be repaired; raises MeshError."""
    scan = read_scan(path)
    return weld(scan.vertices, scan.triangles).mesh


def cut_patches(mesh: TriangleMesh, recipe: PatchRecipe, rng: np.random.Generator) -> TrainingPatches:
    """Cut patches of several sizes out of a mesh, wherever it is a height map with some relief.

    Parameters
    ----------
    mesh : TriangleMesh
        Its holes stay holes: bins in them are unknown.
    recipe : PatchRecipe
    rng : numpy.random.Generator
        Draws the places where there are more than `max_seeds`.

    Returns
    -------
    TrainingPatches
        None where the mesh is too small to carry one.
    """
    if recipe.normalisation == HEIGHTS:
        return _cut_heights(mesh, recipe, rng)
    edge_length, length = mean_edge_length(mesh), recipe.base_length(mesh)
    try:
        base_surface = _base_surface(mesh, length, edge_length)
        seeds = lay_out(base_surface, PatchScale(length / QUADS_PER_LENGTH, recipe.resolution, recipe.overlap))
    except NoQuadsError:
        return TrainingPatches.joined([], recipe.resolution)
    if len(seeds) > recipe.max_seeds:
        chosen = np.zeros(len(seeds), np.bool_)
        chosen[rng.choice(len(seeds), recipe.max_seeds, replace=False)] = True
        seeds = take(seeds, chosen)
    unfilled = close_flat(mesh, [])
    cut = []
    for side in (scale * length for scale in recipe.scales):
        scale = PatchScale(side, recipe.resolution, recipe.overlap)
        # As in a repair, wider patches lie over a smoother base surface.
        under = base_surface if side == length else _base_surface(mesh, side, edge_length)
        sampled = patchify(unfilled, under, seeds, scale)
        cut.append(_worth_learning(sampled.patches, sampled.base_heights))
    return TrainingPatches.joined(cut, recipe.resolution)


def _cut_heights(mesh: TriangleMesh, recipe: PatchRecipe, rng: np.random.Generator) -> TrainingPatches:
    """Cut patches as a repair by the paper's recipe does: quads as wide as patches, over one smoothed mesh."""
    smoothed, cut = smooth_for_quads(mesh), []
    for side in (scale * recipe.base_length(mesh) for scale in recipe.scales):
        scale = PatchScale(side, recipe.resolution, recipe.overlap)
        try:
            patches = learnable(cut_patches_as_paper(mesh, smoothed, scale, rng, recipe.max_seeds))
        except NoQuadsError:
            continue
        cut.append(TrainingPatches(patches.heights / side, patches.known))
    return TrainingPatches.joined(cut, recipe.resolution)


def _base_surface(mesh: TriangleMesh, length: float, edge_length: float) -> TriangleMesh:
    return laplacian_smooth(mesh, base_surface_iterations(length, edge_length))


def _worth_learning(patches: Patches, base_heights: FloatArray) -> TrainingPatches:
    """Keep the patches that a repair would code, known almost everywhere and not flat."""
    detail = np.where(patches.known, patches.heights - base_heights, 0.0)
    _, scaling = to_signals(detail, patches.known)
    keep = is_unfolded(patches) & (patches.known.mean(axis=(1, 2)) >= LEAST_KNOWN)
    keep &= scaling.deviation > LEAST_RELIEF * patches.length
    return TrainingPatches(detail[keep], patches.known[keep])


def turn_at_random(patches: TrainingPatches, rng: np.random.Generator) -> TrainingPatches:
    """Turn each patch by a random multiple of 90 degrees, and mirror it or not.

    The frame of a quad may point along any of its sides, so a dictionary must know its patterns in all of them.
    """
    turns, is_mirrored = rng.integers(0, 4, len(patches)), rng.random(len(patches)) < 0.5
    detail, known = patches.detail.copy(), patches.known.copy()
    for grid in (detail, known):
        for n_turns in range(1, 4):
            grid[turns == n_turns] = np.rot90(grid[turns == n_turns], n_turns, axes=(1, 2))
        grid[is_mirrored] = grid[is_mirrored].transpose(0, 2, 1)
    return TrainingPatches(detail, known)
