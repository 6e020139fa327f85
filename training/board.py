"""Curves for TensorBoard, for those who want them: an extra of the installation."""

import math
from pathlib import Path
from typing import Any

from training.errors import MissingExtraError
from training.trainer import Status


class Board:
    """Writes how a run stands into a folder that TensorBoard reads.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    MissingExtraError
        If TensorBoard is not installed.
    """

    def __init__(self, folder: Path) -> None:
        try:
            from torch.utils.tensorboard import SummaryWriter  # noqa: PLC0415 - an extra that may be missing
        except ImportError as error:
            raise MissingExtraError("--tensorboard needs the extra `tensorboard`: pip install tensorboard") from error
        self._writer: Any = SummaryWriter(str(folder))

    def show(self, status: Status) -> None:
        """Add a point to every curve."""
        self._writer.add_scalar("loss/training", status.loss, status.step)
        if math.isfinite(status.validation_loss):
            self._writer.add_scalar("loss/validation", status.validation_loss, status.step)
        self._writer.add_scalar("patches a second", status.patches_per_s, status.step)

    def close(self) -> None:
        """Write what is left."""
        self._writer.close()
