import subprocess
import sys
from pathlib import Path

import numpy as np
import onnx
import pytest
import torch

from quadpatch.errors import OptionError
from tests.training.patches import write_corpus
from tests.training.test_network_run import call
from tests.waiting import GUARD_S
from training.processes import Place, take_place

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(("size", "n"), [(12, 1), (12, 4), (7, 3)])
def test_the_shares_of_a_batch_are_the_batch(size: int, n: int) -> None:
    rows = list(range(size))
    shares = [rows[Place(torch.device("cpu"), rank, n).share(size)] for rank in range(n)]
    assert [row for share in shares for row in share] == rows


def test_one_process_agrees_with_itself() -> None:
    with take_place("cpu") as place:
        assert place.is_first
        assert place.most(1.0, 2.0) == place.total(1.0, 2.0) == [1.0, 2.0]


def test_a_device_that_is_not_there_is_refused() -> None:
    with pytest.raises(OptionError, match="auto, cpu, cuda"), take_place("abacus"):
        pass


@pytest.mark.skipif(torch.cuda.is_available(), reason="a GPU is there, so it is not refused")
def test_a_gpu_that_is_not_there_is_refused() -> None:
    with pytest.raises(OptionError, match="no GPU"), take_place("cuda"):
        pass


def training(folder: Path) -> list[str]:
    """Return the command of a few steps; the network lands in the folder."""
    command = ["network", "--arch", "small_4x", "--corpus", str(folder.parent / "corpus"), "--name", "x"]
    command += ["--output", str(folder / "x.onnx")]
    return [*command, "--steps", "6", "--batch", "8", "--precision", "float32", "--device", "cpu"]


def train_together(folder: Path) -> subprocess.CompletedProcess[str]:
    """Train in two processes."""
    launcher = ["-m", "torch.distributed.run", "--standalone", "--nproc-per-node", "2"]
    command = [sys.executable, "-W", "error", *launcher, "-m", "training", *training(folder)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=GUARD_S, check=False)


def weights(folder: Path) -> dict[str, np.ndarray]:
    model = onnx.load(folder / "x.onnx")
    return {tensor.name: onnx.numpy_helper.to_array(tensor) for tensor in model.graph.initializer}


@pytest.mark.slow
def test_two_processes_train_the_network_that_one_would(tmp_path: Path) -> None:
    write_corpus(tmp_path / "corpus")
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    call(*training(tmp_path / "one"))
    together = train_together(tmp_path / "two")
    assert together.returncode == 0, together.stderr
    # Only the first process talks.
    assert together.stderr.count("wrote ") == 1
    one, two = weights(tmp_path / "one"), weights(tmp_path / "two")
    assert one.keys() == two.keys()
    for name, array in one.items():
        np.testing.assert_allclose(two[name], array, rtol=0.0, atol=1e-5)
