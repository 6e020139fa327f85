"""How well a published network completes patches that it has never seen: the same measures as for dictionaries.

The file itself is measured, through the code that repairs use. See `training.evaluation`.
"""

from pathlib import Path

import numpy as np

from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from quadpatch.types import BoolArray, FloatArray, Patches
from training.evaluation import HOLE_SHARES
from training.paper_task import spread_rows
from training.shards import Corpus, PatchSet
from training.smooth_fills import disk, smooth_fill

# Of scans, and of procedural reliefs; enough for three digits.
MAX_PATCHES = 600
# The dense system of a thin plate over all bins gets too large beyond.
MAX_PLATE_RESOLUTION = 32


def evaluate_network(path: Path, corpus: Corpus) -> dict[str, float]:
    """Measure a network for the recipe `paper` on the held-out patches of a corpus.

    Parameters
    ----------
    path : Path
        ONNX, with its card.
    corpus : Corpus

    Returns
    -------
    dict of str to float
        For scans and procedural reliefs apart: `scan_hole_25_error`, root mean square error in patch lengths in a disk
        of 25 % of the patch's side, hidden in the middle of clean patches; `…_to_plate` and `…_to_membrane`, divided by
        that of a thin plate and of a membrane (up to 32 x 32 bins).
    """
    inpainter = AutoencoderInpainter.load(path)
    metrics: dict[str, float] = {}
    for kind, is_relief in (("scan", False), ("relief", True)):
        numbers = [
            i
            for i, mesh in enumerate(m for m in corpus.meshes("validation") if m["count"])
            if mesh["name"].startswith("procedural_") == is_relief
        ]
        held_out = corpus.patches("validation")
        heights = clean_heights(PatchSet([held_out.shards[i] for i in numbers]))
        if len(heights):
            metrics[f"{kind}_n_patches"] = float(len(heights))
            metrics |= {f"{kind}_{key}": value for key, value in _measure(inpainter, heights).items()}
    return metrics


def clean_heights(patches: PatchSet) -> FloatArray:
    """Choose patches that are known in every bin, evenly: (n, N, N) float64, in patch lengths."""
    if not len(patches):
        return np.zeros((0, 1, 1))
    arrays = patches.gather(spread_rows(len(patches), 2 * MAX_PATCHES))
    clean = arrays["heights"][arrays["known"].all(axis=(1, 2))]
    return clean[spread_rows(len(clean), MAX_PATCHES)].astype(np.float64)


def _measure(inpainter: AutoencoderInpainter, heights: FloatArray) -> dict[str, float]:
    measures: dict[str, float] = {}
    for share in HOLE_SHARES:
        known = disk(inpainter.resolution, share)
        hidden = np.where(known, heights, 0.0)
        predicted = inpainter.predict(_patches(hidden, known), np.zeros_like(hidden))
        error = _error(predicted, heights, known)
        name = f"hole_{round(100 * share)}"
        measures[f"{name}_error"] = error
        if inpainter.resolution <= MAX_PLATE_RESOLUTION:
            for other, order in (("plate", 2), ("membrane", 1)):
                measures[f"{name}_to_{other}"] = error / _error(smooth_fill(hidden, known, order), heights, known)
    return {key: round(value, 5) for key, value in measures.items()}


def _patches(heights: FloatArray, known: BoolArray) -> Patches:
    """Heights in patch lengths as patches of length 1, each with the same mask."""
    n = len(heights)
    masks = np.broadcast_to(known, heights.shape)
    frames = np.tile(np.eye(3), (n, 1, 1))
    return Patches(np.zeros((n, 3)), frames, 1.0, heights, masks, masks, np.zeros(heights.shape, np.int64))


def _error(filled: FloatArray, truth: FloatArray, known: BoolArray) -> float:
    return float(np.sqrt(((filled - truth)[:, ~known] ** 2).mean()))
