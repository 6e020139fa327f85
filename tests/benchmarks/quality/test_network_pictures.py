from pathlib import Path

import numpy as np
import pytest

from benchmarks.quality.network_pictures import choose_patches, completed_tiles, patch_picture
from tests.quadpatch.inpainters.test_onnx_network import PAPER, write_network
from tests.training.patches import waves
from training.shards import Arrays

ROW = 2


@pytest.fixture
def cut() -> dict[int, Arrays]:
    known = {n: np.ones((4, n, n), bool) for n in (16, 48)}
    return {n: {"heights": waves(4, n).astype(np.float32), "known": known[n]} for n in known}


def test_patches_are_chosen_evenly_among_those_known_in_every_bin() -> None:
    known = np.ones((10, 4, 4), bool)
    known[[0, 4], 1, 1] = False
    assert choose_patches(known, range(0, 10, 2), 2) == [2, 8]
    assert choose_patches(known, [0, 4], 2) == []


def test_a_network_changes_the_hole_alone_and_tells_how_wrong_it_is_there(
    cut: dict[int, Arrays], tmp_path: Path
) -> None:
    """It copies its input, in which unknown bins are 1: the top of its range."""
    network = write_network(tmp_path / "copy.onnx", PAPER, 1)
    tiles = completed_tiles("vase", ROW, cut, {"copy": network}, 0.5)
    assert list(tiles) == ["masked", "copy", "truth"]
    hole = np.isnan(tiles["masked"].heights)
    assert hole.mean() == pytest.approx(np.pi / 16, rel=0.05)
    assert (tiles["masked"].heights[~hole] == tiles["truth"].heights[~hole]).all()
    truth, copied = cut[16]["heights"][ROW], tiles["copy"].heights
    changed = np.abs(copied - truth) > 1e-6
    error = np.sqrt(((copied - truth)[changed] ** 2).mean())
    assert changed.mean() == pytest.approx(np.pi / 16, rel=0.1)
    assert np.ptp(copied[changed]) < 1e-6
    assert tiles["copy"].caption == f"{100 * error:.2f} %"


def test_the_picture_has_a_row_for_each_patch_and_a_column_for_each_tile(
    cut: dict[int, Arrays], tmp_path: Path
) -> None:
    network = write_network(tmp_path / "copy.onnx", PAPER, 1)
    rows = [completed_tiles("vase", row, cut, {"copy": network}, 0.5) for row in (0, 1)]
    figure = patch_picture(rows)
    figure.savefig(tmp_path / "patches.png")
    assert len(figure.axes) == 2 * 3
    assert [axes.get_title() for axes in figure.axes[:3]] == ["masked", "copy", "truth"]
