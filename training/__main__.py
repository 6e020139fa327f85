"""``python -m training``: learn models from the command line."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from quadpatch.errors import OptionError
from quadpatch.patches.scale import PRESETS
from quadpatch.sparse.ksvd import KsvdOptions
from quadpatch_rules.option_words import Preset, Recipe
from training.commands import corpus, network, normalise
from training.dictionary import USUAL, LearningOptions
from training.run import Request, run
from training.typed import command_line, refusals

app = typer.Typer(add_completion=False, no_args_is_help=True, help="Learn models and publish them.")


@app.callback()
def main() -> None:
    """Learn models and publish them."""


@app.command()
def dictionary(  # noqa: PLR0913 - one parameter for each option of the command line
    meshes: Annotated[list[Path], typer.Argument(help="Meshes to learn from; a folder stands for all meshes in it.")],
    *,
    name: Annotated[str, typer.Option(help="Name of the model, or name@version.")],
    output: Annotated[Path | None, typer.Option(help="File to write; NAME.safetensors if not given.")] = None,
    recipe: Annotated[Recipe, typer.Option(help="Of the repairs that it is for: our way, or the paper's.")] = "default",
    atoms: Annotated[int | None, typer.Option(min=2, help="Atoms; 256, or 500 for the recipe paper.")] = None,
    resolution: Annotated[int | None, typer.Option(min=8, max=128, help="Bins along one side of a patch.")] = None,
    nonzero: Annotated[
        int | None, typer.Option(min=1, help="Atoms that one patch may use; 10, or 20 for the recipe paper.")
    ] = None,
    iterations: Annotated[int, typer.Option(min=1, help="Rounds of K-SVD.")] = 15,
    patch_length: Annotated[str, typer.Option(help="Side of the smallest patches in mesh units, or auto.")] = "auto",
    preset: Annotated[
        Preset | None, typer.Option(help="The paper's patches: 0.03 of the longest side in 16 bins, or 0.06 in 24.")
    ] = None,
    overlap: Annotated[int, typer.Option(min=0, max=8, help="Every quad carries 4 k offset patches.")] = 1,
    edge: Annotated[
        float | None,
        typer.Option(
            "--normalise", min=1e-4, max=0.5, help="Scale meshes to the unit cube and this edge length first."
        ),
    ] = None,
    procedural: Annotated[int, typer.Option(min=0, help="Procedural reliefs of each pattern to learn from.")] = 0,
    holdout: Annotated[list[str] | None, typer.Option(help="Mesh (file name without suffix) to measure on.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Starts every random choice.")] = 0,
    curve: Annotated[Path | None, typer.Option(help="Also write the error curve: .png or .json.")] = None,
    register: Annotated[bool, typer.Option("--register", help="Publish in the registry of QUADPATCH_*.")] = False,
) -> None:
    """Learn a patch dictionary by K-SVD and write it with its card."""
    console = Console(stderr=True)
    with refusals(console):
        usual = USUAL[recipe]
        bins = resolution or (PRESETS[preset][1] if preset else usual.recipe.resolution)
        patches = replace(usual.recipe, resolution=bins, length=_length(patch_length), overlap=overlap, preset=preset)
        ksvd = KsvdOptions(atoms or usual.ksvd.n_atoms, nonzero or usual.ksvd.n_nonzero, iterations)
        options = LearningOptions(patches, ksvd, procedural, seed=seed, edge_length=edge)
        file = output or Path(f"{name}.safetensors")
        run(Request(name, meshes, holdout or [], options, command_line(), file, curve, register), console)


app.command()(normalise)
app.command()(corpus)
app.command()(network)


def _length(text: str) -> float | None:
    try:
        length = None if text == "auto" else float(text)
    except ValueError:
        raise OptionError(f"--patch-length is a length or auto; got {text!r}") from None
    if length is not None and not 0.0 < length < float("inf"):
        raise OptionError(f"--patch-length must be greater than 0; got {text}")
    return length


if __name__ == "__main__":
    app()
