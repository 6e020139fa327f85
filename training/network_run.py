"""One run that trains a network, with all around it: progress, checkpoints, the ONNX file, its card, the registry."""

import hashlib
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn
from torch import nn

from quadpatch.errors import OptionError
from quadpatch_rules.dictionary_file import Card
from training.architectures import Architecture, find_architecture
from training.board import Board
from training.card import write_card_page
from training.checkpoint import TrainingState
from training.curve import text_curve, write_curve
from training.export import to_onnx, write_network
from training.int8 import to_int8
from training.interruption import stop_on_signal
from training.network_card import WORDINGS, network_card
from training.network_evaluation import evaluate_network
from training.processes import Place, take_place
from training.publish import parse_reference, publish
from training.residual_evaluation import evaluate_residual
from training.shards import Corpus
from training.task import Task
from training.tasks import open_task
from training.trainer import Interrupted, Status, Trainer, TrainOptions

EVALUATIONS: dict[str, Callable[[Path, Corpus], dict[str, float]]] = {
    "paper": evaluate_network,
    "residual": evaluate_residual,
}
CALIBRATION_PATCHES = 512


@dataclass(frozen=True)
class Request:
    """What to train and where to put it.

    Attributes
    ----------
    name : str
        Of the model; with `@version` if it is to have a certain one.
    architecture : str
    corpus : Path
    options : TrainOptions
    device : str
    command : str
        For the card.
    output : Path
        `.onnx`; the card goes beside it as `.md`.
    checkpoint : Path or None
        None: beside the output, removed when all is done.
    resume : Path or None
    curve, tensorboard : Path or None
    int8, register : bool
    """

    name: str
    architecture: str
    corpus: Path
    options: TrainOptions
    device: str
    command: str
    output: Path
    checkpoint: Path | None = None
    resume: Path | None = None
    curve: Path | None = None
    tensorboard: Path | None = None
    int8: bool = False
    register: bool = False


def run(request: Request, console: Console) -> TrainingState:
    """Train a network, write it and its card, and publish it if asked.

    Raises
    ------
    QuadpatchError, TrainingError
        If options, corpus or checkpoint are no good, or the network does not export; no network is written then.
    JobkitError
        If the registry refuses; the files are written all the same.
    Interrupted
        If Ctrl-C stopped it; the checkpoint is written, and it was said how to go on.
    """
    if request.output.suffix != ".onnx":
        raise OptionError(f"--output ends in .onnx; got {request.output.name}")
    if request.curve is not None and request.curve.suffix not in (".json", ".png"):
        raise OptionError(f"a curve is written as .json or .png; got {request.curve.name}")
    parse_reference(request.name)
    architecture = find_architecture(request.architecture)
    corpus = Corpus.open(request.corpus)
    task = open_task(architecture, corpus)
    with take_place(request.device) as place:
        trainer = Trainer(task, request.options, place)
        if request.resume is not None:
            trainer.resume(request.resume)
        state = _train(trainer, request, console)
        if place.is_first:
            _publish(trainer, architecture, corpus, request, console)
    return state


def _train(trainer: Trainer, request: Request, console: Console) -> TrainingState:
    checkpoint = request.checkpoint or request.output.with_suffix(".checkpoint")
    try:
        with stop_on_signal() as is_stopping, _watching(trainer, request, console) as report:
            state = trainer.run(checkpoint, report, is_stopping)
    except Interrupted:
        if trainer.place.is_first:
            console.print(
                f"stopped after {trainer.state.step} steps; to go on, give the same command with --resume {checkpoint}",
                highlight=False,
                soft_wrap=True,
            )
        raise
    if request.checkpoint is None and trainer.place.is_first:
        checkpoint.unlink(missing_ok=True)
    return state


@contextmanager
def _watching(trainer: Trainer, request: Request, console: Console) -> Iterator[Callable[[Status], None]]:
    """Show a bar, and curves if asked; only the first process shows anything."""
    if not trainer.place.is_first:
        yield lambda status: None
        return
    board = Board(request.tensorboard) if request.tensorboard else None
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[note]}"))
    with Progress(*columns, console=console) as bars:
        bar = bars.add_task(request.architecture, total=1.0, note="")

        def report(status: Status) -> None:
            bars.update(bar, completed=status.fraction, note=_note(status))
            if board is not None:
                board.show(status)

        try:
            yield report
        finally:
            if board is not None:
                board.close()


def _note(status: Status) -> str:
    minutes, seconds = divmod(round(min(status.remaining_s, 360_000.0)), 60)
    validation = "" if math.isnan(status.validation_loss) else f", held out {status.validation_loss:.6f}"
    speed = f"{status.patches_per_s:,.0f} patches/s, {minutes}:{seconds:02} to go"
    return f"step {status.step}, loss {status.loss:.6f}{validation}, {speed}"


def _publish(trainer: Trainer, architecture: Architecture, corpus: Corpus, request: Request, console: Console) -> None:
    name, version = parse_reference(request.name)
    card = _write(trainer, architecture, corpus, request)
    digest = hashlib.sha256(request.output.read_bytes()).hexdigest()
    write_card_page(request.output.with_suffix(".md"), card, digest, WORDINGS[architecture.recipe])
    losses = np.array([loss for _, loss in trainer.state.validation])
    console.print(f"{trainer.state.step} steps; held-out loss {text_curve(losses)}", highlight=False)
    for key, value in card["metrics"].items():
        console.print(f"  {key:32} {value:g}", highlight=False)
    console.print(f"wrote {request.output} and its card, sha256 {digest}", highlight=False, soft_wrap=True)
    if request.curve is not None:
        write_curve(request.curve, losses, "validation_loss")
    if request.register:
        published = publish(name, version, request.output)
        console.print(f"registered as {published.name}@{published.version}", highlight=False)


def _write(trainer: Trainer, architecture: Architecture, corpus: Corpus, request: Request) -> Card:
    """Export the network, measure what was exported, and write it with its card."""
    facts = {**trainer.task.card_facts(), "command": f"{corpus.facts['command']}\n{request.command}".strip()}
    evaluate = EVALUATIONS[architecture.recipe]

    def write(model: Any, metrics: dict[str, float]) -> Card:
        card_facts = {**facts, "metrics": metrics}
        name = parse_reference(request.name)
        card = network_card(name, architecture, corpus, request.options, trainer.state, card_facts)
        write_network(request.output, model, card)
        return card

    module = nn.Sequential(trainer.module, architecture.output())
    model = to_onnx(module, architecture.channels, architecture.resolution)
    write(model, {})
    metrics = evaluate(request.output, corpus)
    if request.int8:
        model = to_int8(model, _calibration(trainer.task, trainer.place))
        facts["precision"] = "int8"
        write(model, {})
        exact = {f"float32_{key}": value for key, value in metrics.items() if "error" in key}
        metrics = {**evaluate(request.output, corpus), **exact}
    return write(model, {"validation_loss": round(trainer.state.best_loss, 7), **metrics})


def _calibration(task: Task, place: Place) -> "np.ndarray[Any, np.dtype[np.float32]]":
    batch = task.batch(np.random.default_rng(0), CALIBRATION_PATCHES, slice(0, CALIBRATION_PATCHES), place.device)
    inputs: np.ndarray[Any, np.dtype[np.float32]] = batch[0].cpu().numpy()
    return inputs
