"""One training run with everything around it: progress on the terminal, the file, its card, the registry.

Tested in `tests/training/test_main.py`.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from quadpatch.errors import OptionError
from quadpatch.inpainters.model_file import save_dictionary
from training.card import dictionary_card, write_card_page
from training.curve import text_curve, write_curve
from training.dictionary import Learned, LearningOptions, learn_dictionary
from training.publish import parse_reference, publish
from training.sources import Source, find_sources, split_holdout

STAGES = ("training patches", "held-out scans", "held-out reliefs")


@dataclass(frozen=True)
class Request:
    """What to learn and where to put it.

    Attributes
    ----------
    name : str
        Of the model; with `@version` if it is to have a certain one.
    meshes : list of Path
        Files or folders.
    holdout : list of str
        Stems of meshes to measure on.
    options : LearningOptions
    command : str
        For the card.
    output : Path
        `.safetensors`; the card goes beside it as `.md`.
    curve : Path or None
    register : bool
    """

    name: str
    meshes: list[Path]
    holdout: list[str]
    options: LearningOptions
    command: str
    output: Path
    curve: Path | None
    register: bool


def run(request: Request, console: Console) -> Learned:
    """Learn a dictionary, write it and its card, and publish it if asked.

    Raises
    ------
    QuadpatchError
        If meshes or options are no good; nothing is written then.
    JobkitError
        If the registry refuses; the files are written all the same.
    """
    if request.output.suffix != ".safetensors":
        raise OptionError(f"--output ends in .safetensors; got {request.output.name}")
    name, version = parse_reference(request.name)
    sources, holdout = split_holdout(find_sources(request.meshes), request.holdout)
    learned = _learn(sources, holdout, request.options, console)
    card = dictionary_card((name, version), learned, (sources, holdout), request.options, request.command)
    save_dictionary(request.output, learned.dictionary, card, request.options.recipe.normalisation)
    digest = hashlib.sha256(request.output.read_bytes()).hexdigest()
    write_card_page(request.output.with_suffix(".md"), card, digest)
    console.print(f"{learned.n_patches} patches; error by iteration {text_curve(learned.errors)}", highlight=False)
    for key, value in learned.metrics.items():
        console.print(f"  {key:24} {value:g}", highlight=False)
    console.print(f"wrote {request.output} and its card, sha256 {digest}", highlight=False, soft_wrap=True)
    if request.curve is not None:
        write_curve(request.curve, learned.errors)
    if request.register:
        published = publish(name, version, request.output)
        console.print(f"registered as {published.name}@{published.version}", highlight=False)
    return learned


def _learn(sources: list[Source], holdout: list[Source], options: LearningOptions, console: Console) -> Learned:
    """Learn with a bar for every stage."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, TextColumn("{task.fields[note]}"), console=console) as bars:
        tasks = {stage: bars.add_task(stage, total=100, note="") for stage in STAGES}
        ksvd = bars.add_task("K-SVD", total=options.ksvd.n_iterations, note="")

        def on_stage(stage: str, fraction: float) -> None:
            bars.update(tasks[stage], completed=round(100 * fraction))

        def on_iteration(i: int, error: float) -> None:
            bars.update(ksvd, completed=i + 1, note=f"error {error:.4f}")

        return learn_dictionary(sources, holdout, options, on_stage, on_iteration)
