"""Small corpora and tasks, made in code."""

from pathlib import Path

import numpy as np

from quadpatch.inpainters.onnx_network import PaperScale
from quadpatch.types import FloatArray
from training.architectures import find_architecture
from training.paper_task import PaperTask
from training.shards import Arrays, Corpus, CorpusWriter, PatchSet
from training.sources import Source

SCALE = PaperScale(-0.1, 0.1)


def waves(n: int, resolution: int = 24, seed: int = 0) -> FloatArray:
    """Plane waves (n, N, N) of any direction, in patch lengths."""
    rng = np.random.default_rng(seed)
    ticks = np.linspace(0.0, 1.0, resolution)
    phase = rng.uniform(0.0, 2 * np.pi, (n, 1, 1))
    down, across = rng.normal(0.0, 6.0, (2, n, 1, 1))
    heights = 0.08 * np.sin(down * ticks[:, None] + across * ticks[None, :] + phase)
    return np.asarray(heights - heights.mean(axis=(1, 2), keepdims=True))


def patch_arrays(n: int, resolution: int = 24, seed: int = 0) -> Arrays:
    """Waves, known but for a corner that was never measured."""
    known = np.ones((n, resolution, resolution), bool)
    known[:, :3, :3] = False
    return {"heights": np.where(known, waves(n, resolution, seed), 0.0).astype(np.float32), "known": known}


def patch_set(n: int, seed: int = 0) -> PatchSet:
    """All in one shard."""
    return PatchSet([patch_arrays(n, seed=seed)])


def small_task(n: int = 64) -> PaperTask:
    """The smallest of the paper's networks, and waves."""
    return PaperTask(find_architecture("small_4x"), patch_set(n), patch_set(16, seed=1), SCALE, "0" * 64)


def write_corpus(folder: Path, resolution: int = 24) -> Corpus:
    """Two meshes to train on, one to validate on, and a procedural relief."""
    facts = {"recipe": "paper", "resolution": resolution, "length_rule": "12 mean edges", "procedural": {}, "seed": 0}
    writer = CorpusWriter(folder, {**facts, "command": "python -m training corpus meshes"})
    for number, (name, split) in enumerate([("vase", "train"), ("relief", "train"), ("bust", "validation")]):
        source = Source(name, Path(), f"{number:064}", "CC BY 4.0", "a museum")
        writer.add(source, split, patch_arrays(20 + 5 * number, resolution, number))
    source = Source("procedural_waves", Path(), "f" * 64, "GPL-3.0-or-later")
    clean = {"heights": waves(9, resolution).astype(np.float32), "known": np.ones((9, resolution, resolution), bool)}
    writer.add(source, "validation", clean)
    return writer.finish()
