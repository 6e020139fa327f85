"""``python -m training``: learn models from the command line."""

import shlex
import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from jobkit.errors import JobkitError
from quadpatch.errors import OptionError, QuadpatchError
from quadpatch.options import Recipe
from quadpatch.sparse.ksvd import KsvdOptions
from training.dictionary import USUAL, LearningOptions
from training.run import Request, run

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
    resolution: Annotated[int, typer.Option(min=8, max=128, help="Bins along one side of a patch.")] = 24,
    nonzero: Annotated[
        int | None, typer.Option(min=1, help="Atoms that one patch may use; 10, or 20 for the recipe paper.")
    ] = None,
    iterations: Annotated[int, typer.Option(min=1, help="Rounds of K-SVD.")] = 15,
    patch_length: Annotated[str, typer.Option(help="Side of the smallest patches in mesh units, or auto.")] = "auto",
    overlap: Annotated[int, typer.Option(min=0, max=8, help="Every quad carries 4 k offset patches.")] = 1,
    procedural: Annotated[int, typer.Option(min=0, help="Procedural reliefs of each pattern to learn from.")] = 0,
    holdout: Annotated[list[str] | None, typer.Option(help="Mesh (file name without suffix) to measure on.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Starts every random choice.")] = 0,
    curve: Annotated[Path | None, typer.Option(help="Also write the error curve: .png or .json.")] = None,
    register: Annotated[bool, typer.Option("--register", help="Publish in the registry of QUADPATCH_*.")] = False,
) -> None:
    """Learn a patch dictionary by K-SVD and write it with its card."""
    console = Console(stderr=True)
    try:
        usual = USUAL[recipe]
        patches = replace(usual.recipe, resolution=resolution, length=_length(patch_length), overlap=overlap)
        ksvd = KsvdOptions(atoms or usual.ksvd.n_atoms, nonzero or usual.ksvd.n_nonzero, iterations)
        options = LearningOptions(patches, ksvd, procedural, seed=seed)
        file = output or Path(f"{name}.safetensors")
        run(Request(name, meshes, holdout or [], options, _command(), file, curve, register), console)
    except (QuadpatchError, JobkitError) as error:
        console.print(f"error ({error.code}): {error}", style="red", highlight=False, markup=False)
        raise typer.Exit(1) from None


def _length(text: str) -> float | None:
    try:
        length = None if text == "auto" else float(text)
    except ValueError:
        raise OptionError(f"--patch-length is a length or auto; got {text!r}") from None
    if length is not None and not 0.0 < length < float("inf"):
        raise OptionError(f"--patch-length must be greater than 0; got {text}")
    return length


def _command() -> str:
    """Return what was typed, without the folders that files lie in and without what does not change the bytes."""
    kept, arguments = ["python", "-m", "training"], iter(sys.argv[1:])
    for argument in arguments:
        option, _, value = argument.partition("=")
        if option in ("--output", "--curve"):
            if not value:
                next(arguments, None)
        elif option != "--register":
            kept.append(Path(argument).name if "/" in argument else argument)
    return shlex.join(kept)


if __name__ == "__main__":
    app()
