from pathlib import Path

import numpy as np
import pytest
import torch

from quadpatch.errors import OptionError
from tests.training.patches import small_task
from training.checkpoint import load_checkpoint
from training.errors import CheckpointError, DivergedError
from training.processes import Place
from training.trainer import Interrupted, Status, Trainer, TrainOptions

pytestmark = pytest.mark.slow

PLACE = Place(torch.device("cpu"))
SHORT = TrainOptions(steps=12, batch=8, precision="float32", n_validations=4)


def weights(trainer: Trainer) -> list[torch.Tensor]:
    return [value.clone() for value in trainer.module.state_dict().values()]


def assert_equal_bits(one: Trainer, two: Trainer) -> None:
    assert all(torch.equal(a, b) for a, b in zip(weights(one), weights(two), strict=True))
    assert one.state.validation == two.state.validation


@pytest.mark.parametrize("stop_at", [1, 6, 7])
def test_a_run_that_goes_on_ends_in_the_same_bits_as_one_that_never_stopped(tmp_path: Path, stop_at: int) -> None:
    straight = Trainer(small_task(), SHORT, PLACE)
    straight.run()
    first, file = Trainer(small_task(), SHORT, PLACE), tmp_path / "run.checkpoint"
    with pytest.raises(Interrupted):
        first.run(file, is_stopping=lambda: first.state.step == stop_at)
    second = Trainer(small_task(), SHORT, PLACE)
    second.resume(file)
    assert second.state.step == stop_at
    second.run()
    assert_equal_bits(second, straight)


def test_the_same_seed_gives_the_same_bits_and_another_seed_others() -> None:
    one, two, other = (
        Trainer(small_task(), TrainOptions(steps=3, batch=8, precision="float32", seed=seed), PLACE)
        for seed in (1, 1, 2)
    )
    for trainer in (one, two, other):
        trainer.run()
    assert_equal_bits(one, two)
    assert not torch.equal(weights(one)[0], weights(other)[0])


def test_training_lowers_the_loss_on_patches_that_were_never_shown() -> None:
    trainer = Trainer(small_task(256), TrainOptions(steps=80, batch=32, rate=3e-3, precision="float32"), PLACE)
    heard: list[Status] = []
    trainer.run(report=heard.append)
    losses = [loss for _, loss in trainer.state.validation]
    assert trainer.state.best_loss == min(losses) < 0.6 * losses[0]
    assert [status.step for status in heard] == list(range(10, 81, 10))
    assert heard[-1].fraction == 1.0
    assert heard[-1].remaining_s == 0.0
    assert heard[-1].loss < heard[0].loss


def test_the_best_weights_are_kept_not_the_last() -> None:
    trainer = Trainer(small_task(), TrainOptions(steps=12, batch=8, rate=0.5, precision="float32", patience=99), PLACE)
    trainer.run()
    best = min(loss for _, loss in trainer.state.validation)
    with torch.inference_mode():
        trainer.module.eval()
        (batch,) = trainer.task.validation(16, PLACE.device)
        assert float(trainer.task.loss(trainer.module, batch)) == pytest.approx(best, rel=1e-6)


def test_a_run_that_gains_nothing_stops_early() -> None:
    options = TrainOptions(steps=1000, batch=8, rate=1e-12, precision="float32", n_validations=1000, patience=3)
    trainer = Trainer(small_task(), options, PLACE)
    trainer.module.requires_grad_(False)
    list(trainer.module.parameters())[-1].requires_grad_(True)
    trainer.run()
    assert 3 < trainer.state.step < 1000
    assert trainer.state.n_stale == 3


def test_a_budget_of_minutes_ends_a_run_and_counts_all_sittings(tmp_path: Path) -> None:
    options = TrainOptions(steps=None, minutes=0.02, batch=8, precision="float32")
    trainer = Trainer(small_task(), options, PLACE)
    trainer.run(tmp_path / "run.checkpoint")
    assert trainer.state.fraction == 1.0
    assert trainer.state.elapsed_s >= 1.2
    again = Trainer(small_task(), options, PLACE)
    again.resume(tmp_path / "run.checkpoint")
    again.run()
    assert_equal_bits(again, trainer)


def test_a_larger_budget_goes_on_and_a_smaller_one_ends_at_once(tmp_path: Path) -> None:
    file = tmp_path / "run.checkpoint"
    Trainer(small_task(), SHORT, PLACE).run(file)
    for steps, expected in ((16, 16), (6, 12)):
        options = TrainOptions(steps=steps, batch=8, precision="float32", n_validations=4)
        trainer = Trainer(small_task(), options, PLACE)
        trainer.resume(file)
        trainer.run()
        assert trainer.state.step == expected


def test_a_run_stopped_before_its_first_validation_can_end_there(tmp_path: Path) -> None:
    file = tmp_path / "run.checkpoint"
    first = Trainer(small_task(), SHORT, PLACE)
    with pytest.raises(Interrupted):
        first.run(file, is_stopping=lambda: True)
    trainer = Trainer(small_task(), TrainOptions(steps=1, batch=8, precision="float32"), PLACE)
    trainer.resume(file)
    trainer.run()
    assert [step for step, _ in trainer.state.validation] == [1]


@pytest.mark.parametrize(
    ("change", "fact"),
    [
        ({"seed": 1}, "seed"),
        ({"batch": 16}, "batch"),
        ({"rate": 1e-3}, "rate"),
        ({"weight_decay": 0.0}, "weight_decay"),
    ],
)
def test_the_checkpoint_of_another_run_is_refused(tmp_path: Path, change: dict[str, float], fact: str) -> None:
    file = tmp_path / "run.checkpoint"
    trainer = Trainer(small_task(), SHORT, PLACE)
    trainer.save(file)
    other = TrainOptions(**{**vars(SHORT), **change})
    with pytest.raises(CheckpointError, match=f"its {fact} is"):
        Trainer(small_task(), other, PLACE).resume(file)
    with pytest.raises(CheckpointError, match="its architecture is small_4x, here it is none"):
        load_checkpoint(file, {**trainer.identity(), "architecture": "none"}, PLACE.device)


def test_bfloat16_comes_close_to_float32() -> None:
    """Eight bits of every number are enough for gradients."""
    losses = []
    for precision in ("float32", "bfloat16"):
        options = TrainOptions(steps=15, batch=8, rate=3e-3, precision=precision)
        trainer = Trainer(small_task(), options, PLACE)
        trainer.run()
        assert next(trainer.module.parameters()).dtype == torch.float32
        losses.append(trainer.state.best_loss)
    assert losses[1] == pytest.approx(losses[0], rel=0.1)


def test_a_run_that_diverges_says_so() -> None:
    trainer = Trainer(small_task(), TrainOptions(steps=20, batch=8, rate=1e30, precision="float32"), PLACE)
    with pytest.raises(DivergedError, match="--rate"):
        trainer.run()


def test_a_run_needs_a_budget_and_a_batch_that_its_processes_can_share() -> None:
    with pytest.raises(OptionError, match="budget"):
        TrainOptions(steps=None)
    with pytest.raises(OptionError, match="evenly"):
        Trainer(small_task(), SHORT, Place(torch.device("cpu"), 0, 3))


def test_the_rate_rises_and_falls_to_nothing() -> None:
    trainer = Trainer(small_task(), TrainOptions(steps=1000, rate=1.0, precision="float32"), PLACE)
    rates = []
    for step in range(1000):
        trainer.state.step, trainer.state.fraction = step, step / 1000
        rates.append(trainer._rate())
    assert np.argmax(rates) == pytest.approx(100, abs=5)
    assert (np.diff(rates[:95]) > 0).all()
    assert (np.diff(rates[100:]) < 0).all()
    assert rates[-1] < 1e-5
