"""Options that say how holes are filled.

Tested in `tests/quadpatch_client/test_options.py`.
"""

from typing import Annotated

import typer

from quadpatch_client.options import MethodName
from quadpatch_rules.option_words import Effort, Preset, Recipe

_PATCHES = "Patches"
_FITTING = "Fitting a network to the mesh (--effort best, or --method cnn --model self)"

EffortOption = Annotated[
    Effort | None,
    typer.Option(
        help="How much the method auto tries: fast (geometry only), standard (also a dictionary of this mesh and "
        "the shipped network: seconds), best (also a network fitted to this mesh: a minute).",
        show_default="standard",
    ),
]
MethodOption = Annotated[
    MethodName | None,
    typer.Option(
        help="How holes are filled; auto finds out what is best on this very mesh.",
        show_default="auto; dictionary with a --model or --recipe",
    ),
]
ModelOption = Annotated[
    str | None,
    typer.Option(help="name@version, an alias, or 'self': learned from the mesh itself.", show_default="default"),
]
RecipeOption = Annotated[
    Recipe | None,
    typer.Option(help="How the model is put to use: our way, or exactly the paper's.", show_default="default"),
]
PatchLengthOption = Annotated[
    float | None,
    typer.Option(help="Side of a patch, in mesh units.", show_default="auto", rich_help_panel=_PATCHES),
]
ResolutionOption = Annotated[
    int | None, typer.Option(help="Bins along a side.", show_default="auto", rich_help_panel=_PATCHES)
]
OverlapOption = Annotated[
    int | None,
    typer.Option(help="k: a quad carries 1 + 4 k patches.", show_default="auto", rich_help_panel=_PATCHES),
]
PresetOption = Annotated[
    Preset | None,
    typer.Option(
        help="The paper's patches: 0.03 of the longest side in 16 bins, or 0.06 in 24.",
        show_default="none",
        rich_help_panel=_PATCHES,
    ),
]
FitStepsOption = Annotated[
    int | None,
    typer.Option(help="Fit at most so many steps.", show_default="of the service", rich_help_panel=_FITTING),
]
FitSecondsOption = Annotated[
    float | None,
    typer.Option(help="Fit at most so long.", show_default="of the service", rich_help_panel=_FITTING),
]
