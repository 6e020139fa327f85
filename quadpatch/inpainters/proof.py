"""Proof of a model file: that it is what it says, and answers as the method needs it.

It is opened as a repair opens it, so it is run in a process that may be killed: a network may loop, or take any amount
of memory. What is proven here is checked by no repair again.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadpatch.errors import ModelError
from quadpatch.inpainters.model_file import load_model
from quadpatch.inpainters.onnx_network import BATCH, AutoencoderInpainter
from quadpatch.inpainters.onnx_parts import check_parts
from quadpatch.patches.residual_input import LARGEST

_SEED = 0
# Patches of a probe: one alone, and as many as a repair hands over at once.
_PROBES = (1, BATCH)


def prove_model(path: str | Path, card: dict[str, Any] | None = None) -> None:
    """Prove that a model file can be used.

    Parameters
    ----------
    path : str or Path
        `.safetensors` for a dictionary; `.onnx` for a network.
    card : dict, optional
        Of a network, in place of the one in its file.

    Raises
    ------
    ModelError
        If a check fails; its message says which one. Of a dictionary: one matrix of finite columns of unit norm, as the
        card says, and a known normalisation. Of a network: standard operators, all weights in the file, one input and
        one output of the shapes and types that the card declares, and finite answers on probes, the same each time.
    """
    path = Path(path)
    if load_model(path).kind == "dictionary":
        return
    check_parts(path.read_bytes(), path.name)
    network = AutoencoderInpainter.load(path, card)
    _check_output(network, path.name)
    for n_patches in _PROBES:
        probe = _probe(network, n_patches)
        answer = _answer(network, probe, path.name)
        if not np.array_equal(answer, _answer(network, probe, path.name)):
            raise ModelError(f"{path.name}: the same patches got two different answers")


def _check_output(network: AutoencoderInpainter, name: str) -> None:
    """Hold what the network declares of its output against what is wanted; dimensions may be left open."""
    (output,) = network.session.get_outputs()
    wanted = [1, network.resolution, network.resolution]
    declared = list(output.shape or [])
    fits = len(declared) == 4 and all(
        side == size or not isinstance(side, int) for side, size in zip(declared[1:], wanted, strict=True)
    )
    if output.type != "tensor(float)" or not fits:
        raise ModelError(f"{name} gives {output.type} {output.shape}; wanted is float (batch, {wanted})")


def _probe(network: AutoencoderInpainter, n_patches: int) -> NDArray[np.float32]:
    """Make seeded patches (n, c, N, N) in the ranges of the recipe, half of their bins unknown."""
    rng = np.random.default_rng(_SEED)
    shape = (n_patches, network.resolution, network.resolution)
    known = rng.random(shape) < 0.5
    if network.recipe == "paper":
        return np.where(known, rng.random(shape), 1.0)[:, None].astype(np.float32)
    detail = np.clip(rng.normal(size=shape), -LARGEST, LARGEST)
    return np.stack([detail, known], axis=1, dtype=np.float32)


def _answer(network: AutoencoderInpainter, probe: NDArray[np.float32], name: str) -> NDArray[np.float32]:
    (feed,) = network.session.get_inputs()
    try:
        answer = np.asarray(network.session.run(None, {feed.name: probe})[0])
    except Exception as error:
        # onnxruntime raises a dozen classes of its own, and none of them is public.
        raise ModelError(f"{name} can't answer {len(probe)} patches: {error}") from error
    wanted = (len(probe), 1, network.resolution, network.resolution)
    if answer.shape != wanted or answer.dtype != np.float32:
        raise ModelError(f"{name} answers {len(probe)} patches by {answer.dtype} {answer.shape}; wanted is {wanted}")
    if not np.isfinite(answer).all():
        raise ModelError(f"{name} answers {len(probe)} patches by values that are not finite")
    return answer
