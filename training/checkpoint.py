"""Checkpoints: everything that a training run needs to go on as if it had never stopped."""

import io
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from quadpatch.formats.output_files import write_whole
from training.errors import CheckpointError

FORMAT = 1


@dataclass
class TrainingState:
    """How far a run has come; changes with every step.

    Attributes
    ----------
    step : int
        Steps made.
    elapsed_s : float
        Seconds spent so far, all sittings together.
    fraction : float
        Of the budget that is used up, 0 to 1.
    validation : list of (int, float)
        Step and validation loss.
    best_loss : float
    best : dict of str to Tensor
        Weights with that loss, on the CPU.
    n_stale : int
        Validations since then.
    """

    step: int = 0
    elapsed_s: float = 0.0
    fraction: float = 0.0
    validation: list[tuple[int, float]] = field(default_factory=list)
    best_loss: float = float("inf")
    best: dict[str, Tensor] = field(default_factory=dict)
    n_stale: int = 0


@dataclass(frozen=True)
class Checkpoint:
    """What a checkpoint file holds.

    Attributes
    ----------
    identity : dict
        What run it belongs to.
    state : TrainingState
    weights, optimizer : dict
        As torch gives them.
    """

    identity: dict[str, Any]
    state: TrainingState
    weights: dict[str, Any]
    optimizer: dict[str, Any]


def save_checkpoint(path: Path, checkpoint: Checkpoint) -> None:
    """Write a checkpoint, whole or not at all: a crash leaves the file before it."""
    content = {**vars(checkpoint), "state": vars(checkpoint.state), "format": FORMAT}
    path.parent.mkdir(parents=True, exist_ok=True)
    data = io.BytesIO()
    torch.save(content, data)
    write_whole(path, data.getvalue())


def load_checkpoint(path: Path, identity: dict[str, Any], device: torch.device) -> Checkpoint:
    """Read the checkpoint of a run.

    Parameters
    ----------
    path : Path
    identity : dict
        Of the run that is to go on.
    device : torch.device

    Raises
    ------
    CheckpointError
        If the file is no checkpoint, or that of another run.
    """
    try:
        content = torch.load(path, map_location=device, weights_only=True)
        if content.pop("format") != FORMAT:
            raise CheckpointError(f"{path} is a checkpoint of another version")
        best = {name: tensor.cpu() for name, tensor in content["state"].pop("best").items()}
        state = TrainingState(**content.pop("state"), best=best)
        checkpoint = Checkpoint(**content, state=state)
    except CheckpointError:
        raise
    except Exception as e:
        # Damaged bytes make torch's reader raise a dozen classes, index and struct errors among them.
        raise CheckpointError(f"{path} is no checkpoint: {e}") from e
    for key in identity.keys() | checkpoint.identity.keys():
        was, wanted = checkpoint.identity.get(key), identity.get(key)
        if was != wanted:
            raise CheckpointError(f"{path} belongs to another run: its {key} is {was}, here it is {wanted}")
    return checkpoint
