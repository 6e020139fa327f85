"""Completion of patches by sparse coding, exactly as in section 4 of the paper.

What is coded is the height of the surface over the plane of its patch, less the mean of the known bins, in mesh
units. Nothing else is taken out: the atoms carry the shape of the object as well as its detail. The default recipe has
`quadpatch.inpainters.dictionary` in its place.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.options import DictionaryOptions
from quadpatch.patches.normalisation import from_signals, mean_free
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.ksvd import KsvdOptions, OnIteration, masked_ksvd
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import BoolArray, FloatArray, Patches, Progress, no_progress

# The paper finds no gain beyond 50 to 100 atoms on the patches of one shape, and takes 500 for those of many.
LOCAL_ATOMS = 100
GLOBAL_ATOMS = 500
# Heights hold the bend of the surface besides its relief, so a code needs more atoms than one of a relief alone.
NONZERO = 20
ITERATIONS = 15

MIN_TRAINING_PATCHES = 24
MAX_TRAINING_PATCHES = 5000

# Patches to learn from are known in at least this share of their bins. On scans with a hole in every patch, none is
# known everywhere.
LEAST_KNOWN = 0.7


@dataclass(frozen=True)
class HeightsInpainter:
    """Sparse codes of heights over one dictionary."""

    dictionary: Dictionary

    @property
    def resolution(self) -> int:
        """Bins along one side of its patches."""
        return self.dictionary.resolution

    def fitted_to(self, undamaged: UndamagedSurface) -> "HeightsInpainter":
        """See `Inpainter`; the paper fits nothing."""
        return self

    def predict(self, patches: Patches, base_heights: FloatArray | None = None) -> FloatArray:
        """Predict every bin from the known ones of its patch; see `Inpainter`. The base surface is not looked at."""
        del base_heights
        signals, scaling = mean_free(patches.heights, patches.known)
        known = patches.known.reshape(signals.shape)
        codes = masked_omp(signals, known, self.dictionary.atoms, self.dictionary.n_nonzero)
        return from_signals(codes @ self.dictionary.atoms.T, scaling)


@dataclass(frozen=True)
class SelfHeights:
    """A dictionary that is learned by K-SVD from the mesh's own patches: the model `self` of the recipe `paper`.

    Attributes
    ----------
    options : DictionaryOptions
    seed : int
        Draws the patches to learn from, and the atoms to start from.
    progress : callable
    """

    options: DictionaryOptions
    seed: int = 0
    progress: Progress = no_progress

    @property
    def resolution(self) -> None:
        """See `Inpainter`."""

    def fitted_to(self, undamaged: UndamagedSurface) -> HeightsInpainter | None:
        """See `Inpainter`."""
        rng = np.random.default_rng(self.seed)
        patches = undamaged.patches
        return learn_heights(patches.heights, patches.known, self.options, rng, self.progress)


def is_learnable(known: BoolArray) -> BoolArray:
    """Say which patches (n_patches,) are known (n_patches, N, N) well enough to learn from."""
    return np.asarray(known.mean(axis=(1, 2)) >= LEAST_KNOWN)


def learn_heights(
    heights: FloatArray,
    known: BoolArray,
    options: DictionaryOptions,
    rng: np.random.Generator,
    progress: Progress = no_progress,
) -> HeightsInpainter | None:
    """Learn a dictionary of heights by K-SVD.

    Parameters
    ----------
    heights : (n_patches, N, N) float64
        In mesh units; those that are not known are never read.
    known : (n_patches, N, N) bool
    options : DictionaryOptions
        At most as many atoms as there are patches to learn from.
    rng : numpy.random.Generator
    progress : callable

    Returns
    -------
    HeightsInpainter or None
        None where too few patches are known well enough to learn anything.
    """
    usable = np.flatnonzero(is_learnable(known))
    if len(usable) > MAX_TRAINING_PATCHES:
        usable = np.sort(rng.choice(usable, MAX_TRAINING_PATCHES, replace=False))
    signals, _ = mean_free(heights[usable], known[usable])
    textured = signals.any(axis=1)
    if textured.sum() < MIN_TRAINING_PATCHES:
        return None
    n_atoms = min(options.atoms or LOCAL_ATOMS, int(textured.sum()))
    n_nonzero = min(options.nonzero or NONZERO, n_atoms, signals.shape[1])
    atoms, _ = masked_ksvd(
        signals[textured],
        known[usable].reshape(signals.shape)[textured],
        KsvdOptions(n_atoms, n_nonzero, ITERATIONS),
        rng,
        _reported(progress),
    )
    return HeightsInpainter(Dictionary(atoms, int(heights.shape[1]), n_nonzero))


def _reported(progress: Progress) -> OnIteration:
    return lambda i, _: progress("learn", (i + 1) / ITERATIONS)
