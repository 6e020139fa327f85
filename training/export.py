"""Trained networks as ONNX files: the same bytes for the same weights, with the card inside.

Everything that the exporter writes down about this machine is taken out: file names, line numbers, versions.
"""

import json
import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import torch
from torch import nn

from quadpatch.formats.output_files import write_whole
from quadpatch.inpainters.onnx_runtime import ort
from quadpatch_rules.dictionary_file import Card
from training.errors import ExportError
from training.pixel_shuffle import with_pixel_shuffle

# Largest difference between what torch and onnxruntime answer.
PARITY = 1e-5
# Patches in one run: two of them, so that a file which takes a single one only is found out.
PARITY_BATCHES = (1, 3)
INPUT, OUTPUT = "patches", "clean"


def to_onnx(module: nn.Module, channels: int, resolution: int) -> Any:
    """Export a network and hold it against itself.

    Parameters
    ----------
    module : nn.Module
        Takes (n, channels, N, N) float32, gives (n, 1, N, N).
    channels, resolution : int

    Returns
    -------
    onnx.ModelProto
        Takes any count of patches.

    Raises
    ------
    ExportError
        If onnxruntime answers otherwise than torch, by more than `PARITY`.
    """
    module = module.to("cpu", torch.float32).eval()
    example = torch.rand(2, channels, resolution, resolution, generator=torch.Generator().manual_seed(0))
    with _quiet():
        program = torch.onnx.export(
            with_pixel_shuffle(module),
            (example,),
            input_names=[INPUT],
            output_names=[OUTPUT],
            dynamic_shapes=({0: torch.export.Dim("batch")},),
            dynamo=True,
            verbose=False,
        )
    if program is None:
        raise ExportError("torch exported nothing")
    model = program.model_proto
    _forget_machine(model)
    difference = _largest_difference(module, model, channels, resolution)
    if not difference <= PARITY:
        raise ExportError(f"onnxruntime and torch differ by {difference:.3g}; the limit is {PARITY:g}")
    return model


def write_network(path: Path, model: Any, card: Card) -> None:
    """Write a network with its card, whole or not at all.

    Parameters
    ----------
    path : Path
    model : onnx.ModelProto
        Its metadata become the card alone.
    card : dict
        JSON-ready; `kind` is added.
    """
    del model.metadata_props[:]
    text = json.dumps({"kind": "autoencoder", **card}, sort_keys=True, allow_nan=False)
    onnx.helper.set_model_props(model, {"card": text})
    write_whole(path, model.SerializeToString(deterministic=True))


def run_onnx(model: Any, patches: "np.ndarray[Any, np.dtype[np.float32]]") -> "np.ndarray[Any, np.dtype[np.float32]]":
    """Run a network (onnx.ModelProto) on one thread."""
    options = ort.SessionOptions()
    options.intra_op_num_threads = 1
    options.log_severity_level = 4
    session = ort.InferenceSession(model.SerializeToString(), options, providers=["CPUExecutionProvider"])
    result: np.ndarray[Any, np.dtype[np.float32]] = session.run(None, {session.get_inputs()[0].name: patches})[0]
    return result


def _largest_difference(module: nn.Module, model: Any, channels: int, resolution: int) -> float:
    rng, largest = np.random.default_rng(0), 0.0
    for count in PARITY_BATCHES:
        patches = rng.random((count, channels, resolution, resolution), dtype=np.float32)
        with torch.inference_mode():
            expected = module(torch.from_numpy(patches)).numpy()
        # Not max(): it would drop a NaN.
        largest = float(np.maximum(largest, np.abs(run_onnx(model, patches) - expected).max()))
    return largest


def _forget_machine(model: Any) -> None:
    model.producer_name, model.producer_version, model.doc_string = "quadpatch", "", ""
    del model.metadata_props[:]
    graph = model.graph
    graph.doc_string, graph.name = "", "network"
    del graph.metadata_props[:]
    for part in (*graph.node, *graph.input, *graph.output, *graph.value_info, *graph.initializer):
        part.doc_string = ""
        del part.metadata_props[:]


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep the exporter from telling users about packages that they do not need."""
    logger = logging.getLogger("torch.onnx")
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        logger.setLevel(before)
