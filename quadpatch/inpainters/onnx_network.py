"""Completion of patches by a convolutional network (section 5 of the paper), run by onnxruntime.

A network file carries its facts in its ONNX metadata under `card`, a JSON
object with `kind` = `autoencoder`, `patch_resolution` N and `recipe`:

- `paper`: one channel of heights, scaled so that `height_low`..`height_high` (in patch lengths) becomes
  0..`scaled_high`, unknown bins 1; the output is the clean patch in the same scale. Heights are over the plane of the
  patch through the smoothed surface; networks whose `normalisation` is `heights-mean-range` see them less the mean of
  the known bins.
- `residual`: two channels and an answer as in `quadpatch.patches.residual_input`.

Sessions must not cross a fork: create the inpainter in the process that uses it.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quadpatch.errors import ModelError
from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.inpainters.onnx_runtime import ort
from quadpatch.patches.residual_input import CHANNELS, corrected, network_input
from quadpatch.types import BoolArray, FloatArray, Patches

RECIPES = ("paper", "residual")
# What cards call the heights of paper networks: as they are, or less the mean of the known bins.
RAW_HEIGHTS = "heights-range"
CENTRED_HEIGHTS = "heights-mean-range"
MAX_RESOLUTION = 128
# Patches in one run: enough to keep two cores busy, small enough for wide networks' activations.
BATCH = 64
THREADS = 2


@dataclass(frozen=True)
class PaperScale:
    """Heights of a training set: `low`..`high` (in patch lengths) becomes 0..`scaled_high`."""

    low: float
    high: float
    scaled_high: float = 0.83
    is_centred: bool = False


@dataclass(frozen=True)
class AutoencoderInpainter:
    """A network and how its patches are prepared."""

    session: ort.InferenceSession
    resolution: int
    recipe: str
    scale: PaperScale | None
    card: dict[str, Any]

    @classmethod
    def load(cls, path: Path, card: dict[str, Any] | None = None) -> "AutoencoderInpainter":
        """Open a network file.

        Parameters
        ----------
        path : Path
        card : dict, optional
            In place of the one in the file's metadata.

        Raises
        ------
        ModelError
            If the file is no network that this project can run.
        """
        options = ort.SessionOptions()
        options.intra_op_num_threads = THREADS
        options.inter_op_num_threads = 1
        options.use_deterministic_compute = True
        options.log_severity_level = 4
        try:
            session = ort.InferenceSession(path.read_bytes(), options, providers=["CPUExecutionProvider"])
        except Exception as error:
            # onnxruntime raises a dozen classes of its own, and none of them is public.
            raise ModelError(f"{path.name} is no network that onnxruntime can run: {error}") from error
        card = _card(session, path.name) if card is None else card
        resolution, recipe = card.get("patch_resolution"), card.get("recipe")
        if not isinstance(resolution, int) or not 8 <= resolution <= MAX_RESOLUTION:
            raise ModelError(
                f"{path.name}: patch_resolution must lie between 8 and {MAX_RESOLUTION}; it is {resolution}"
            )
        if recipe not in RECIPES:
            raise ModelError(f"{path.name}: recipe {recipe!r} is not known; known are {', '.join(RECIPES)}")
        scale = _paper_scale(card, path.name) if recipe == "paper" else None
        _check_shapes(session, 1 if recipe == "paper" else CHANNELS, resolution, path.name)
        return cls(session, resolution, recipe, scale, card)

    def fitted_to(self, undamaged: UndamagedSurface) -> "AutoencoderInpainter":
        """See `Inpainter`; a network stays as it was trained."""
        return self

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        """See `Inpainter`."""
        if self.scale is not None:
            return self._predict_heights(patches, base_heights, self.scale)
        seen = network_input(patches, base_heights)
        return corrected(patches, seen.deviation, self.answer(seen.channels))

    def _predict_heights(self, patches: Patches, base_heights: FloatArray, scale: PaperScale) -> FloatArray:
        # The paper's seeds lie on the smoothed surface; those of the default recipe in the planes of quads.
        level = (_mean_of_known(patches.heights, patches.known) if scale.is_centred else _at_centre(base_heights))[
            :, None, None
        ]
        span = (scale.high - scale.low) * patches.length
        low = scale.low * patches.length
        scaled = (patches.heights - level - low) / span * scale.scaled_high
        scaled = np.where(patches.known, np.clip(scaled, 0.0, scale.scaled_high), 1.0)
        clean = self.answer(scaled[:, None].astype(np.float32))
        return level + low + clean / scale.scaled_high * span

    def answer(self, inputs: "np.ndarray[Any, np.dtype[np.float32]]") -> FloatArray:
        """Run (n, c, N, N) float32 in batches: (n, N, N) float64."""
        name = self.session.get_inputs()[0].name
        outputs = [np.zeros((0, self.resolution, self.resolution))]
        for start in range(0, len(inputs), BATCH):
            (result,) = self.session.run(None, {name: inputs[start : start + BATCH]})
            outputs.append(result[:, 0].astype(np.float64))
        values = np.concatenate(outputs)
        if not np.isfinite(values).all():
            raise ModelError("the network gave values that are not finite")
        return values


def _card(session: ort.InferenceSession, name: str) -> dict[str, Any]:
    text = session.get_modelmeta().custom_metadata_map.get("card")
    if text is None:
        raise ModelError(f"{name} has no card in its metadata")
    try:
        card = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ModelError(f"the card of {name} is no JSON: {error}") from error
    if not isinstance(card, dict) or card.get("kind") != "autoencoder":
        raise ModelError(f"the card of {name} is not that of an autoencoder")
    return card


def _paper_scale(card: dict[str, Any], name: str) -> PaperScale:
    try:
        # Cards from before there were two kinds say nothing.
        is_centred = card.get("normalisation", CENTRED_HEIGHTS) == CENTRED_HEIGHTS
        scaled_high = float(card.get("scaled_high", 0.83))
        scale = PaperScale(float(card["height_low"]), float(card["height_high"]), scaled_high, is_centred)
    except (KeyError, TypeError, ValueError) as error:
        raise ModelError(f"{name}: the card lacks height_low and height_high") from error
    if not (np.isfinite([scale.low, scale.high]).all() and scale.low < scale.high and 0 < scale.scaled_high <= 1):
        raise ModelError(f"{name}: heights from {scale.low} to {scale.high} are no range")
    return scale


def _check_shapes(session: ort.InferenceSession, channels: int, resolution: int, name: str) -> None:
    inputs, outputs = session.get_inputs(), session.get_outputs()
    if len(inputs) != 1 or len(outputs) != 1:
        raise ModelError(f"{name} has {len(inputs)} inputs and {len(outputs)} outputs; one of each is wanted")
    wanted = [channels, resolution, resolution]
    if list(inputs[0].shape[1:]) != wanted or inputs[0].type != "tensor(float)":
        raise ModelError(f"{name} takes {inputs[0].type} {inputs[0].shape}; wanted is float (batch, {wanted})")


def _mean_of_known(values: FloatArray, known: BoolArray) -> FloatArray:
    count = np.maximum(known.sum(axis=(1, 2)), 1)
    mean: FloatArray = np.where(known, values, 0.0).sum(axis=(1, 2)) / count
    return mean


def _at_centre(maps: FloatArray) -> FloatArray:
    """Mean (n,) of the two by two bins around the centre of each map."""
    middle = maps.shape[-1] // 2
    mean: FloatArray = maps[:, middle - 1 : middle + 1, middle - 1 : middle + 1].mean(axis=(1, 2))
    return mean
