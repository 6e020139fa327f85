"""The commands `normalise`, `corpus` and `network`. The last needs torch, an extra: nothing here imports it before.

Tested in `tests/training/test_network_run.py`.
"""

from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Literal

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from quadpatch_rules.extras import OF_NETWORKS
from training.build_corpus import EDGES, RESOLUTIONS, CorpusOptions, build_corpus
from training.errors import MissingExtraError
from training.normalise import normalise_dataset
from training.sources import find_sources, split_holdout
from training.typed import command_line, refusals

INTERRUPTED = 130


def corpus(  # noqa: PLR0913 - one parameter for each option of the command line
    meshes: Annotated[list[Path], typer.Argument(help="Meshes to cut; a folder stands for all meshes in it.")],
    *,
    output: Annotated[Path, typer.Option(help="Folder to write; empty, or not there yet.")],
    resolution: Annotated[
        int | None, typer.Option(min=8, max=128, help="Bins along one side of a patch.", show_default="24 or 32")
    ] = None,
    recipe: Annotated[
        Literal["paper", "residual"], typer.Option(help="Of the networks that it is for: the paper's, or residual.")
    ] = "paper",
    edges: Annotated[float, typer.Option(min=1.0, help="Side of the smallest patches, in mean edges.")] = EDGES,
    overlap: Annotated[int, typer.Option(min=0, max=8, help="Every quad carries 4 k offset patches.")] = 2,
    places: Annotated[int, typer.Option(min=1, help="Patches of one mesh and size, at most.")] = 2000,
    edge: Annotated[
        float | None,
        typer.Option(
            "--normalise", min=1e-4, max=0.5, help="Scale meshes to the unit cube and this edge length first."
        ),
    ] = None,
    procedural: Annotated[int, typer.Option(min=0, help="Procedural reliefs of each pattern to add.")] = 0,
    holdout: Annotated[list[str] | None, typer.Option(help="Mesh (file name without suffix) to validate on.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Starts every random choice.")] = 0,
) -> None:
    """Cut meshes into patches for training networks, and write them as a corpus on disk."""
    console = Console(stderr=True)
    with refusals(console):
        options = CorpusOptions(
            recipe,
            resolution or RESOLUTIONS[recipe],
            edges,
            overlap=overlap,
            places=places,
            n_procedural=procedural,
            seed=seed,
            edge_length=edge,
            command=command_line(),
        )
        sources, held_out = split_holdout(find_sources(meshes), holdout or [])
        columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
        with Progress(*columns, console=console) as bars:
            bar = bars.add_task("", total=1.0)
            written = build_corpus(
                sources,
                held_out,
                options,
                output,
                lambda name, fraction: bars.update(bar, description=name, completed=fraction),
            )
        for split in ("train", "validation"):
            entries = written.meshes(split)
            console.print(f"{split}: {sum(m['count'] for m in entries)} patches of {len(entries)} meshes and reliefs")
        console.print(f"wrote {output}, sha256 {written.sha256}", highlight=False, soft_wrap=True)


def normalise(
    meshes: Annotated[list[Path], typer.Argument(help="Meshes to normalise; a folder stands for all meshes in it.")],
    *,
    output: Annotated[Path, typer.Option(help="Folder to write; empty, or not there yet.")],
    edge: Annotated[float, typer.Option(min=1e-4, max=0.5, help="Common edge length; the longest side is 1.")] = 0.01,
) -> None:
    """Scale meshes into the unit cube, bring them to one edge length, and write them as PLY with a manifest."""
    console = Console(stderr=True)
    with refusals(console):
        columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
        with Progress(*columns, console=console) as bars:
            bar = bars.add_task("", total=1.0)
            written = normalise_dataset(
                find_sources(meshes),
                edge,
                output,
                lambda name, fraction: bars.update(bar, description=name, completed=fraction),
            )
        console.print(f"wrote {len(written)} meshes to {output}", highlight=False, soft_wrap=True)


def network(  # noqa: PLR0913 - one parameter for each option of the command line
    *,
    arch: Annotated[str, typer.Option(help="residual, small_4x, multi_6x, 6x_128, 6x_128_FC, long_12x, long_12x_SC.")],
    corpus: Annotated[Path, typer.Option(help="Folder that `corpus` wrote.")],
    name: Annotated[str, typer.Option(help="Name of the model, or name@version.")],
    output: Annotated[Path | None, typer.Option(help="File to write; NAME.onnx if not given.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of first weights and batches.")] = 0,
    steps: Annotated[int | None, typer.Option(min=1, help="Budget; 2000 if no budget is given.")] = None,
    minutes: Annotated[float | None, typer.Option(min=0.01, help="Budget, all sittings together.")] = None,
    batch: Annotated[int, typer.Option(min=1, help="Patches in a step, over all processes.")] = 128,
    rate: Annotated[float, typer.Option(min=1e-8, max=1.0, help="Learning rate.")] = 2e-3,
    patience: Annotated[int, typer.Option(min=1, help="Stop after so many validations without gain.")] = 6,
    device: Annotated[str, typer.Option(help="auto, cpu or cuda.")] = "auto",
    precision: Annotated[
        Literal["auto", "float32", "bfloat16"], typer.Option(help="Of matrix products; auto: what is faster.")
    ] = "auto",
    checkpoint: Annotated[
        Path | None, typer.Option(help="File to go on from after a break; if not given, removed at the end.")
    ] = None,
    resume: Annotated[Path | None, typer.Option(help="Checkpoint to go on from.")] = None,
    curve: Annotated[Path | None, typer.Option(help="Also write the held-out loss: .png or .json.")] = None,
    tensorboard: Annotated[Path | None, typer.Option(help="Folder for TensorBoard, which is an extra.")] = None,
    int8: Annotated[bool, typer.Option("--int8", help="Write the network in whole numbers.")] = False,
    register: Annotated[bool, typer.Option("--register", help="Publish in the registry of QUADPATCH_*.")] = False,
) -> None:
    """Train a network on a corpus and write it as ONNX with its card; on several GPUs through torchrun."""
    console = Console(stderr=True)
    with refusals(console):
        _check_extra()
        from training.network_run import Request, run  # noqa: PLC0415 - torch is an extra
        from training.trainer import Interrupted, TrainOptions  # noqa: PLC0415

        options = TrainOptions(
            steps if steps or minutes else 2000,
            minutes,
            batch,
            rate,
            seed=seed,
            precision=precision,
            patience=patience,
        )
        request = Request(
            name,
            arch,
            corpus,
            options,
            device,
            command_line(),
            output or Path(f"{name}.onnx"),
            checkpoint,
            resume,
            curve,
            tensorboard,
            int8,
            register,
        )
        try:
            run(request, console)
        except Interrupted:
            raise typer.Exit(INTERRUPTED) from None


def _check_extra() -> None:
    """Look for what training and export need, before minutes are spent on training."""
    for package in OF_NETWORKS:
        if find_spec(package) is None:
            raise MissingExtraError(f"training networks needs {package}: pip install '.[networks]' in the repository")
