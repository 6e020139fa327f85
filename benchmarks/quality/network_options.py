"""What the experiment with the paper's networks is asked to do. Light: torch is loaded where networks are trained."""

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
class NetworkOptions:
    """Which networks are trained on what, and for how long.

    Attributes
    ----------
    architectures : sequence of str
        Names of `training.autoencoder.PLANS`.
    protocols : sequence of str
        Some of `PROTOCOLS`.
    budget : Budget
    """

    architectures: Sequence[str] = ("small_4x",)
    protocols: Sequence[Protocol] = ("local",)
    budget: Budget = Budget()
