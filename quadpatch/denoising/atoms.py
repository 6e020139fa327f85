"""Where the atoms of a patch come from: the clean patches most like it, or a dictionary."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from quadpatch.errors import NoQuadsError
from quadpatch.mesh.measures import mean_edge_length, surface_area
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.layout import lay_out, pick_patches
from quadpatch.patches.normalisation import raw_heights, to_signals
from quadpatch.patches.scale import PatchScale, base_surface_iterations
from quadpatch.patches.seeds import Seeds, project_seeds
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.gaussian import principal_atoms
from quadpatch.sparse.omp import masked_omp
from quadpatch.sparse.parallel import single_threaded_blas
from quadpatch.types import FloatArray, IntArray, Patches, TriangleMesh

# Clean patches that the atoms of a patch are made of.
N_NEAREST = 48
# Clean patches to choose from; each counts in its eight turns and mirror images.
MOST_EXEMPLARS = 2500
# Likeness is measured in the principal directions of the clean patches.
_N_DIRECTIONS = 40
# A quad mesh can't be laid on creases.
_QUAD_ITERATIONS = 4
# A patch that shows less than this share of its square has nothing to go by.
_LEAST_SEEN = 0.3
# Principal directions of a dictionary that patches are coded with.
PRINCIPAL_ATOMS = 100
# On a sound mesh a quad holds dozens of triangles.
MOST_QUADS_PER_TRIANGLE = 1.0
# With fewer patches nothing is learned.
LEAST_PATCHES = 24


class Atoms(Protocol):
    """What patches are coded over."""

    def of_patches(self, patches: IntArray) -> Iterator[tuple[FloatArray, FloatArray]]:
        """Give some patches (k,), by their numbers, a mean (N * N,) and atoms (n_atoms, N * N), in mesh units."""


@dataclass(frozen=True)
class Exemplars:
    """Clean patches, each patch to be coded over those nearest to it.

    Attributes
    ----------
    levels : (n_patches,) float64
        Mean heights of the patches to be coded.
    features : (n_patches, k) float64
        Their heights less these means, in the principal directions of the clean patches.
    clean : (m, N * N) float64
        Heights of the clean patches in all turns, less their means.
    clean_features : (m, k) float64
    origin : (m,) int64
        Which of the patches to be coded a clean one is itself; -1 for one from elsewhere.
    """

    levels: FloatArray
    features: FloatArray
    clean: FloatArray
    clean_features: FloatArray
    origin: IntArray

    @classmethod
    def of(cls, patches: Patches, clean: Patches, is_itself: bool, rng: np.random.Generator) -> "Exemplars":
        """Learn from clean patches, which may be those to be coded themselves."""
        chosen = np.sort(rng.permutation(len(clean))[:MOST_EXEMPLARS])
        heights, _ = _level_free(pick_patches(clean, np.isin(np.arange(len(clean)), chosen)))
        turns = _turns(clean.resolution)
        turned = np.concatenate([heights[:, turn] for turn in turns])
        signals, levels = _level_free(patches)
        with single_threaded_blas():
            directions = np.linalg.eigh(turned.T @ turned)[1][:, ::-1][:, :_N_DIRECTIONS]
            features, clean_features = signals @ directions, turned @ directions
        origin = np.tile(chosen if is_itself else np.full(len(chosen), -1), len(turns))
        return cls(levels, features, turned, clean_features, origin)

    def of_patches(self, patches: IntArray) -> Iterator[tuple[FloatArray, FloatArray]]:
        """See `Atoms`."""
        with single_threaded_blas():
            apart = (self.clean_features**2).sum(axis=1) - 2 * self.features[patches] @ self.clean_features.T
        # A patch is no example for itself: its own noise would count as detail.
        apart[patches[:, None] == self.origin] = np.inf
        nearest = np.argpartition(apart, N_NEAREST, axis=1)[:, :N_NEAREST]
        for patch, near in zip(patches.tolist(), nearest, strict=True):
            found = self.clean[near]
            mean = found.mean(axis=0)
            yield self.levels[patch] + mean, (found - mean) / np.sqrt(N_NEAREST - 1)


@dataclass(frozen=True)
class DictionaryAtoms:
    """One dictionary for all patches, each atom as free as the mesh uses it.

    Attributes
    ----------
    means : (n_patches, N * N) float64
        What the patches are coded over: their base surfaces, or their mean heights.
    deviations : (n_patches,) float64
        Of their heights from that, in mesh units.
    rows : (n_atoms, N * N) float64
        Atoms times the standard deviations of their coefficients, for signals of deviation 1.
    """

    means: FloatArray
    deviations: FloatArray
    rows: FloatArray

    @classmethod
    def of(cls, patches: Patches, base_heights: FloatArray, dictionary: Dictionary) -> "DictionaryAtoms":
        """Learn how much each atom is used, from sparse codes of the pilot's patches."""
        signals, scaling = to_signals(patches.heights - base_heights, patches.seen)
        codes = masked_omp(signals, patches.seen.reshape(signals.shape), dictionary.atoms, dictionary.n_nonzero)
        with single_threaded_blas():
            used = dictionary.atoms * np.sqrt((codes**2).mean(axis=0))
            atoms, deviations = principal_atoms(used @ used.T, PRINCIPAL_ATOMS)
        means = base_heights.reshape(signals.shape) + scaling.mean[:, None]
        return cls(means, scaling.deviation, (atoms * deviations).T)

    def of_patches(self, patches: IntArray) -> Iterator[tuple[FloatArray, FloatArray]]:
        """See `Atoms`."""
        for patch in patches.tolist():
            yield self.means[patch], self.deviations[patch] * self.rows


def lay_patches(mesh: TriangleMesh, scale: PatchScale) -> Patches:
    """Cover a surface with patches, on quads of a slightly smoothed copy.

    Raises
    ------
    NoQuadsError
        If the surface is too small or too thin to carry one quad.
    """
    # More quads than triangles: their size is not that of the mesh, and there may be too many for the memory.
    if surface_area(mesh) > MOST_QUADS_PER_TRIANGLE * len(mesh.triangles) * scale.length**2:
        raise NoQuadsError("the triangles differ too much in size for patches")
    scene = RayScene(mesh)
    seeds = project_seeds(scene, mesh, lay_out(laplacian_smooth(mesh, _QUAD_ITERATIONS), scale), scale.length)
    patches = sample(mesh, seeds, scale)
    return pick_patches(patches, np.asarray(patches.seen.mean(axis=(1, 2)) >= _LEAST_SEEN))


def sample(mesh: TriangleMesh, seeds: Seeds, scale: PatchScale) -> Patches:
    """Sample the heights of a mesh at some seeds."""
    nothing = np.zeros(len(mesh.triangles), bool)
    return sample_height_maps(RayScene(mesh), mesh, nothing, seeds, scale.length, scale.resolution)


def smooth_heights(mesh: TriangleMesh, patches: Patches, scale: PatchScale, of_heights: bool) -> FloatArray:
    """Heights (n, N, N) of the base surface under some patches; 0 for a dictionary of heights over the plane."""
    if of_heights:
        return np.zeros_like(patches.heights)
    base = laplacian_smooth(mesh, base_surface_iterations(scale.length, mean_edge_length(mesh)))
    quads = np.zeros(len(patches), np.int64)
    found = sample(base, Seeds(patches.origins, patches.frames, quads), scale)
    return np.where(found.seen, found.heights, patches.heights)


def _level_free(patches: Patches) -> tuple[FloatArray, FloatArray]:
    """Heights (n, N * N) less their mean over the bins that are seen, 0 in the others; and the means (n,)."""
    signals, _ = raw_heights(patches.heights, patches.seen)
    seen = patches.seen.reshape(signals.shape)
    means = signals.sum(axis=1) / np.maximum(seen.sum(axis=1), 1)
    return np.where(seen, signals - means[:, None], 0.0), means


def _turns(resolution: int) -> list[IntArray]:
    """Bins in the order of each of the eight turns and mirror images."""
    bins = np.arange(resolution**2).reshape(resolution, resolution)
    return [np.rot90(image, k).ravel() for image in (bins, bins.T) for k in range(4)]
