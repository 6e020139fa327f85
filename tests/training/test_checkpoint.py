from pathlib import Path

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from training.checkpoint import Checkpoint, TrainingState, load_checkpoint, save_checkpoint
from training.errors import CheckpointError

CPU = torch.device("cpu")
IDENTITY = {"architecture": "small_4x", "seed": 3}


def some_checkpoint() -> Checkpoint:
    weights = {"layer.weight": torch.arange(6.0).reshape(2, 3)}
    state = TrainingState(7, 1.5, 0.25, [(4, 0.5), (6, 0.25)], 0.25, {"layer.weight": torch.ones(2, 3)}, 1)
    optimizer = {"state": {0: {"step": torch.tensor(7.0)}}, "param_groups": [{"lr": 0.1, "betas": (0.9, 0.999)}]}
    return Checkpoint(IDENTITY, state, weights, optimizer)


def test_a_checkpoint_comes_back_as_it_was(tmp_path: Path) -> None:
    saved = some_checkpoint()
    save_checkpoint(tmp_path / "new" / "run.checkpoint", saved)
    loaded = load_checkpoint(tmp_path / "new" / "run.checkpoint", IDENTITY, CPU)
    assert {**vars(loaded.state), "best": None} == {**vars(saved.state), "best": None}
    assert torch.equal(loaded.state.best["layer.weight"], saved.state.best["layer.weight"])
    assert torch.equal(loaded.weights["layer.weight"], saved.weights["layer.weight"])
    assert loaded.optimizer == saved.optimizer
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["run.checkpoint"]


def test_a_checkpoint_that_can_not_be_written_leaves_the_one_before(tmp_path: Path) -> None:
    file = tmp_path / "run.checkpoint"
    save_checkpoint(file, some_checkpoint())
    before = file.read_bytes()
    broken = Checkpoint(IDENTITY, TrainingState(), {"layer": (i for i in range(3))}, {})
    with pytest.raises(TypeError):
        save_checkpoint(file, broken)
    assert file.read_bytes() == before


@given(data=st.binary(max_size=100), keep=st.integers(0, 3000))
def test_damaged_bytes_are_no_checkpoint(tmp_path_factory: pytest.TempPathFactory, data: bytes, keep: int) -> None:
    file = tmp_path_factory.mktemp("run") / "run.checkpoint"
    save_checkpoint(file, some_checkpoint())
    whole = file.read_bytes()
    file.write_bytes(whole[: min(keep, len(whole) - 200)] + data)
    with pytest.raises(CheckpointError, match="no checkpoint"):
        load_checkpoint(file, IDENTITY, CPU)


def test_pickles_that_run_code_are_refused(tmp_path: Path) -> None:
    torch.save({"format": 1, "state": Path("danger")}, tmp_path / "run.checkpoint")
    with pytest.raises(CheckpointError, match="no checkpoint"):
        load_checkpoint(tmp_path / "run.checkpoint", IDENTITY, CPU)


@pytest.mark.parametrize("other", [{**IDENTITY, "seed": 4}, {"architecture": "small_4x"}, {**IDENTITY, "batch": 8}])
def test_the_checkpoint_of_another_run_is_refused(tmp_path: Path, other: dict[str, int]) -> None:
    save_checkpoint(tmp_path / "run.checkpoint", some_checkpoint())
    with pytest.raises(CheckpointError, match="belongs to another run"):
        load_checkpoint(tmp_path / "run.checkpoint", other, CPU)


def test_no_file_is_no_checkpoint(tmp_path: Path) -> None:
    with pytest.raises(CheckpointError, match="no checkpoint"):
        load_checkpoint(tmp_path / "run.checkpoint", IDENTITY, CPU)
