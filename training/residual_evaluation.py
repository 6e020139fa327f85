"""How much of the fill's error a published network `residual` takes away on training pairs that it has never seen."""

from pathlib import Path

import numpy as np

from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from training.paper_task import spread_rows
from training.shards import Corpus, PatchSet

# Of scans, and of procedural reliefs; enough for three digits.
MAX_PATCHES = 2000


def evaluate_residual(path: Path, corpus: Corpus) -> dict[str, float]:
    """Measure a network on the held-out training pairs of a corpus.

    Parameters
    ----------
    path : Path
        ONNX, with its card.
    corpus : Corpus

    Returns
    -------
    dict of str to float
        For scans and procedural reliefs apart: `scan_n_patches`, and `scan_to_fill`, the mean absolute error in the
        bins asked for, divided by that of the fill alone; 1 is a network that leaves every fill as it is.
    """
    inpainter = AutoencoderInpainter.load(path)
    held_out = corpus.patches("validation")
    meshes = [mesh for mesh in corpus.meshes("validation") if mesh["count"]]
    metrics: dict[str, float] = {}
    for kind, is_relief in (("scan", False), ("relief", True)):
        chosen = [i for i, mesh in enumerate(meshes) if mesh["name"].startswith("procedural_") == is_relief]
        patches = PatchSet([held_out.shards[i] for i in chosen])
        if len(patches):
            metrics |= {f"{kind}_{key}": value for key, value in _measure(inpainter, patches).items()}
    return metrics


def _measure(inpainter: AutoencoderInpainter, patches: PatchSet) -> dict[str, float]:
    arrays = patches.gather(spread_rows(len(patches), MAX_PATCHES))
    answers = inpainter.answer(arrays["channels"].astype(np.float32))
    correction, loss_mask = arrays["correction"].astype(np.float64), arrays["asked"]
    fill = np.abs(correction[loss_mask]).mean()
    network = np.abs((answers - correction)[loss_mask]).mean()
    return {"n_patches": float(len(answers)), "to_fill": round(float(network / fill), 5)}
