"""A worn or small piece is repaired by what another mesh of its kind shows."""

from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import OptionError
from quadpatch.formats.reading import read_scan
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_and_keep
from tests.quadpatch.shapes import open_grid, punched, relief, write_ply

WHOLE = relief(100, 2.0, 0.03, 10)
HOLES = [(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.45, 0.5)]


@pytest.fixture
def damaged(tmp_path: Path) -> Path:
    return write_ply(tmp_path / "damaged.ply", punched(WHOLE, *HOLES, radius=0.1))


def test_the_other_mesh_shows_what_is_gone(damaged: Path, tmp_path: Path) -> None:
    reference = write_ply(tmp_path / "whole.ply", WHOLE)
    errors = []
    for model, learn_from in (("smooth", None), ("self", reference)):
        done = repair_and_keep(damaged, tmp_path / "out.ply", model, learn_from=learn_from)
        new = read_scan(tmp_path / "out.ply").vertices[len(WHOLE.vertices) :]
        x, y = 10 * np.pi * new[:, 0], 10 * np.pi * new[:, 1]
        truth = 0.03 * (np.sin(x) * np.cos(y) + np.sin(y) * np.cos(0.3) + np.sin(0.3) * np.cos(x))
        errors.append(np.abs(new[:, 2] - truth).mean())
    assert done.report["counts"]["filled"] >= 2
    assert len(done.report["model"]["learned_from"]) == 64
    assert errors[1] < 0.9 * errors[0]


def test_the_same_bytes_come_again(damaged: Path, tmp_path: Path) -> None:
    reference = write_ply(tmp_path / "whole.ply", WHOLE)
    for name in ("a.ply", "b.ply"):
        repair_and_keep(damaged, tmp_path / name, "self", learn_from=reference)
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()


def test_a_mesh_that_shows_nothing_leaves_the_holes_to_geometry(damaged: Path, tmp_path: Path) -> None:
    flat = write_ply(tmp_path / "flat.ply", open_grid(40, 2.0))
    done = repair_and_keep(damaged, tmp_path / "out.ply", "self", learn_from=flat)
    assert done.report["counts"]["filled_smooth"] == 4


@pytest.mark.parametrize(("model", "options"), [("smooth", RepairOptions()), ("self", RepairOptions(recipe="paper"))])
def test_another_model_or_recipe_learns_from_no_other_mesh(
    model: str, options: RepairOptions, damaged: Path, tmp_path: Path
) -> None:
    with pytest.raises(OptionError, match="learn_from"):
        repair_and_keep(damaged, tmp_path / "out.ply", model, options, learn_from=damaged)
