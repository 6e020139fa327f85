"""Speed of networks: ``python -m benchmarks.networks FILES.onnx``.

Runs each file as a worker does and says how much of the processor it uses: its floating point operations a second, and
their share of the rate at which a float32 matrix product of the same threads runs. Only multiplications by weights that
are not 0 count, so a layer padded with zeros can't look better than it is. Without a file, the paper's networks are
measured, with fresh weights, as they would be exported (6x_128_FC, of 700 MB, only by name).
"""

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from rich.console import Console
from rich.table import Table
from threadpoolctl import threadpool_limits

from quadpatch.inpainters.onnx_network import BATCH, THREADS
from quadpatch.inpainters.onnx_runtime import ort

MATRIX_SIDE = 2048
ROUNDS = 7


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0] if __doc__ else None)
    parser.add_argument("files", nargs="*", type=Path, help="ONNX networks; none: the paper's, with fresh weights")
    parser.add_argument("--batch", type=int, default=BATCH, help="patches in one run")
    parser.add_argument("--threads", type=int, default=THREADS)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, threadpool_limits(arguments.threads):
        files = arguments.files or fresh_networks(Path(folder))
        table = Table("network", "MFLOP a patch", "ms a patch", "GFLOP/s", "of the matrix rate")
        for path in files:
            table.add_row(path.stem, *measure(path, arguments.batch, arguments.threads))
    table.title = f"batches of {arguments.batch}, {arguments.threads} threads"
    Console().print(table)


def measure(path: Path, batch: int, threads: int) -> list[str]:
    """Time a network and matrix products in turns, so that a busy machine slows both down; the best round counts."""
    options = ort.SessionOptions()
    options.intra_op_num_threads, options.inter_op_num_threads = threads, 1
    options.use_deterministic_compute = True
    session = ort.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
    (entry,) = session.get_inputs()
    rng = np.random.default_rng(0)
    patches = rng.random((batch, *entry.shape[1:]), dtype=np.float32)
    matrix = rng.random((MATRIX_SIDE, MATRIX_SIDE), dtype=np.float32)
    session.run(None, {entry.name: patches})
    runs, products = [], []
    for _ in range(ROUNDS):
        runs.append(_seconds(lambda: session.run(None, {entry.name: patches})) / batch)
        products.append(_seconds(lambda: matrix @ matrix))
    n_flop = count_flop(onnx.load(path), patches)
    rate, matrix_rate = n_flop / min(runs), 2 * MATRIX_SIDE**3 / min(products)
    share = f"{rate / matrix_rate:.0%} of {matrix_rate / 1e9:.0f}"
    return [f"{n_flop / 1e6:,.1f}", f"{1000 * min(runs):.3f}", f"{rate / 1e9:.1f}", share]


def count_flop(model: Any, patches: "np.ndarray[Any, np.dtype[np.float32]]") -> float:
    """Count the multiplications and additions for one patch, by weights (onnx.ModelProto) that are not 0."""
    weights = {tensor.name: onnx.numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    for node in model.graph.node:
        if node.op_type == "DequantizeLinear" and node.input[0] in weights:
            weights[node.output[0]] = weights[node.input[0]]
    counted = [node for node in model.graph.node if node.op_type in ("Conv", "ConvTranspose", "Gemm", "MatMul")]
    sides = _sides(model, patches)
    n_flop = 0.0
    for node in counted:
        weight = weights.get(node.input[1])
        if weight is not None:
            # Every weight meets every place of the output of a convolution, or of the input of one that is
            # transposed.
            grid = sides[node.input[0] if node.op_type == "ConvTranspose" else node.output[0]][2:]
            n_flop += 2.0 * np.count_nonzero(weight) * float(np.prod(grid))
    return n_flop


def fresh_networks(folder: Path) -> list[Path]:
    """Export the paper's networks with fresh weights."""
    from torch import nn  # noqa: PLC0415 - an extra

    from training.architectures import ARCHITECTURES  # noqa: PLC0415
    from training.export import to_onnx, write_network  # noqa: PLC0415

    files = []
    for name, architecture in ARCHITECTURES.items():
        if architecture.recipe == "paper" and name != "6x_128_FC":
            module = nn.Sequential(architecture.build(), architecture.output())
            files.append(folder / f"{name}.onnx")
            write_network(files[-1], to_onnx(module, architecture.channels, architecture.resolution), {})
    return files


def _sides(model: Any, patches: "np.ndarray[Any, np.dtype[np.float32]]") -> dict[str, tuple[int, ...]]:
    """Shapes of all values for one patch, by running the network and handing out everything in between."""
    known = {value.name for value in model.graph.output}
    inner = [name for node in model.graph.node for name in node.output if name not in known]
    model.graph.output.extend(onnx.helper.make_empty_tensor_value_info(name) for name in inner)
    options = ort.SessionOptions()
    options.log_severity_level = 4
    session = ort.InferenceSession(model.SerializeToString(), options, providers=["CPUExecutionProvider"])
    names = [value.name for value in session.get_outputs()]
    shapes = [value.shape for value in session.run(names, {session.get_inputs()[0].name: patches[:1]})]
    return {**dict(zip(names, shapes, strict=True)), session.get_inputs()[0].name: patches[:1].shape}


def _seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


if __name__ == "__main__":
    main()
