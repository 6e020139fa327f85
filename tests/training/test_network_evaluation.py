from pathlib import Path

import numpy as np
import pytest
from torch import nn

from tests.training.patches import SCALE, waves, write_corpus
from training.export import to_onnx, write_network
from training.network_evaluation import MAX_PATCHES, clean_heights, evaluate_network
from training.shards import PatchSet
from training.smooth_fills import disk

CARD = {"patch_resolution": 24, "recipe": "paper", "height_low": SCALE.low, "height_high": SCALE.high}


@pytest.mark.slow
def test_errors_are_those_of_the_file_in_the_hole_in_patch_lengths(tmp_path: Path) -> None:
    """A network that copies its input answers 1 in the hole, wherever the surface is: its error is known exactly."""
    corpus = write_corpus(tmp_path / "corpus")
    write_network(tmp_path / "copy.onnx", to_onnx(nn.Identity(), 1, 24), CARD)
    metrics = evaluate_network(tmp_path / "copy.onnx", corpus)
    heights, known = waves(9).astype(np.float32).astype(np.float64), disk(24, 0.25)
    answer = heights[:, known].mean(axis=1) + SCALE.low + (SCALE.high - SCALE.low) / SCALE.scaled_high
    expected = np.sqrt(((answer[:, None] - heights[:, ~known]) ** 2).mean())
    assert metrics["relief_hole_25_error"] == pytest.approx(expected, abs=1e-5)
    assert metrics["relief_n_patches"] == 9
    # Waves are smooth: a plate comes much closer than that.
    assert metrics["relief_hole_25_to_plate"] > metrics["relief_hole_25_to_membrane"] > 1.0
    # No held-out patch of the scan is known in every bin.
    assert not any(key.startswith("scan_") for key in metrics)


def test_only_clean_patches_are_measured_and_never_too_many() -> None:
    known = np.ones((2000, 8, 8), bool)
    known[::2, 3, 3] = False
    heights = np.broadcast_to(np.arange(2000.0, dtype=np.float32)[:, None, None], known.shape)
    clean = clean_heights(PatchSet([{"heights": heights, "known": known}]))
    assert 500 < len(clean) <= MAX_PATCHES
    assert (clean[:, 0, 0] % 2 == 1).all()
    assert clean_heights(PatchSet([])).shape[0] == 0
