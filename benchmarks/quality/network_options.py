"""What the experiment with the paper's networks is asked to do. Light: torch is loaded where networks are trained.

Tested in `tests/benchmarks/quality/test_network_order.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

Protocol = Literal["local", "global", "leave-one-out"]
PROTOCOLS: tuple[Protocol, ...] = get_args(Protocol)


@dataclass(frozen=True)
class Budget:
    """For how long a network is trained, the same for every one.

    Attributes
    ----------
    minutes : float or None
    steps : int or None
        At most so many; with both, whichever is spent first.
    threads : int
        Of the processor.
    """

    minutes: float | None = 1.5
    steps: int | None = None
    threads: int = 1


@dataclass(frozen=True)
class Pace:
    """Patches in a step, learning rate, and the seed of first weights and batches."""

    batch: int
    rate: float
    seed: int = 0


@dataclass(frozen=True)
class Order:
    """Equal terms on which networks are ranked.

    Attributes
    ----------
    steps, batch : int
    rates : sequence of float
        Learning rates that are tried for each network.
    search_share : int
        Each is tried for so many times fewer steps.
    seeds : sequence of int
    threads : int
        Of the processor.
    """

    steps: int = 800
    batch: int = 16
    rates: Sequence[float] = (3e-4, 1e-3, 3e-3)
    search_share: int = 5
    seeds: Sequence[int] = (0, 1)
    threads: int = 1


@dataclass(frozen=True)
class NetworkOptions:
    """Which networks are trained on what, and for how long.

    Attributes
    ----------
    architectures : sequence of str
        Names of `training.autoencoder.PLANS`.
    protocols : sequence of str
        Some of `PROTOCOLS`.
    budget : Budget
    order : Order
        Of the experiment `network-order`, which has a budget of its own.
    """

    architectures: Sequence[str] = ("small_4x",)
    protocols: Sequence[Protocol] = ("local",)
    budget: Budget = Budget()
    order: Order = Order()
