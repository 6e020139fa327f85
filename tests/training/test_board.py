from importlib.util import find_spec
from pathlib import Path

import pytest

from training.board import Board
from training.errors import MissingExtraError
from training.trainer import Status

HAS_TENSORBOARD = find_spec("tensorboard") is not None


@pytest.mark.skipif(HAS_TENSORBOARD, reason="TensorBoard is installed, so it is not missing")
def test_without_tensorboard_the_extra_is_named(tmp_path: Path) -> None:
    with pytest.raises(MissingExtraError, match="extra `tensorboard`"):
        Board(tmp_path)


@pytest.mark.skipif(not HAS_TENSORBOARD, reason="TensorBoard is an extra that is not installed here")
def test_curves_land_in_the_folder(tmp_path: Path) -> None:
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator  # noqa: PLC0415

    board = Board(tmp_path)
    board.show(Status(10, 0.5, 0.25, float("nan"), 100.0, 10.0))
    board.show(Status(20, 1.0, 0.125, 0.5, 100.0, 0.0))
    board.close()
    read = EventAccumulator(str(tmp_path)).Reload()
    assert [(event.step, event.value) for event in read.Scalars("loss/training")] == [(10, 0.25), (20, 0.125)]
    assert [(event.step, event.value) for event in read.Scalars("loss/validation")] == [(20, 0.5)]
