"""Arguments and options that several commands have, and how their words are read.

Tested in `tests/quadpatch/cli/test_fill.py`.
"""

from pathlib import Path
from typing import Annotated, Literal

import typer

from quadpatch.errors import OptionError
from quadpatch_rules.option_words import LengthUnit, Preset

Source = Annotated[Path, typer.Argument(metavar="IN", help="Mesh: PLY, STL, OBJ, OFF, GLB/glTF or 3MF.")]
Output = Annotated[
    Path, typer.Option("--output", "-o", metavar="OUT", help="Its suffix says the format; -: standard output.")
]
Report = Annotated[Path | None, typer.Option(help="Write the report as JSON; -: standard output.")]
Preview = Annotated[Path | None, typer.Option("--preview", "--picture", help="Write a before/after picture as PNG.")]
Html = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Write the report as an HTML page that stands alone; -: standard output."),
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Let OUT take the place of IN.")]
PatchLength = Annotated[float | None, typer.Option(help="Side of a patch (mesh units).")]
Resolution = Annotated[int | None, typer.Option(help="Bins along one side of a patch.")]
PatchPreset = Annotated[
    Preset | None, typer.Option(help="The paper's patches: 0.03 of the longest side in 16 bins, or 0.06 in 24.")
]
Overlap = Annotated[int | None, typer.Option(help="k: every quad carries 1 + 4 k patches.")]
Model = Annotated[
    str, typer.Option(help="self (learn a dictionary from this mesh), a shipped dictionary, or a dictionary's file.")
]
Atoms = Annotated[int | None, typer.Option(help="Atoms to learn (model self).")]
Nonzero = Annotated[int | None, typer.Option(help="Atoms that one patch may use.")]
Unit = Annotated[
    LengthUnit | None,
    typer.Option(help="Unit of the coordinates, if the file states none; glTF and 3MF then hold the true size."),
]
Seed = Annotated[int, typer.Option(help="Start of every random choice.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress, no summary.")]
WeldTolerance = Annotated[
    str,
    typer.Option(
        metavar="AUTO|LENGTH",
        help="Join boundary vertices this far apart (mesh units); 0: only equal ones; auto: as far as rounding goes.",
    ),
]


def read_tolerance(word: str) -> float | Literal["auto"]:
    """Read `--weld-tolerance`; what is neither `auto` nor a number raises OptionError."""
    if word == "auto":
        return "auto"
    try:
        return float(word)
    except ValueError:
        raise OptionError(f"--weld-tolerance must be auto or a number; it is {word!r}") from None
