"""Completion of patches by sparse coding, exactly as in section 4 of the paper.

What is coded is the height of the surface over the plane of its patch, in mesh units. Nothing is taken out: the atoms
carry the shape of the object as well as its detail. The default recipe has
`quadpatch.inpainters.dictionary` in its place.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.options import DictionaryOptions
from quadpatch.patches.normalisation import raw_heights
from quadpatch.patches.paper_layout import LEAST_KNOWN
from quadpatch.progress import Progress, no_progress
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.ksvd import KsvdOptions, OnIteration, masked_ksvd
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import BoolArray, FloatArray, Patches

# The paper finds no gain beyond 50 to 100 atoms on the patches of one shape, and takes 500 for those of many.
LOCAL_ATOMS = 100
GLOBAL_ATOMS = 500
# Heights hold the bend of the surface besides its relief, so a code needs more atoms than one of a relief alone.
NONZERO = 20
ITERATIONS = 15

MIN_TRAINING_PATCHES = 24
MAX_TRAINING_PATCHES = 5000


@dataclass(frozen=True)
class HeightsInpainter:
    """Sparse codes of heights over one dictionary.

    Attributes
    ----------
    dictionary : Dictionary
    length_share : float or None
        Side of the patches that it was learned from, as a share of the longest side of their meshes; None where each
        mesh had a length of its own.
    """

    dictionary: Dictionary
    length_share: float | None = None

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
        signals, _ = raw_heights(patches.heights, patches.known)
        known = patches.known.reshape(signals.shape)
        codes = masked_omp(signals, known, self.dictionary.atoms, self.dictionary.n_nonzero)
        return (codes @ self.dictionary.atoms.T).reshape(patches.heights.shape)


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
    wanted = KsvdOptions(options.atoms or LOCAL_ATOMS, options.nonzero or NONZERO, ITERATIONS)
    learned = learn_atoms(heights, known, wanted, rng, _reported(progress))
    return None if learned is None else HeightsInpainter(learned.dictionary)


@dataclass(frozen=True)
class LearnedAtoms:
    """A dictionary, and how it came about.

    Attributes
    ----------
    dictionary : Dictionary
    errors : (n_iterations,) float64
        Root mean square error over all known bins after each iteration, in the unit of the heights.
    n_patches : int
        That it was learned from.
    """

    dictionary: Dictionary
    errors: FloatArray
    n_patches: int


def learn_atoms(
    heights: FloatArray,
    known: BoolArray,
    options: KsvdOptions,
    rng: np.random.Generator,
    on_iteration: OnIteration | None = None,
) -> LearnedAtoms | None:
    """Learn a dictionary of heights, of one mesh or of many.

    Parameters
    ----------
    heights : (n_patches, N, N) float64
        In mesh units, or in patch lengths for meshes of several units; those that are not known are never read.
    known : (n_patches, N, N) bool
    options : KsvdOptions
        At most as many atoms as there are patches to learn from.
    rng : numpy.random.Generator
    on_iteration : callable, optional
        Told the error after every iteration.

    Returns
    -------
    LearnedAtoms or None
        None where too few patches are known well enough to learn anything.
    """
    usable = np.flatnonzero(known.mean(axis=(1, 2)) >= LEAST_KNOWN)
    if len(usable) > MAX_TRAINING_PATCHES:
        usable = np.sort(rng.choice(usable, MAX_TRAINING_PATCHES, replace=False))
    signals, _ = raw_heights(heights[usable], known[usable])
    textured = signals.any(axis=1)
    n_patches = int(textured.sum())
    if n_patches < MIN_TRAINING_PATCHES:
        return None
    n_atoms = min(options.n_atoms, n_patches)
    options = KsvdOptions(n_atoms, min(options.n_nonzero, n_atoms, signals.shape[1]), options.n_iterations)
    mask = known[usable].reshape(signals.shape)[textured]
    atoms, errors = masked_ksvd(signals[textured], mask, options, rng, on_iteration)
    return LearnedAtoms(Dictionary(atoms, int(heights.shape[1]), options.n_nonzero), errors, n_patches)


def _reported(progress: Progress) -> OnIteration:
    return lambda i, _: progress("learn", (i + 1) / ITERATIONS)
