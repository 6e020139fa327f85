"""Completion of patches by a dictionary of atoms (section 4 of the paper).

A patch is coded by its known bins alone; the code then gives every bin. What is coded is the detail over the smoothed
surface, not the height itself: the smoothed surface carries the shape, and the atoms are spent on what is worth
learning. Atoms come from a model file or are learned from the mesh itself; how much each is used is always learned
from the mesh, and tells the code how free it is to use it (see `quadpatch.sparse.gaussian`).
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.patches.normalisation import from_signals, to_signals
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.gaussian import gaussian_codes, known_covariance, principal_atoms
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import BoolArray, FloatArray, Patches

# Principal directions that patches are coded with; what lies beyond them counts as noise.
PRINCIPAL_ATOMS = 200
MIN_TRAINING_PATCHES = 24

# Patches with less known surface than this say nothing about the shape they came from.
LEAST_KNOWN = 0.5


@dataclass(frozen=True)
class DictionaryInpainter:
    """Codes over one dictionary.

    Attributes
    ----------
    dictionary : Dictionary
    deviations : (n_atoms,) float64 or None
        How much the mesh at hand uses each atom, as a standard deviation over its signals; None for a dictionary that
        has seen no mesh yet: then sparse codes are used, which need no such thing.
    """

    dictionary: Dictionary
    deviations: FloatArray | None = None

    @property
    def resolution(self) -> int:
        """Bins along one side of its patches."""
        return self.dictionary.resolution

    def fitted_to(self, undamaged: UndamagedSurface) -> "DictionaryInpainter":
        """See `Inpainter`: learn how much this mesh uses each atom, from sparse codes of its patches.

        That makes a covariance of the bins, and its principal directions take the place of the atoms.
        """
        signals, known = _usable_signals(undamaged.patches, undamaged.base_heights)
        if len(signals) < MIN_TRAINING_PATCHES:
            return self
        codes = masked_omp(signals, known, self.dictionary.atoms, self.dictionary.n_nonzero)
        used = self.dictionary.atoms * np.sqrt((codes**2).mean(axis=0))
        return _principal(used @ used.T, self.resolution)

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        """See `Inpainter`."""
        signals, scaling = to_signals(patches.heights - base_heights, patches.known)
        known = patches.known.reshape(signals.shape)
        atoms = self.dictionary.atoms
        if self.deviations is None:
            completed = masked_omp(signals, known, atoms, self.dictionary.n_nonzero) @ atoms.T
        else:
            scaled = atoms * self.deviations
            completed = gaussian_codes(signals, known, scaled) @ scaled.T
        return base_heights + from_signals(completed, scaling)


@dataclass(frozen=True)
class SelfDictionary:
    """A dictionary that is learned from the known bins of the mesh's own patches: the model `self`."""

    @property
    def resolution(self) -> None:
        """See `Inpainter`."""

    def fitted_to(self, undamaged: UndamagedSurface) -> DictionaryInpainter | None:
        """See `Inpainter`."""
        return learned_from(undamaged.patches, undamaged.base_heights)


def learned_from(patches: Patches, base_heights: FloatArray) -> DictionaryInpainter | None:
    """Learn a dictionary from the known bins of patches; None where these show too little.

    Parameters
    ----------
    patches : Patches
    base_heights : (n_patches, N, N) float64
        Heights of the smoothed surface in the same patches.
    """
    signals, known = _usable_signals(patches, base_heights)
    if len(signals) < MIN_TRAINING_PATCHES:
        return None
    return _principal(known_covariance(signals, known), patches.resolution)


def _principal(covariance: FloatArray, resolution: int) -> DictionaryInpainter:
    atoms, deviations = principal_atoms(covariance, PRINCIPAL_ATOMS)
    return DictionaryInpainter(Dictionary(atoms, resolution, len(deviations)), deviations)


def _usable_signals(patches: Patches, base_heights: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Signals of the patches that show enough surface, and some texture; and their known bins."""
    usable = patches.known.mean(axis=(1, 2)) >= LEAST_KNOWN
    signals, scaling = to_signals(patches.heights[usable] - base_heights[usable], patches.known[usable])
    textured = scaling.deviation > 0
    return signals[textured], patches.known[usable].reshape(signals.shape)[textured]
