"""The networks that can be trained, by name."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from torch import nn

from quadpatch.errors import OptionError
from quadpatch.networks.residual import Residual
from quadpatch.patches.residual_input import CHANNELS, RESOLUTION
from training.autoencoder import PLANS, build


@dataclass(frozen=True)
class Architecture:
    """A network to be trained.

    Attributes
    ----------
    name : str
    resolution : int
        Bins along one side of its patches.
    recipe : str
        How patches are prepared for it, one of `quadpatch.inpainters.onnx_network.RECIPES`; a corpus is cut for one.
    channels : int
        Of its input.
    build : callable
        Makes the module; its weights follow from torch's generator.
    output : callable
        Makes the module that turns what the network gives in training into what a repair reads.
    """

    name: str
    resolution: int
    recipe: str
    channels: int
    build: Callable[[], nn.Module]
    output: Callable[[], nn.Module] = nn.Identity


ARCHITECTURES = {
    name: Architecture(name, plan.resolution, "paper", 1, partial(build, name), nn.Sigmoid)
    for name, plan in PLANS.items()
} | {"residual": Architecture("residual", RESOLUTION, "residual", CHANNELS, Residual)}


def find_architecture(name: str) -> Architecture:
    """Return the architecture of that name.

    Raises
    ------
    OptionError
        If there is none.
    """
    if name not in ARCHITECTURES:
        raise OptionError(f"no network is called {name!r}; there are {', '.join(ARCHITECTURES)}")
    return ARCHITECTURES[name]
