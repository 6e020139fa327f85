"""Sparse codes of patches over one dictionary, and the heights that they stand for.

The codes are those of section 4 of the paper: masked orthogonal matching pursuit over the bins that are known. What is
coded depends on what the dictionary was learned from: heights over the plane of the patch, as in the paper, or detail
over the smoothed surface (`quadpatch.patches.normalisation`).

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section 4.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.patches.layout import Sampled
from quadpatch.patches.normalisation import HEIGHTS, NORMALISATIONS, Scaling, from_signals
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import FloatArray


@dataclass(frozen=True)
class PatchDictionary:
    """A dictionary and how the signals that it codes are made.

    Attributes
    ----------
    dictionary : Dictionary
    normalisation : str
        A key of `quadpatch.patches.normalisation.NORMALISATIONS`.
    """

    dictionary: Dictionary
    normalisation: str = HEIGHTS

    @property
    def codes_heights(self) -> bool:
        """True where whole heights are coded, and no base surface is needed to get them back."""
        return self.normalisation == HEIGHTS


@dataclass(frozen=True)
class PatchCodes:
    """Codes of some patches.

    Attributes
    ----------
    codes : (n_patches, n_atoms) float64
        At most as many non-zeros in a row as the dictionary allows.
    scaling : Scaling
        What was taken out of the patches before they were coded.
    """

    codes: FloatArray
    scaling: Scaling

    @property
    def n_nonzero(self) -> int:
        """Count of non-zero coefficients of all patches."""
        return int(np.count_nonzero(self.codes))


def code_patches(sampled: Sampled, dictionary: PatchDictionary, tolerance: float = 0.0) -> PatchCodes:
    """Code patches by their known bins.

    Parameters
    ----------
    sampled : Sampled
        The base heights are read only where the dictionary codes detail.
    dictionary : PatchDictionary
        Of the resolution of the patches.
    tolerance : float
        Root mean square, over the known bins of a signal, at which its code ends; in the unit of the signals.

    Returns
    -------
    PatchCodes
    """
    patches = sampled.patches
    coded = patches.heights if dictionary.codes_heights else patches.heights - sampled.base_heights
    signals, scaling = NORMALISATIONS[dictionary.normalisation](coded, patches.known)
    known = patches.known.reshape(signals.shape)
    atoms = dictionary.dictionary
    return PatchCodes(masked_omp(signals, known, atoms.atoms, atoms.n_nonzero, tolerance), scaling)


def decoded_heights(codes: PatchCodes, dictionary: PatchDictionary, base_heights: FloatArray) -> FloatArray:
    """Turn codes into heights.

    Parameters
    ----------
    codes : PatchCodes
    dictionary : PatchDictionary
        The one they were made with.
    base_heights : (n_patches, N, N) float64
        Of the smoothed surface, in mesh units; not read where the dictionary codes whole heights.

    Returns
    -------
    (n_patches, N, N) float64
        In mesh units, in every bin.
    """
    coded = from_signals(codes.codes @ dictionary.dictionary.atoms.T, codes.scaling)
    return coded if dictionary.codes_heights else base_heights + coded
