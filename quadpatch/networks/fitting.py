"""Fitting the network `residual` to one mesh: it is trained on that mesh's own undamaged surface.

Steps are what counts: the same mesh, options and seed take the same steps on any machine, however busy. Whether to go
on is decided by the error on calibration holes, which nothing is learned from (L. Prechelt, "Early Stopping - But
When?", 1998), of a running mean of the weights (B. Polyak, A. Juditsky, "Acceleration of Stochastic Approximation by
Averaging", 1992): long before the rate has fallen it says what the weights come to.
"""

import copy
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np
import torch
from torch import Tensor

from quadpatch.calibration.training_pairs import TrainingPairs, make_training_pairs
from quadpatch.inpainters.inpainter import Fitting, FittingEnd, UndamagedSurface
from quadpatch.networks.precision import has_fast_bfloat16, one_thread
from quadpatch.networks.residual import Residual, errors, rotated
from quadpatch.options import NetworkOptions
from quadpatch.patches.residual_input import RESOLUTION, corrected, network_input
from quadpatch.progress import Progress, no_progress
from quadpatch.types import FloatArray, Patches

BATCH = 64
RATE = 4e-3
# Steps over which the rate rises; from its full height it falls in a line, to zero where all steps are done.
WARM_UP = 50
# Weight of the past in the running mean of the weights; less in the first steps.
_MEMORY = 0.98
# Steps between two looks at the calibration holes. As long as these gain, every look brings a round of training pairs.
CHECK = 50
# Fitting ends after so many looks without a gain of at least this share.
PATIENCE = 2
LEAST_GAIN = 0.01
# More training pairs than this, or more rounds of them, gain nothing that would be worth their seconds.
ENOUGH_PAIRS = 5000
MAX_ROUNDS = 6
MIN_PAIRS = 64
# Longest gradient, over all weights, that one step follows.
_LONGEST_GRADIENT = 1.0
_SIDES = (-2, -1)
# Patches in one run of the network.
_RUN = 256

# Channels, corrections, loss masks.
_Tensors = tuple[Tensor, ...]


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
    fitting : Fitting or None
        How it was fitted; None before.
    """

    network: Residual
    options: NetworkOptions
    seed: int = 0
    progress: Progress = no_progress
    fitting: Fitting | None = None

    @property
    def resolution(self) -> int:
        """Bins along one side of its patches."""
        return RESOLUTION

    def fitted_to(self, undamaged: UndamagedSurface) -> "FittingInpainter":
        """See `Inpainter`. The weights stay as they are where others don't do better on calibration holes."""
        held_out = undamaged.held_out() if undamaged.held_out else None
        if held_out is None or not held_out.loss_mask.any():
            return replace(self, fitting=Fitting(self.options.steps, 0, "no_calibration"))
        rounds = islice(
            make_training_pairs(undamaged.training_surface(), np.random.default_rng([self.seed, 3])), MAX_ROUNDS
        )
        network, fitting = fit(self.network, rounds, held_out, self.options, seed=self.seed, progress=self.progress)
        return replace(self, network=network, fitting=fitting)

    def predict(self, patches: Patches, base_heights: FloatArray) -> FloatArray:
        """See `Inpainter`: the mean of what the network answers to each patch in its four turns."""
        seen = network_input(patches, base_heights)
        answers = np.zeros((len(patches), RESOLUTION, RESOLUTION))
        with torch.inference_mode(), one_thread():
            for start in range(0, len(patches), _RUN):
                part = torch.from_numpy(seen.channels[start : start + _RUN])
                turned = [_answer(self.network, part.rot90(turn, _SIDES)).rot90(-turn, _SIDES) for turn in range(4)]
                answers[start : start + _RUN] = torch.stack(turned).mean(dim=0)[:, 0].numpy()
        return corrected(patches, seen.deviation, answers)


def fit(  # noqa: PLR0913  the clock is there for tests
    network: Residual,
    rounds: Iterator[TrainingPairs],
    held_out: TrainingPairs,
    options: NetworkOptions,
    *,
    seed: int,
    progress: Progress = no_progress,
    clock: Callable[[], float] = time.monotonic,
) -> tuple[Residual, Fitting]:
    """Train a copy of a network, as long as it gains.

    Parameters
    ----------
    network : Residual
    rounds : iterator of TrainingPairs
        To learn from; one more is taken whenever the last steps have gained.
    held_out : TrainingPairs
        To judge by.
    options : NetworkOptions
    seed : int
    progress : callable
        Told the share of the steps that is done, as stage `learn`.
    clock : callable
        Gives the seconds by which a limit on time goes.

    Returns
    -------
    network : Residual
        The weights with the least error on what is held out, perhaps those from before.
    fitting : Fitting
    """
    started = clock()

    def is_over() -> bool:
        return options.seconds is not None and clock() - started >= options.seconds

    with one_thread():
        pool, judge, random = _Pool(rounds), _tensors(held_out), torch.Generator().manual_seed(seed)
        trained, best = _Trained(network, options.steps), network
        before = least = _error(network, judge)
        step = idle = 0
        end: FittingEnd | None = None if len(pool) >= MIN_PAIRS else "no_room"
        while end is None:
            wanted, done = min(CHECK, options.steps - step), 0
            while done < wanted and not is_over():
                trained.follow(pool.batch(random))
                done += 1
                progress("learn", (step + done) / options.steps)
            step += done
            error = _error(trained.averaged, judge) if done else least
            if error < (1.0 - LEAST_GAIN) * least:
                best, least, idle = copy.deepcopy(trained.averaged), error, 0
                pool.grow()
            else:
                idle += 1
            end = _end(step, done < wanted, idle == PATIENCE, least < before, options)
    return best, Fitting(options.steps, step, end, len(pool), before, least)


def _end(step: int, is_over: bool, is_settled: bool, has_gained: bool, options: NetworkOptions) -> FittingEnd | None:
    """Say why fitting ends, or None where it goes on."""
    if is_over:
        return "seconds"
    if is_settled:
        return "settled" if has_gained else "no_gain"
    return "steps" if step == options.steps else None


class _Pool:
    """Training pairs to draw from, of more and more rounds.

    Parameters
    ----------
    rounds : iterator of TrainingPairs
        The first ones, enough to begin with, are taken at once.
    """

    def __init__(self, rounds: Iterator[TrainingPairs]) -> None:
        self._rounds, self._tensors = rounds, _tensors(TrainingPairs.joined([], RESOLUTION))
        for pairs in rounds:
            self._add(pairs)
            if len(self) >= MIN_PAIRS:
                break

    def __len__(self) -> int:
        """Count of pairs."""
        return len(self._tensors[0])

    def grow(self) -> None:
        """Take one more round, if there is one and pairs are not enough."""
        pairs = next(self._rounds, None) if len(self) < ENOUGH_PAIRS else None
        if pairs is not None:
            self._add(pairs)

    def batch(self, random: torch.Generator) -> _Tensors:
        """Draw pairs with repeats, turned and mirrored together."""
        chosen = torch.randint(0, len(self), (BATCH,), generator=random)
        turn = int(torch.randint(0, 8, (1,), generator=random).item())
        return rotated(tuple(tensor[chosen] for tensor in self._tensors), turn % 4, mirrored=turn >= 4)

    def _add(self, pairs: TrainingPairs) -> None:
        self._tensors = tuple(torch.cat(both) for both in zip(self._tensors, _tensors(pairs), strict=True))


class _Trained:
    """A copy of a network on its way, and the running mean of its weights."""

    def __init__(self, network: Residual, steps: int) -> None:
        self._network, self.averaged = copy.deepcopy(network), copy.deepcopy(network)
        self._network.to(memory_format=torch.channels_last)  # type: ignore[call-overload]  # torch's own stubs lack it
        self._optimiser = torch.optim.AdamW(self._network.parameters(), RATE, weight_decay=1e-2, fused=True)
        self._step, self._steps = 0, steps

    def follow(self, batch: _Tensors) -> None:
        """Take one step."""
        channels, correction, loss_mask = batch
        for group in self._optimiser.param_groups:
            group["lr"] = RATE * min((self._step + 1) / WARM_UP, 1.0 - self._step / self._steps)
        self._step += 1
        loss = errors(_answer(self._network, channels), correction, loss_mask).loss
        self._optimiser.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        torch.nn.utils.clip_grad_norm_(self._network.parameters(), _LONGEST_GRADIENT)
        self._optimiser.step()
        memory = min(_MEMORY, self._step / (self._step + 9))
        with torch.no_grad():
            for mean, now in zip(self.averaged.parameters(), self._network.parameters(), strict=True):
                mean.lerp_(now, 1.0 - memory)


def _error(network: Residual, pairs: _Tensors) -> float:
    """Mean error on pairs, with that of the slopes, in standard deviations."""
    channels, correction, loss_mask = pairs
    with torch.inference_mode():
        answers = [_answer(network, part) for part in torch.split(channels, _RUN)]
        return float(errors(torch.cat(answers), correction, loss_mask).loss)


def _answer(network: Residual, channels: Tensor) -> Tensor:
    with torch.autocast("cpu", torch.bfloat16, enabled=has_fast_bfloat16()):
        answer: Tensor = network(channels.contiguous(memory_format=torch.channels_last))
    return answer.float()


def _tensors(pairs: TrainingPairs) -> _Tensors:
    arrays = pairs.channels, pairs.correction[:, None], pairs.loss_mask[:, None]
    return tuple(torch.from_numpy(array) for array in arrays)
