from pathlib import Path

import numpy as np
import pytest
import torch
from torch import nn

from quadpatch.errors import ModelError
from quadpatch.inpainters.onnx_network import AutoencoderInpainter
from quadpatch.networks.residual import Residual
from quadpatch.networks.weights import load_residual
from quadpatch.patches.residual_input import CHANNELS, RESOLUTION
from tests.quadpatch.networks.made import random_tensor, stirred, write_residual
from training.architectures import find_architecture
from training.export import to_onnx, write_network

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def network() -> Residual:
    torch.manual_seed(7)
    return stirred(Residual())


@pytest.fixture(scope="module")
def file(network: Residual, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_residual(tmp_path_factory.mktemp("networks") / "own@1.onnx", network)


def test_weights_come_back_from_the_file_bit_for_bit(network: Residual, file: Path) -> None:
    wanted, found = network.state_dict(), load_residual(file).state_dict()
    assert list(found) == list(wanted)
    for name, weights in wanted.items():
        assert torch.equal(found[name], weights), name


def test_what_was_read_back_answers_as_the_file_does(file: Path) -> None:
    channels = random_tensor(3, 5, CHANNELS, RESOLUTION, RESOLUTION)
    session = AutoencoderInpainter.load(file).session
    (in_file,) = session.run(None, {session.get_inputs()[0].name: channels.numpy()})
    with torch.inference_mode():
        read_back = load_residual(file)(channels).numpy()
    np.testing.assert_allclose(read_back, in_file, atol=1e-5)


def test_what_was_read_back_can_be_trained_further(file: Path) -> None:
    network = load_residual(file)
    network(random_tensor(0, 1, CHANNELS, 16, 16)).sum().backward()
    assert all(parameter.grad is not None for parameter in network.parameters())


@pytest.fixture(params=["another architecture", "another width", "an empty file", "half a file", "nothing"])
def unusable(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    path = tmp_path / "other.onnx"
    if request.param == "another architecture":
        small = find_architecture("small_4x")
        module = nn.Sequential(small.build(), small.output())
        write_network(path, to_onnx(module, small.channels, small.resolution), {"recipe": "paper"})
    elif request.param == "another width":
        write_residual(path, Residual((8, 16)), 16)
    elif request.param == "half a file":
        write_residual(path, Residual(), 32)
        path.write_bytes(path.read_bytes()[:10_000])
    elif request.param == "an empty file":
        path.write_bytes(b"")
    return path


def test_a_file_that_holds_another_network_or_none_is_refused(unusable: Path) -> None:
    with pytest.raises(ModelError, match=r"other\.onnx holds no network 'residual'"):
        load_residual(unusable)
