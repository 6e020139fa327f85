"""Completion of patches by sparse coding (section 4 of the paper).

A patch is coded with few atoms, chosen and weighted by its known bins alone (masked orthogonal matching pursuit); the
code then gives every bin. What is coded is the detail over the smoothed surface, not the height itself: the
smoothed surface carries the shape, and the atoms are spent on what is worth learning.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.ksvd import KsvdOptions, masked_ksvd
from quadpatch.sparse.omp import masked_omp
from quadpatch.sparse.signals import from_signals, to_signals
from quadpatch.types import FloatArray, Patches, Progress

# Self-similar dictionaries: enough atoms for a scan's own texture, few enough to be learned in seconds.
SELF_ATOMS = 192
SELF_NONZERO = 12
SELF_ITERATIONS = 8
MAX_TRAINING_PATCHES = 2000
MIN_TRAINING_PATCHES = 24

# Patches with less known surface than this say nothing about the shape they came from.
LEAST_KNOWN = 0.5


@dataclass(frozen=True)
class DictionaryInpainter:
    """Sparse codes over one dictionary."""

    dictionary: Dictionary

    @property
    def resolution(self) -> int:
        """Bins along one side of its patches."""
        return self.dictionary.resolution

    def predict(self, patches: Patches, outline: FloatArray) -> FloatArray:
        """See `Inpainter`."""
        signals, scaling = to_signals(patches.heights - outline, patches.known)
        known = patches.known.reshape(signals.shape)
        codes = masked_omp(signals, known, self.dictionary.atoms, self.dictionary.n_nonzero)
        return outline + from_signals(codes @ self.dictionary.atoms.T, scaling)


def learn_from_patches(
    patches: Patches, outline: FloatArray, rng: np.random.Generator, progress: Progress
) -> DictionaryInpainter | None:
    """Learn a dictionary from the known bins of a mesh's own patches.

    Parameters
    ----------
    patches : Patches
    outline : (n_patches, N, N) float64
    rng : numpy.random.Generator
    progress : callable

    Returns
    -------
    DictionaryInpainter or None
        None where too few patches show enough surface to learn anything.
    """
    usable = np.flatnonzero(patches.known.mean(axis=(1, 2)) >= LEAST_KNOWN)
    if len(usable) > MAX_TRAINING_PATCHES:
        usable = np.sort(rng.choice(usable, MAX_TRAINING_PATCHES, replace=False))
    known = patches.known[usable]
    signals, scaling = to_signals(patches.heights[usable] - outline[usable], known)
    textured = scaling.spread > 0
    if textured.sum() < MIN_TRAINING_PATCHES:
        return None
    n_atoms = min(SELF_ATOMS, int(textured.sum()) // 3)
    atoms, _ = masked_ksvd(
        signals[textured],
        known.reshape(signals.shape)[textured],
        KsvdOptions(n_atoms, min(SELF_NONZERO, n_atoms), SELF_ITERATIONS),
        rng,
        lambda i, _: progress("learn", (i + 1) / SELF_ITERATIONS),
    )
    return DictionaryInpainter(Dictionary(atoms, patches.resolution, min(SELF_NONZERO, n_atoms)))
