"""Options that several commands share, and how those of a repair become a job spec."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import typer
from pydantic import ValidationError

from client.errors import UsageError
from jobkit.schema import SELF, JobSpec, OutputFormat, Preset, Recipe, conflict_of
from shared_rules.rule_text import RuleTextError, read_rule

DEFAULT_URL = "http://127.0.0.1:8000"
MethodName = Literal["dictionary", "cnn", "smooth"]

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


OUTPUT = "What comes back"
OutputOption = Annotated[
    Path,
    typer.Option("--output", "-o", help="Where to put the repaired mesh; -: standard output.", rich_help_panel=OUTPUT),
]
ReportOption = Annotated[
    Path | None, typer.Option(help="Where to put the JSON report; -: standard output.", rich_help_panel=OUTPUT)
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
SeedOption = Annotated[int, typer.Option(help="Starts every random choice.")]
LabelOption = Annotated[str | None, typer.Option(help="A name for the job, for people.")]
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


@dataclass(frozen=True)
class MethodChoice:
    """How to fill them."""

    method: MethodName = "dictionary"
    model: str | None = None
    length: float | None = None
    resolution: int | None = None
    overlap: int | None = None
    recipe: Recipe | None = None
    fit_steps: int | None = None
    fit_seconds: float | None = None
    preset: Preset | None = None


def make_spec(mesh_id: str, holes: HoleChoice, method: MethodChoice, **rest: Any) -> JobSpec:
    """Build a job spec from what was given; the service fills in the defaults of what was not.

    Raises
    ------
    UsageError
        If an option is out of its range, or does not go with the method or with another option.
    """
    chosen = _given({**vars(holes), "rules": _rules(holes.rules)})
    values = {"mesh_id": mesh_id, "holes": chosen, **_given({"method": _method(method)}), **_given(rest)}
    try:
        spec = JobSpec.model_validate(values)
    except ValidationError as error:
        lines = [f"{'.'.join(str(step) for step in e['loc'])}: {e['msg']}" for e in error.errors()]
        raise UsageError("; ".join(lines)) from error
    conflict = conflict_of(spec)
    if conflict is not None:
        raise UsageError(conflict)
    return spec


def tolerance(word: str | None) -> float | str | None:
    """Read `--weld-tolerance`: a number where it is one; the job spec refuses other words than `auto`."""
    try:
        return None if word is None else float(word)
    except ValueError:
        return word


def _method(choice: MethodChoice) -> dict[str, Any]:
    patches = _given({name: getattr(choice, name) for name in ("length", "resolution", "overlap", "preset")})
    fitting = _given({"steps": choice.fit_steps, "seconds": choice.fit_seconds})
    if choice == MethodChoice():
        return {}  # the service has a default of its own for each task
    if fitting and (choice.method, choice.model) != ("cnn", SELF):
        raise UsageError("only the method 'cnn' with the model 'self' fits a network; others take no time to fit")
    if choice.method == "smooth":
        if choice.model is not None or choice.recipe is not None or patches:
            raise UsageError("the method 'smooth' takes no model, no recipe and no patch options")
        return {"method": "smooth"}
    rest = _given({"model": choice.model, "recipe": choice.recipe, "fitting": fitting})
    return {"method": choice.method, "patches": patches, **rest}


def _given(values: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if value not in (None, [], {})}


def _rules(texts: Sequence[str] | None) -> list[dict[str, Any]]:
    try:
        return [read_rule(text) for text in texts or ()]
    except RuleTextError as error:
        raise UsageError(str(error)) from error
