"""How well a dictionary completes patches that it has never seen.

A disk in the middle of each patch is hidden, the rest is coded, and the error inside the disk is compared with that
of a thin plate and of a membrane over the same hole, and with that of coding the whole patch, nothing hidden. All
within one patch: the base surface is that of the undamaged mesh, and no neighbouring patch helps, so the figures rank
dictionaries; they are not the error of a repair.
"""

import numpy as np

from quadpatch.patches.normalisation import NORMALISATION, NORMALISATIONS, from_signals
from quadpatch.sparse.dictionary import Dictionary
from quadpatch.sparse.omp import masked_omp
from quadpatch.types import BoolArray, FloatArray
from training.smooth_fills import disk, smooth_fill

HOLE_SHARES = (0.25, 0.5)


def evaluate(dictionary: Dictionary, patches: FloatArray, normalisation: str = NORMALISATION) -> dict[str, float]:
    """Measure a dictionary on patches known in every bin.

    Parameters
    ----------
    dictionary : Dictionary
    patches : (n, N, N) float64
        Detail, in mesh units; n at least 1.
    normalisation : str
        How signals are made of them, one of `NORMALISATIONS`.

    Returns
    -------
    dict of str to float
        For each hole share s (in percent of the patch's side): `hole_s_error`, root mean square error in the hidden
        bins in units of the patch's own spread; `hole_s_to_plate` and `hole_s_to_membrane`, the same divided by that of
        a thin plate and of a membrane; `hole_s_to_unhidden`, divided by that of coding the patch with nothing hidden.
    """
    measures: dict[str, float] = {"n_patches": float(len(patches))}
    spreads = patches.std(axis=(1, 2))
    patches, spreads = patches[spreads > 0.0], spreads[spreads > 0.0]
    everything = np.ones(patches.shape[1:], dtype=np.bool_)
    whole = complete(dictionary, patches, everything, normalisation)
    for share in HOLE_SHARES:
        known = disk(dictionary.resolution, share)
        hidden = np.where(known, patches, 0.0)
        fills = {
            "plate": smooth_fill(hidden, known, 2),
            "membrane": smooth_fill(hidden, known, 1),
            "unhidden": whole,
        }
        name = f"hole_{round(100 * share)}"
        completed = join(complete(dictionary, hidden, known, normalisation), hidden, known)
        error = _error(completed, patches, spreads, ~known)
        measures[f"{name}_error"] = error
        for other, filled in fills.items():
            measures[f"{name}_to_{other}"] = error / _error(filled, patches, spreads, ~known)
    return {key: round(value, 4) for key, value in measures.items()}


def complete(
    dictionary: Dictionary, patches: FloatArray, known: BoolArray, normalisation: str = NORMALISATION
) -> FloatArray:
    """Code patches of which all have the same known bins (N, N), and give back what the codes say everywhere."""
    masks = np.broadcast_to(known, patches.shape)
    signals, scaling = NORMALISATIONS[normalisation](patches, masks)
    codes = masked_omp(signals, masks.reshape(signals.shape), dictionary.atoms, dictionary.n_nonzero)
    return from_signals(codes @ dictionary.atoms.T, scaling)


def join(completed: FloatArray, patches: FloatArray, known: BoolArray) -> FloatArray:
    """Meet the known bins exactly: spread what the codes miss there into the hole, as a membrane."""
    return completed + smooth_fill(patches - completed, known, 1)


def _error(filled: FloatArray, truth: FloatArray, spreads: FloatArray, hidden: BoolArray) -> float:
    difference = (filled - truth)[:, hidden] / spreads[:, None]
    return float(np.sqrt((difference**2).mean()))
