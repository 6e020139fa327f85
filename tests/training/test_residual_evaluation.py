from pathlib import Path

import numpy as np
import pytest
from torch import nn

from quadpatch.networks.residual import Residual
from quadpatch.patches.residual_input import CHANNELS, RESOLUTION
from tests.quadpatch.networks.made import stirred
from training.export import to_onnx, write_network
from training.residual_evaluation import evaluate_residual
from training.shards import Arrays, Corpus, CorpusWriter
from training.sources import Source


def training_pairs(count: int, seed: int) -> Arrays:
    rng = np.random.default_rng(seed)
    shape = (count, RESOLUTION, RESOLUTION)
    return {
        "channels": rng.normal(size=(count, CHANNELS, RESOLUTION, RESOLUTION)).astype(np.float16),
        "correction": rng.normal(size=shape).astype(np.float16),
        "asked": rng.random(shape) < 0.3,
    }


@pytest.fixture(name="corpus")
def made_corpus(tmp_path: Path) -> Corpus:
    writer = CorpusWriter(tmp_path / "corpus", {"recipe": "residual", "resolution": RESOLUTION})
    for name, count in (("scan", 5), ("procedural_waves", 7)):
        writer.add(Source(name, Path(), "00"), "validation", training_pairs(count, count))
    writer.add(Source("seen", Path(), "00"), "train", training_pairs(3, 3))
    return writer.finish()


def written(path: Path, network: Residual) -> Path:
    card = {"patch_resolution": RESOLUTION, "recipe": "residual"}
    write_network(path, to_onnx(nn.Sequential(network, nn.Identity()), CHANNELS, RESOLUTION), card)
    return path


@pytest.mark.slow
def test_a_network_that_leaves_fills_as_they_are_takes_no_error_away(corpus: Corpus, tmp_path: Path) -> None:
    found = evaluate_residual(written(tmp_path / "a.onnx", Residual()), corpus)
    assert found == {"scan_n_patches": 5, "scan_to_fill": 1.0, "relief_n_patches": 7, "relief_to_fill": 1.0}


@pytest.mark.slow
def test_what_the_file_answers_is_what_counts(corpus: Corpus, tmp_path: Path) -> None:
    network = stirred(Residual())
    found = evaluate_residual(written(tmp_path / "a.onnx", network), corpus)
    assert found["scan_to_fill"] != 1.0
    assert found == evaluate_residual(tmp_path / "a.onnx", corpus)
