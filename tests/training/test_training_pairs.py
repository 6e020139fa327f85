import numpy as np
import pytest

from quadpatch.patches.residual_input import LARGEST, RESOLUTION
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import open_grid
from training import training_pairs
from training.procedural import relief_mesh
from training.shards import Arrays
from training.training_pairs import HOLE_EDGES, cut_training_pairs


@pytest.fixture(scope="module")
def relief() -> TriangleMesh:
    return relief_mesh("scales", np.random.default_rng(0), 70)


@pytest.fixture(scope="module")
def cut(relief: TriangleMesh) -> Arrays:
    return cut_training_pairs(relief, 12, np.random.default_rng(0))


def test_training_pairs_are_small_on_disk_and_ask_in_invented_bins_only(cut: Arrays) -> None:
    channels, correction, loss_mask = cut["channels"], cut["correction"], cut["asked"]
    assert [array.dtype.name for array in (channels, correction, loss_mask)] == ["float16", "float16", "bool"]
    assert channels.shape == (len(channels), 2, RESOLUTION, RESOLUTION)
    assert correction.shape == loss_mask.shape == (len(channels), RESOLUTION, RESOLUTION)
    assert (channels[:, 1][loss_mask] == 0).all()
    assert (correction[~loss_mask] == 0).all()
    assert np.abs(correction[loss_mask].astype(float)).max() <= LARGEST
    assert np.abs(correction[loss_mask].astype(float)).mean() > 0.01


def test_holes_of_every_width_give_as_much_as_they_may(cut: Arrays) -> None:
    assert len(cut["asked"]) == 12 * len(HOLE_EDGES)
    missing = cut["asked"].mean(axis=(1, 2)).reshape(len(HOLE_EDGES), 12).mean(axis=1)
    # Wider holes take more of their patches.
    assert missing.tolist() == sorted(missing)


@pytest.mark.slow
def test_the_same_generator_cuts_the_same_training_pairs(relief: TriangleMesh, cut: Arrays) -> None:
    again = cut_training_pairs(relief, 12, np.random.default_rng(0))
    assert all(again[name].tobytes() == array.tobytes() for name, array in cut.items())


def test_a_mesh_too_small_for_a_hole_gives_no_training_pair() -> None:
    cut = cut_training_pairs(open_grid(6), 10, np.random.default_rng(0))
    assert [len(array) for array in cut.values()] == [0, 0, 0]


def test_the_rule_of_the_patch_length_names_the_widths_of_the_holes() -> None:
    for edges in HOLE_EDGES:
        assert f"{edges:g}" in training_pairs.LENGTH_RULE
