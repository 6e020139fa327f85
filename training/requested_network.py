"""A network that the service was asked for: meshes in, an ONNX file with its card out, and a report.

The network `residual` is fitted further from the weights that ship, or from random ones, on training pairs cut out of
the meshes. Steps alone say how long, so the same meshes, options and seed make the same network on one kind of
processor.

Tested in `tests/training/test_requested_network.py`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Literal

import torch
from torch import nn

from quadpatch.errors import OptionError, StageError
from quadpatch.inpainters.model_file import shipped_model
from quadpatch.inpainters.proof import prove_model
from quadpatch.model_choice import BASE_NETWORK
from quadpatch.networks.weights import load_residual
from quadpatch.progress import Progress, no_progress
from quadpatch.report import describe_stages
from quadpatch.stages import Stages, harmless
from quadpatch_rules.coded_warnings import described
from training.architectures import Architecture, find_architecture
from training.build_corpus import RESOLUTIONS, CorpusOptions, build_corpus
from training.checkpoint import TrainingState
from training.errors import DivergedError, ExportError
from training.export import to_onnx, write_network
from training.held_out import Split, judge_model, split_meshes
from training.network_card import network_card
from training.processes import Place
from training.residual_task import open_residual_task
from training.shards import Corpus
from training.sources import Source
from training.trainer import Trainer, TrainOptions

# Training pairs of one diameter of holes, of one mesh and of all: what bounds memory and time of cutting.
MOST_OF_ONE, MOST_OF_ALL = 300, 3000
# From so many meshes on, one in four shows when nothing is gained any more; below, other holes in the same ones do.
LEAST_TO_VALIDATE = 4
BATCH, VALIDATIONS = 64, 5
# A network that knows something is changed slowly.
RATES = {"shipped": 5e-4, "random": 2e-3}
COMMAND = "POST /v1/trainings, kind network"
CORPUS_NAME = "corpus"


@dataclass(frozen=True)
class NetworkTrainingOptions:
    """What to fit.

    Attributes
    ----------
    name : str
        Of the model.
    steps : int
        Of gradient descent, of 64 training pairs each, at most; fewer where nothing is gained any more.
    start : str
        Weights to begin with: `shipped`, those of the network that ships, or `random`.
    held_out : float
        Share of the meshes that are kept from learning.
    seed : int
    """

    name: str
    steps: int = 500
    start: Literal["shipped", "random"] = "shipped"
    held_out: float = 0.25
    seed: int = 0

    def training(self) -> TrainOptions:
        """Return the options of the training loop; float32, so that the processor decides about no step."""
        return TrainOptions(
            self.steps,
            batch=BATCH,
            rate=RATES[self.start],
            seed=self.seed,
            precision="float32",
            n_validations=min(VALIDATIONS, self.steps),
        )


def train_network(
    meshes: Sequence[Source], output: Path, options: NetworkTrainingOptions, progress: Progress = no_progress
) -> dict[str, Any]:
    """Fit a network, judge it, and write it with its card.

    Parameters
    ----------
    meshes : sequence of Source
        Named by their ids.
    output : Path
        `.onnx`; holes and training pairs are written beside it.
    options : NetworkTrainingOptions
    progress : callable
        Stages `read`, `learn`, `judge` and `write`.

    Returns
    -------
    dict
        The report, JSON-ready.

    Raises
    ------
    StageError
        If no mesh can be read, or the fitting comes to no number.
    OptionError
        If the meshes have no room for training pairs.
    """
    stages, warnings = Stages(harmless(progress)), list[str]()
    with stages.stage("read"):
        split = split_meshes(meshes, output.parent, (options.held_out, options.seed), stages, warnings)
    architecture = _architecture(options)
    with stages.stage("learn"):
        corpus = _corpus(split, options, output.with_name(CORPUS_NAME), stages)
        trainer = _fit(architecture, corpus, options, stages)
        model = _exported(trainer, architecture)
    write_network(output, model, _card(architecture, corpus, options, trainer.state, {}))
    with stages.stage("judge"):
        judgement = judge_model(split, output, options.seed, stages, warnings)
    with stages.stage("write"):
        write_network(output, model, _card(architecture, corpus, options, trainer.state, judgement.facts()))
        prove_model(output)
    return {
        "schema": 1,
        "task": "train",
        "kind": "network",
        "stages": describe_stages(stages),
        "learned_from": [source.name for source in split.learn],
        "patches": sum(mesh["count"] for mesh in corpus.meshes("train")),
        "learning_errors": [round(loss, 5) for _, loss in trainer.state.validation],
        **judgement.report(),
        **described(warnings),
    }


def _architecture(options: NetworkTrainingOptions) -> Architecture:
    residual = find_architecture("residual")
    if options.start == "random":
        return residual
    return replace(residual, build=partial(load_residual, shipped_model(BASE_NETWORK)))


def _corpus(split: Split, options: NetworkTrainingOptions, folder: Path, stages: Stages) -> Corpus:
    """Cut training pairs, about half of the work; raise OptionError where there are none."""
    learn, n = split.learn, len(split.learn)
    validate = learn[-(n // LEAST_TO_VALIDATE) :] if n >= LEAST_TO_VALIDATE else learn
    train = learn[: -len(validate)] if n >= LEAST_TO_VALIDATE else learn
    most = max(1, min(MOST_OF_ONE, MOST_OF_ALL // len(train)))
    cut = CorpusOptions("residual", RESOLUTIONS["residual"], places=most, seed=options.seed, command=COMMAND)
    reach = stages.part(0.0, 0.5)
    corpus = build_corpus(train, validate, cut, folder, lambda _, done: reach(done))
    if not all(any(mesh["count"] for mesh in corpus.meshes(part)) for part in ("train", "validation")):
        raise OptionError(
            "the meshes have no room for holes to learn a network from: give meshes of more triangles, or learn a "
            "dictionary"
        )
    return corpus


def _fit(architecture: Architecture, corpus: Corpus, options: NetworkTrainingOptions, stages: Stages) -> Trainer:
    reach = stages.part(0.5, 1.0)
    trainer = Trainer(open_residual_task(architecture, corpus), options.training(), Place(torch.device("cpu")))
    try:
        trainer.run(report=lambda status: reach(status.fraction))
    except DivergedError as error:
        raise StageError(str(error)) from error
    return trainer


def _exported(trainer: Trainer, architecture: Architecture) -> Any:
    module = nn.Sequential(trainer.module, architecture.output())
    try:
        return to_onnx(module, architecture.channels, architecture.resolution)
    except ExportError as error:
        raise StageError(str(error)) from error


def _card(
    architecture: Architecture,
    corpus: Corpus,
    options: NetworkTrainingOptions,
    state: TrainingState,
    facts: dict[str, Any],
) -> dict[str, Any]:
    """Gather what there is to say; meshes are named by their ids."""
    begun = {"started_from": BASE_NETWORK if options.start == "shipped" else "random weights"}
    told = {"metrics": {}, "command": COMMAND, "licence": "", **begun, **facts}
    return dict(network_card((options.name, None), architecture, corpus, options.training(), state, told))
