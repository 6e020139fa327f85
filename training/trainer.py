"""The training loop for every network: AdamW, warm-up and cosine, validation, early stopping, checkpoints.

Batches follow from the seed and the number of the step alone, so a run that goes on from a checkpoint makes the same
steps as one that never stopped: on one kind of processor, in float32 on the CPU, bit for bit.
"""

import math
import time
from collections import deque
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import torch
from torch import Tensor

from quadpatch.errors import OptionError
from training.checkpoint import Checkpoint, TrainingState, load_checkpoint, save_checkpoint
from training.errors import DivergedError
from training.processes import Place
from training.task import Task

# Steps until the full rate: the first gradients of fresh weights point anywhere.
WARM_UP_STEPS = 100
# Asking a GPU for the loss means waiting for it.
REPORT_EVERY = 10


@dataclass(frozen=True)
class TrainOptions:
    """How to train, and for how long.

    Attributes
    ----------
    steps : int or None
        At most so many; None: as many as the minutes allow.
    minutes : float or None
        At most so long, all sittings together.
    batch : int
        Patches in a step, over all processes.
    rate : float
        Learning rate after the warm-up; a cosine takes it to 0 at the end of the budget.
    weight_decay : float
    seed : int
        Of first weights and batches.
    precision : str
        Of the network's matrix products: `float32`, `bfloat16`, or `auto`, bfloat16 where it is faster.
    n_validations : int
        Over the whole budget.
    patience : int
        Stop after so many validations without gain.
    """

    steps: int | None = 2000
    minutes: float | None = None
    batch: int = 128
    rate: float = 2e-3
    weight_decay: float = 1e-4
    seed: int = 0
    precision: Literal["auto", "float32", "bfloat16"] = "auto"
    n_validations: int = 20
    patience: int = 6

    def __post_init__(self) -> None:
        """Refuse a run without an end."""
        if self.steps is None and self.minutes is None:
            raise OptionError("a training run needs a budget: steps, minutes or both")


@dataclass(frozen=True)
class Status:
    """How a run stands, for the person who watches it.

    Attributes
    ----------
    step : int
    fraction : float
        Of the budget that is used up.
    loss : float
        Training loss, averaged over the last steps.
    validation_loss : float
        The latest; NaN before the first.
    patches_per_s, remaining_s : float
    """

    step: int
    fraction: float
    loss: float
    validation_loss: float
    patches_per_s: float
    remaining_s: float


class Interrupted(Exception):  # noqa: N818 - an event, not an error
    """The run was asked to stop; its checkpoint is written."""


class Trainer:
    """One run: the network, the optimiser and how far they have come.

    Parameters
    ----------
    task : Task
    options : TrainOptions
    place : Place

    Raises
    ------
    OptionError
        If the processes can't share a batch evenly.
    """

    def __init__(self, task: Task, options: TrainOptions, place: Place) -> None:
        if options.batch % place.n_processes:
            raise OptionError(f"a batch of {options.batch} can't be shared evenly by {place.n_processes} processes")
        self.task, self.options, self.place = task, options, place
        torch.manual_seed(options.seed)
        module = task.build().to(place.device)
        self.module = module.to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self.distributed_module = place.distributed(self.module)
        self.optimizer = torch.optim.AdamW(self.module.parameters(), lr=options.rate, weight_decay=options.weight_decay)
        self.state = TrainingState()
        wants_bfloat16 = options.precision == "bfloat16" or (options.precision == "auto" and place.has_bfloat16)
        self.precision = torch.bfloat16 if wants_bfloat16 else torch.float32
        self._losses: deque[Tensor] = deque(maxlen=REPORT_EVERY)

    def identity(self) -> dict[str, Any]:
        """Return what a checkpoint of this run must agree with; the budget may be another one."""
        options = self.options
        chosen = {"seed": options.seed, "batch": options.batch, "rate": options.rate}
        return {**self.task.identity(), **chosen, "weight_decay": options.weight_decay}

    def save(self, path: Path) -> None:
        """Write a checkpoint, if this process is the one that writes."""
        if self.place.is_first:
            weights, optimizer = self.module.state_dict(), self.optimizer.state_dict()
            save_checkpoint(path, Checkpoint(self.identity(), self.state, weights, optimizer))

    def resume(self, path: Path) -> None:
        """Go on from a checkpoint of this run; raises CheckpointError."""
        checkpoint = load_checkpoint(path, self.identity(), self.place.device)
        self.module.load_state_dict(checkpoint.weights)
        self.optimizer.load_state_dict(checkpoint.optimizer)
        self.state = checkpoint.state

    def run(
        self,
        checkpoint: Path | None = None,
        report: Callable[[Status], None] | None = None,
        is_stopping: Callable[[], bool] = lambda: False,
    ) -> TrainingState:
        """Train until the budget is spent or nothing is gained any more; leave the best weights in `module`.

        Parameters
        ----------
        checkpoint : Path, optional
            Written after every validation and when the run is stopped.
        report : callable, optional
            Told every few steps how the run stands.
        is_stopping : callable, optional
            Asked after every step.

        Raises
        ------
        Interrupted
            If it said so; the checkpoint is written before.
        DivergedError
            If the loss is no number any more.
        """
        state, options = self.state, self.options
        # The budget may be another one than before a break.
        state.fraction = self._fraction()
        sitting = _Sitting(state)
        while state.fraction < 1.0 and state.n_stale < options.patience:
            self._step()
            stop, elapsed_s = self.place.most(float(is_stopping()), sitting.elapsed_s())
            state.elapsed_s = elapsed_s
            before, state.fraction = state.fraction, self._fraction()
            if math.floor(state.fraction * options.n_validations) > math.floor(before * options.n_validations):
                self._validate()
                if checkpoint is not None:
                    self.save(checkpoint)
            if report is not None and (state.step % REPORT_EVERY == 0 or state.fraction >= 1.0):
                report(self._status(sitting))
            if stop:
                if checkpoint is not None:
                    self.save(checkpoint)
                raise Interrupted
        if not state.best:
            # Gone on from before the first validation, with a smaller budget than what is already spent.
            self._validate()
        self.module.load_state_dict(state.best)
        return state

    def _fraction(self) -> float:
        steps, minutes = self.options.steps, self.options.minutes
        by_steps = self.state.step / steps if steps else 0.0
        by_time = self.state.elapsed_s / (60.0 * minutes) if minutes else 0.0
        return min(max(by_steps, by_time), 1.0)

    def _rate(self) -> float:
        """Learning rate of the step to come."""
        warm = min(1.0, (self.state.step + 1) / WARM_UP_STEPS)
        return self.options.rate * warm * 0.5 * (1.0 + math.cos(math.pi * self.state.fraction))

    def _step(self) -> None:
        options, place = self.options, self.place
        for group in self.optimizer.param_groups:
            group["lr"] = self._rate()
        rng = np.random.default_rng([options.seed, self.state.step])
        batch = self.task.batch(rng, options.batch, place.share(options.batch), place.device)
        self.distributed_module.train()
        with self._autocast():
            loss = self.task.loss(self.distributed_module, batch)
        self.optimizer.zero_grad(set_to_none=True)
        loss.backward()  # type: ignore[no-untyped-call]
        self.optimizer.step()
        self._losses.append(loss.detach())
        self.state.step += 1

    def _autocast(self) -> Any:
        if self.precision is torch.float32:
            return nullcontext()
        return torch.autocast(self.place.device.type, dtype=self.precision)

    def _validate(self) -> None:
        """Measure in float32, each process on its share, and keep the weights if they are the best so far."""
        state, place = self.state, self.place
        self.module.eval()
        total, count = 0.0, 0
        with torch.inference_mode():
            for number, batch in enumerate(self.task.validation(self.options.batch, place.device)):
                if number % place.n_processes == place.rank:
                    total += float(self.task.loss(self.module, batch)) * len(batch[0])
                    count += len(batch[0])
        total, all_count = place.total(total, float(count))
        loss = total / max(all_count, 1.0)
        if not math.isfinite(loss):
            raise DivergedError(f"the validation loss is {loss} after {state.step} steps; take a lower --rate")
        state.validation.append((state.step, loss))
        state.n_stale += 1
        if loss < state.best_loss:
            state.best_loss, state.n_stale = loss, 0
            state.best = {name: value.detach().cpu().clone() for name, value in self.module.state_dict().items()}

    def _status(self, sitting: "_Sitting") -> Status:
        state = self.state
        loss = float(torch.stack(list(self._losses)).mean())
        speed, remaining_s = sitting.speed()
        validation_loss = state.validation[-1][1] if state.validation else math.nan
        return Status(state.step, state.fraction, loss, validation_loss, speed * self.options.batch, remaining_s)


class _Sitting:
    """Clock of one sitting at a run that may take several."""

    def __init__(self, state: TrainingState) -> None:
        self._state, self._start = state, time.perf_counter()
        self._first_step, self._first_fraction, self._before_s = state.step, state.fraction, state.elapsed_s

    def elapsed_s(self) -> float:
        """Return the seconds of all sittings."""
        return self._before_s + time.perf_counter() - self._start

    def speed(self) -> tuple[float, float]:
        """Return the steps a second in this sitting, and for how many seconds it will go on at this speed."""
        spent_s = max(time.perf_counter() - self._start, 1e-9)
        used = self._state.fraction - self._first_fraction
        remaining_s = spent_s * (1.0 - self._state.fraction) / used if used > 0 else math.inf
        return (self._state.step - self._first_step) / spent_s, remaining_s
