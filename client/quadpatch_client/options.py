"""Options that several commands share. The command line loads this before it knows what it is to do."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import typer

from quadpatch_rules.option_words import Colours, Effort, LengthUnit, OutputFormat, Preset, Recipe, Tint

DEFAULT_URL = "http://127.0.0.1:8000"
MethodName = Literal["auto", "dictionary", "cnn", "smooth"]
TaskName = Literal["fill", "restore", "denoise", "encode", "decode", "train"]
# `JobState` of the wire schema, without loading it.
JobStateName = Literal["queued", "running", "canceling", "canceled", "succeeded", "succeeded_with_warnings", "failed"]

UrlOption = Annotated[
    str, typer.Option("--url", envvar="QUADPATCH_CLIENT_URL", help="Address of the service.", show_default=True)
]
KeyOption = Annotated[
    str | None,
    typer.Option("--api-key", envvar="QUADPATCH_CLIENT_API_KEY", help="API key of the service.", show_default=False),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON on stdout.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")]
MaxDiameterOption = Annotated[
    float | None, typer.Option(help="Leave wider holes open, in mesh units.", rich_help_panel="Which holes")
]
MaxPerimeterOption = Annotated[
    float | None, typer.Option(help="Leave holes with a longer rim open, in mesh units.", rich_help_panel="Which holes")
]
AllButLargestOption = Annotated[
    bool,
    typer.Option(
        "--all-but-largest",
        help="Leave the widest loop open: the border of an open scan.",
        rich_help_panel="Which holes",
    ),
]
HoleOption = Annotated[
    list[int] | None,
    typer.Option("--hole", help="Fill just this hole; repeat for more. See `holes`.", rich_help_panel="Which holes"),
]
SavedRuleOption = Annotated[
    str | None,
    typer.Option(
        "--saved-rule",
        metavar="NAME[@VERSION]",
        help="A rule that the service keeps: it says which holes are filled, and how. See `rules`.",
        rich_help_panel="Which holes",
    ),
]
WeldToleranceOption = Annotated[
    str | None,
    typer.Option(
        metavar="AUTO|LENGTH",
        help="Join boundary vertices this far apart, in mesh units; 0: only equal ones.",
        show_default="auto",
        rich_help_panel="Which holes",
    ),
]
IncludeBordersOption = Annotated[
    bool,
    typer.Option("--include-borders", help="Treat outer borders of pieces like holes.", rich_help_panel="Which holes"),
]
CapOption = Annotated[
    Literal["flat"] | None,
    typer.Option(help="Close open ends, as of tubes, by a plane patch.", rich_help_panel="Which holes"),
]
RuleOption = Annotated[
    list[str] | None,
    typer.Option(
        "--rule",
        metavar="[CONDITION,...:]ACTION",
        help="What to do with some holes: max_diameter=5:smooth, kind=open_end:flat, id=3,id=4:skip. Repeat for more; "
        "the first that fits counts.",
        rich_help_panel="Which holes",
    ),
]
BridgeOption = Annotated[
    list[str] | None,
    typer.Option(
        "--bridge",
        metavar="ID:ID",
        help="Join these two loops by a strip of surface, as across a cut: 3:17. Repeat for more; see `holes`.",
        rich_help_panel="Which holes",
    ),
]


OUTPUT = "What comes back"
OutputOption = Annotated[
    Path,
    typer.Option("--output", "-o", help="Where to put the repaired mesh; -: standard output.", rich_help_panel=OUTPUT),
]
ReportOption = Annotated[
    Path | None, typer.Option(help="Where to put the JSON report; -: standard output.", rich_help_panel=OUTPUT)
]
TintOption = Annotated[
    Tint,
    typer.Option(
        help="What the colours of invented surface say in pictures: that it is invented, or its confidence.",
        rich_help_panel=OUTPUT,
    ),
]
HtmlOption = Annotated[
    Path | None,
    typer.Option("--html", help="Where to put the report as an HTML page that stands alone.", rich_help_panel=OUTPUT),
]
PdfOption = Annotated[
    Path | None,
    typer.Option(
        "--pdf", help="Where to put that page as a PDF, of a service that prints one.", rich_help_panel=OUTPUT
    ),
]
PreviewOption = Annotated[
    Path | None,
    typer.Option(
        "--preview", "--picture", help="Where to put the before/after picture, a PNG.", rich_help_panel=OUTPUT
    ),
]
CloseupsOption = Annotated[
    Path | None,
    typer.Option(
        metavar="DIR",
        help="Draw every chosen hole before and after, as hole_<id>.png in this folder.",
        rich_help_panel=OUTPUT,
    ),
]
MeshArgument = Annotated[
    Path,
    typer.Argument(help="Mesh file: PLY, STL, OBJ, OFF, GLB, glTF or 3MF.", exists=True, dir_okay=False, readable=True),
]
FormatOption = Annotated[
    OutputFormat | None,
    typer.Option(
        "--format",
        help="Format of the mesh that comes back.",
        show_default="the suffix of OUTPUT",
        rich_help_panel=OUTPUT,
    ),
]
OverwriteOption = Annotated[
    bool, typer.Option("--overwrite", help="Let OUTPUT take the place of MESH.", rich_help_panel=OUTPUT)
]
ColoursOption = Annotated[
    Colours | None,
    typer.Option(
        help="Colours of new vertices and texels: the texture around a hole carried on, or just spread from its rim.",
        show_default="auto",
        rich_help_panel=OUTPUT,
    ),
]
LengthUnitOption = Annotated[
    LengthUnit | None,
    typer.Option(
        help="Unit of the coordinates, if the file states none; GLB and 3MF then hold the true size.",
        show_default="none",
        rich_help_panel=OUTPUT,
    ),
]
SeedOption = Annotated[int, typer.Option(help="Starts every random choice.")]
LabelOption = Annotated[
    str | None, typer.Option(help="A name for the job, for people.", show_default="name of the file")
]
PriorityOption = Annotated[
    Literal["interactive", "normal", "bulk"] | None,
    typer.Option(help="interactive goes before all others, bulk when no other job waits.", show_default="normal"),
]
AgainOption = Annotated[
    bool, typer.Option("--again", help="Start a new job although the same one is under way or done.")
]
TimeoutOption = Annotated[
    float | None, typer.Option(help="Seconds to wait for the job; then it is canceled.", show_default="none")
]


@dataclass(frozen=True)
class HoleChoice:
    """Which holes to fill, as given on the command line."""

    max_diameter: float | None = None
    max_perimeter: float | None = None
    all_but_largest: bool = False
    ids: list[int] | None = None
    include_borders: bool = False
    cap: Literal["flat"] | None = None
    rules: list[str] | None = None
    bridges: list[str] | None = None


@dataclass(frozen=True)
class MethodChoice:
    """How to fill them.

    Attributes
    ----------
    method : str, optional
        `dictionary` where a model or a recipe is named, else `auto`.
    """

    method: MethodName | None = None
    model: str | None = None
    length: float | None = None
    resolution: int | None = None
    overlap: int | None = None
    recipe: Recipe | None = None
    fit_steps: int | None = None
    fit_seconds: float | None = None
    preset: Preset | None = None
    effort: Effort | None = None


def tolerance(word: str | None) -> float | str | None:
    """Read `--weld-tolerance`: a number where it is one; the job spec refuses other words than `auto`."""
    try:
        return None if word is None else float(word)
    except ValueError:
        return word
