"""Networks in whole numbers: weights and what flows between layers as int8, a quarter of the size.

Whether that is faster depends on the processor (`python -m benchmarks.networks`); it always costs some accuracy, which
the card states.

Tested in `tests/training/test_export.py`.
"""

import logging
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import onnx

import quadpatch.inpainters.onnx_runtime  # noqa: F401  first: it switches the telemetry off

# isort: split
from onnxruntime.quantization import CalibrationDataReader, QuantFormat, QuantType, quantize_static

from training.export import INPUT

# Enough to see the usual range of every layer.
CALIBRATION_BATCH = 64

Inputs = np.ndarray[Any, np.dtype[np.float32]]


class _Calibration(CalibrationDataReader):  # type: ignore[misc]
    """Hands training patches to onnxruntime, a batch at a time."""

    def __init__(self, patches: Inputs) -> None:
        self._starts = iter(range(0, len(patches), CALIBRATION_BATCH))
        self._patches = patches

    def get_next(self) -> dict[str, Inputs] | None:
        """Return the next batch; None after the last."""
        start = next(self._starts, None)
        return None if start is None else {INPUT: self._patches[start : start + CALIBRATION_BATCH]}


def to_int8(model: Any, patches: Inputs) -> Any:
    """Quantise a network.

    Parameters
    ----------
    model : onnx.ModelProto
    patches : (n, c, N, N) float32
        Inputs as in training; they show the range of every layer.

    Returns
    -------
    onnx.ModelProto
        Takes and gives float32 as before.
    """
    root = logging.getLogger()
    level = root.level
    root.setLevel(logging.ERROR)
    try:
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            # onnxruntime advises a clean-up pass that these graphs have nothing to offer.
            warnings.simplefilter("ignore")
            source, target = Path(folder, "float32.onnx"), Path(folder, "int8.onnx")
            onnx.save(model, source)
            quantize_static(
                source,
                target,
                _Calibration(patches),
                quant_format=QuantFormat.QDQ,
                per_channel=True,
                activation_type=QuantType.QUInt8,
                weight_type=QuantType.QInt8,
            )
            quantised = onnx.load(target)
    finally:
        root.setLevel(level)
    quantised.producer_name, quantised.producer_version = "quadpatch", ""
    return quantised
