"""From a network file back to a network that can be trained further."""

from pathlib import Path

import onnx
import torch
from google.protobuf.message import DecodeError
from onnx import numpy_helper

from quadpatch.errors import ModelError
from quadpatch.networks.residual import Residual

_PREFIX = "0."


def load_residual(path: Path) -> Residual:
    """Read the weights of a network `residual` from its ONNX file, where they carry their names.

    Raises
    ------
    ModelError
        If the file holds another network.
    """
    try:
        tensors = onnx.load(path).graph.initializer
        # The export wraps the network: its names stand behind a prefix there.
        weights = {t.name.removeprefix(_PREFIX): torch.from_numpy(numpy_helper.to_array(t).copy()) for t in tensors}
        network = Residual()
        network.load_state_dict({name: weights[name] for name in network.state_dict()})
    except (DecodeError, OSError, ValueError, KeyError, RuntimeError) as error:
        raise ModelError(f"{path.name} holds no network 'residual' that could be trained further: {error}") from error
    return network
