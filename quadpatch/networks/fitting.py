"""Fitting the network `residual` to one mesh: it is trained on that mesh's own undamaged surface."""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np
import torch
from torch import Tensor

from quadpatch.calibration.training_pairs import TrainingPairs, make_training_pairs
from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.networks.precision import has_fast_bfloat16
from quadpatch.networks.residual import Residual, errors, rotated
from quadpatch.options import NetworkOptions
from quadpatch.patches.residual_input import RESOLUTION, corrected, network_input
from quadpatch.progress import Progress, no_progress
from quadpatch.types import FloatArray, Patches

BATCH = 64
RATE = 4e-3
# Steps over which the rate rises to its full height.
WARM_UP = 50
# More training pairs than this add seconds, not quality; fewer rounds than this show too few places.
ENOUGH_PAIRS = 8000
MAX_ROUNDS = 8
MIN_PAIRS = 64
# Of the time there is, what cutting training pairs may take.
CUTTING_SHARE = 0.4
# Longest gradient, over all weights, that one step follows.
_LONGEST_GRADIENT = 1.0
# Patches in one run of the network.
_RUN = 256


@dataclass(frozen=True)
class FittingInpainter:
    """The network, before it is fitted (`fitted_to`) and afterwards.

    Attributes
    ----------
    network : Residual
    options : NetworkOptions
    seed : int
    progress : callable
        Told the share of the steps that is done, as stage `learn`.
    """

    network: Residual
    options: NetworkOptions
    seed: int = 0
    progress: Progress = no_progress

    @property
    def resolution(self) -> int:
        """Bins along one side of its patches."""
        return RESOLUTION

    def fitted_to(self, undamaged: UndamagedSurface) -> "FittingInpainter":
        """See `Inpainter`. Leaves the weights as they are where the mesh has no room to cut any."""
        started = time.monotonic()
        cutting_s = CUTTING_SHARE * self.options.seconds
        pairs = collect_training_pairs(undamaged, self.seed, cutting_s, self._first_part)
        if len(pairs) < MIN_PAIRS:
            return self
        network = Residual()
        network.load_state_dict(self.network.state_dict())
        remaining_s = self.options.seconds - (time.monotonic() - started)
        fit(network, pairs, replace(self.options, seconds=max(remaining_s, 1e-3)), self.seed, self._second_part)
        return replace(self, network=network)

    def _first_part(self, stage: str, fraction: float) -> None:
        self.progress(stage, CUTTING_SHARE * fraction)

    def _second_part(self, stage: str, fraction: float) -> None:
        self.progress(stage, CUTTING_SHARE + (1.0 - CUTTING_SHARE) * fraction)

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        """See `Inpainter`."""
        seen = network_input(patches, base_heights)
        answers = [np.zeros((0, RESOLUTION, RESOLUTION), np.float32)]
        with torch.inference_mode():
            for start in range(0, len(patches), _RUN):
                part = torch.from_numpy(seen.channels[start : start + _RUN])
                answers.append(self.network(part)[:, 0].numpy())
        return corrected(patches, seen.deviation, np.concatenate(answers).astype(np.float64))


def collect_training_pairs(
    undamaged: UndamagedSurface, seed: int, seconds: float = np.inf, progress: Progress = no_progress
) -> TrainingPairs:
    """Cut pairs until there are enough, or another round would come too often to the same places, or too late."""
    started, parts = time.monotonic(), list[TrainingPairs]()
    for part in islice(make_training_pairs(undamaged.training_surface(), np.random.default_rng([seed, 3])), MAX_ROUNDS):
        parts.append(part)
        done = max(sum(len(part) for part in parts) / ENOUGH_PAIRS, (time.monotonic() - started) / seconds)
        progress("learn", min(done, 1.0))
        if done >= 1.0:
            break
    return TrainingPairs.joined(parts, RESOLUTION)


def fit(
    network: Residual,
    pairs: TrainingPairs,
    options: NetworkOptions,
    seed: int,
    progress: Progress = no_progress,
    clock: Callable[[], float] = time.monotonic,
) -> int:
    """Train a network in place.

    The rate falls along a cosine that ends with the steps, or with the time where that is shorter. The outcome is the
    same bits for the same seed as long as the time does not run ahead of the steps.

    Parameters
    ----------
    network : Residual
    pairs : TrainingPairs
    options : NetworkOptions
    seed : int
    progress : callable
        Told the share that is done, as stage `learn`.
    clock : callable
        Gives the seconds by which the limit on time goes.

    Returns
    -------
    int
        Steps done.
    """
    random = torch.Generator().manual_seed(seed)
    arrays = pairs.channels, pairs.correction[:, None], pairs.loss_mask[:, None]
    tensors = tuple(torch.from_numpy(array) for array in arrays)
    network.to(memory_format=torch.channels_last)  # type: ignore[call-overload]  # torch's own stubs lack it
    optimiser = torch.optim.AdamW(network.parameters(), RATE, weight_decay=1e-2)
    started = clock()
    for step in range(options.steps):
        done = _share_done(step / options.steps, 1 / options.steps, (clock() - started) / max(options.seconds, 1e-9))
        if done >= 1.0:
            return step
        for group in optimiser.param_groups:
            group["lr"] = RATE * min(1.0, (step + 1) / WARM_UP) * 0.5 * (1 + np.cos(np.pi * done))
        _step(network, optimiser, _batch(tensors, random))
        progress("learn", done)
    return options.steps


def _share_done(of_steps: float, one_step: float, of_time: float) -> float:
    """Share of the schedule that is done: by time only where that is ahead by a step, for time never comes twice."""
    return of_time if of_time >= min(of_steps + one_step, 1.0) else of_steps


def _batch(tensors: tuple[Tensor, ...], random: torch.Generator) -> tuple[Tensor, ...]:
    chosen = torch.randint(0, len(tensors[0]), (BATCH,), generator=random)
    turn = int(torch.randint(0, 8, (1,), generator=random).item())
    return rotated(tuple(tensor[chosen] for tensor in tensors), turn % 4, mirrored=turn >= 4)


def _step(network: Residual, optimiser: torch.optim.Optimizer, batch: tuple[Tensor, ...]) -> None:
    channels, correction, loss_mask = batch
    with torch.autocast("cpu", torch.bfloat16, enabled=has_fast_bfloat16()):
        answer = network(channels.contiguous(memory_format=torch.channels_last))
    loss = errors(answer.float(), correction, loss_mask).loss
    optimiser.zero_grad()
    loss.backward()  # type: ignore[no-untyped-call]
    torch.nn.utils.clip_grad_norm_(network.parameters(), _LONGEST_GRADIENT)
    optimiser.step()
