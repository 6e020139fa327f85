"""The paper's networks: local (the undamaged mesh itself), global (all meshes), leave-one-out (all others).

As with the paper's dictionaries, they are trained on meshes that are for measuring only, so they stay in the output
folder and are never published.
"""

import hashlib
import json
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from benchmarks.quality.bench import Bench, Shape
from benchmarks.quality.code_version import code_sha256, method_sha256
from benchmarks.quality.measurement import Method
from benchmarks.quality.network_options import Budget, Pace
from benchmarks.quality.results import NETWORKS, Key, Results
from quadpatch.inpainters.paper_dictionary import MIN_TRAINING_PATCHES
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.paper_layout import LEAST_KNOWN
from quadpatch.patches.scale import PatchScale
from quadpatch.types import IntArray, Patches
from training import autoencoder, holes, paper_task, trainer
from training.architectures import Architecture
from training.export import to_onnx, write_network
from training.paper_task import PaperTask, paper_scale
from training.processes import take_place
from training.shards import Arrays, PatchSet
from training.trainer import Trainer, TrainOptions

SEED = 0
# One patch in so many is only looked at to choose the best weights of a run. Its surface is in other patches, too: the
# paper's own protocol, where training and test share the mesh.
HELD_OUT_EVERY = 20
# Minutes on a CPU are few steps: many small ones come furthest. Patches in a step, and learning rate, by resolution.
_PACE = {24: Pace(16, 5e-3), 100: Pace(4, 1e-3)}
# Each costs a look at all held-out patches.
_N_VALIDATIONS = 10
_CODE = (autoencoder, holes, paper_task, trainer)


@dataclass(frozen=True)
class TrainedNetwork:
    """A network in the output folder.

    Attributes
    ----------
    method : Method
        How to repair with it.
    facts : dict
        `file`, `n_patches`, `n_parameters`, `steps`, `validation_loss` (nats a bin), `train_s`, `train_cpu_s`.
    """

    method: Method
    facts: dict[str, Any]


@dataclass
class NetworkTrainer:
    """Trains the paper's networks, and keeps them."""

    bench: Bench
    results: Results
    folder: Path
    budget: Budget
    _cut: dict[tuple[str, PatchScale], Arrays] = field(default_factory=dict)

    def train(
        self,
        name: str,
        shapes: Sequence[Shape],
        scale: PatchScale,
        architecture: Architecture,
        pace: Pace | None = None,
    ) -> TrainedNetwork | None:
        """Train on the patches of undamaged meshes, or take what was kept; None where they have too few.

        Parameters
        ----------
        name : str
            Of the meshes, for tables and files.
        shapes : sequence of Shape
        scale : PatchScale
            Of the repair; the network brings its own resolution.
        architecture : Architecture
            For the recipe `paper`.
        pace : Pace, optional
            None takes what comes furthest in minutes on a CPU: many small steps.
        """
        pace = pace or _PACE[architecture.resolution]
        budget, label = self.budget, f"{architecture.name}-{name}"
        fine = replace(scale, resolution=architecture.resolution)
        key: Key = {
            "name": label,
            "length": fine.length,
            "overlap": fine.overlap,
            "minutes": budget.minutes or 0.0,
            "steps": budget.steps or 0,
            "threads": budget.threads,
            "seed": pace.seed,
            "batch": pace.batch,
            "rate": pace.rate,
            "sources_sha256": json.dumps({shape.name: shape.sha256 for shape in shapes}),
            "code_sha256": code_sha256(Path(str(module.__file__)) for module in _CODE) + method_sha256(),
        }
        facts = self.results.get(NETWORKS, key, lambda: self._train(key, shapes, fine, (architecture, pace)))
        if not facts["file"]:
            return None
        options = {"recipe": "paper", "patches": {"length": fine.length, "overlap": fine.overlap}}
        return TrainedNetwork(Method(label, str(self.folder / facts["file"]), options), facts)

    def patches(self, shape: Shape, scale: PatchScale) -> Arrays:
        """Cut the patches of an undamaged mesh, in the order of their seeds: `heights` in patch lengths, `known`."""
        wanted = (shape.sha256, scale)
        if wanted not in self._cut:
            self._cut[wanted] = _arrays(self.bench.patches(shape.truth, scale, SEED))
        return self._cut[wanted]

    def with_budget(self, budget: Budget) -> "NetworkTrainer":
        """Return the same trainer, patches that were cut included, for another budget."""
        return replace(self, budget=budget)

    def _train(
        self, key: Key, shapes: Sequence[Shape], scale: PatchScale, what: tuple[Architecture, Pace]
    ) -> dict[str, Any]:
        architecture, pace = what
        train, held_out = _split([self.patches(shape, scale) for shape in shapes])
        if len(train) < MIN_TRAINING_PATCHES or not len(held_out):
            return {"file": None}
        digest = hashlib.sha256(json.dumps(dict(key), sort_keys=True).encode()).hexdigest()
        task = PaperTask(architecture, train, held_out, paper_scale(train), digest)
        options = TrainOptions(
            steps=self.budget.steps,
            minutes=self.budget.minutes,
            batch=pace.batch,
            rate=pace.rate,
            seed=pace.seed,
            n_validations=_N_VALIDATIONS,
            patience=_N_VALIDATIONS,
        )
        with take_place() as place, _threads(self.budget.threads):
            run = Trainer(task, options, place)
            start, start_cpu = time.perf_counter(), time.process_time()
            state = run.run()
            seconds, cpu_seconds = time.perf_counter() - start, time.process_time() - start_cpu
        file = f"{key['name']}_{digest[:10]}.onnx"
        self._write(file, run.module, task, key)
        return {
            "file": file,
            "n_patches": len(train),
            "n_parameters": sum(values.numel() for values in run.module.parameters()),
            "steps": state.step,
            "validation_loss": state.best_loss,
            "train_s": seconds,
            "train_cpu_s": cpu_seconds,
        }

    def _write(self, file: str, module: nn.Module, task: PaperTask, key: Key) -> None:
        architecture = task.architecture
        model = to_onnx(nn.Sequential(module, architecture.output()), architecture.channels, architecture.resolution)
        self.folder.mkdir(parents=True, exist_ok=True)
        card = {
            "name": key["name"],
            "architecture": architecture.name,
            "patch_resolution": architecture.resolution,
            "recipe": architecture.recipe,
            "trained_on": dict(key),
            "use": "measuring only, not for publication",
            **task.card_facts(),
        }
        write_network(self.folder / file, model, card)


def held_out_rows(count: int) -> IntArray:
    """Which of so many patches of one mesh, in the order of their seeds, are held out."""
    return np.arange(0, count, HELD_OUT_EVERY)


def _split(cut: Sequence[Arrays]) -> tuple[PatchSet, PatchSet]:
    """Hold some patches of each mesh out; those of which too little is known are left out."""
    train: list[Arrays] = []
    held_out: list[Arrays] = []
    for arrays in cut:
        is_held_out = np.zeros(len(arrays["known"]), bool)
        is_held_out[held_out_rows(len(is_held_out))] = True
        good = arrays["known"].mean(axis=(1, 2)) >= LEAST_KNOWN
        for part, which in ((train, good & ~is_held_out), (held_out, good & is_held_out)):
            if which.any():
                part.append({name: array[which] for name, array in arrays.items()})
    return PatchSet(train), PatchSet(held_out)


def _arrays(patches: Patches) -> Arrays:
    """Bring heights into the form of a corpus, see `training.build_corpus`; where they fold, no bin counts as known."""
    known = patches.known & is_unfolded(patches)[:, None, None]
    heights = np.where(known, patches.heights / patches.length, 0.0)
    return {"heights": heights.astype(np.float32), "known": known}


@contextmanager
def _threads(count: int) -> Iterator[None]:
    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)
