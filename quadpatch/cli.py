"""The command line of the method: `fill` repairs a file, `holes` lists what could be filled.

Data goes to standard output, progress and errors to standard error. Exit codes: 0 done, 1 the file, the model or an
option is at fault (`code: message` on standard error), 2 wrong usage.
"""

import json
import logging
import math
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NoReturn

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

from quadpatch import types
from quadpatch.errors import OptionError, QuadpatchError
from quadpatch.formats.output_files import check_folder, check_outputs, is_stream, write_whole
from quadpatch.options import (
    DictionaryOptions,
    HoleOptions,
    HoleRule,
    NetworkOptions,
    PatchOptions,
    Recipe,
    RepairOptions,
)
from shared_rules.hole_selection import Cap
from shared_rules.rule_text import RuleTextError, read_rule

if TYPE_CHECKING:
    from quadpatch.repair import RepairedFile

app = typer.Typer(help="Repair holes in 3D scans.", no_args_is_help=True, add_completion=False)
_errors = Console(stderr=True)
FITTING = NetworkOptions()
MAX_TABLE_WIDTH = 100

Source = Annotated[Path, typer.Argument(metavar="IN", help="Mesh: PLY, STL, OBJ, OFF, GLB/glTF or 3MF.")]

WeldTolerance = Annotated[
    str,
    typer.Option(
        metavar="AUTO|LENGTH",
        help="Join boundary vertices this far apart (mesh units); 0: only equal ones; auto: as far as rounding goes.",
    ),
]


@app.command()
def fill(  # noqa: PLR0913, PLR0917  one argument per flag
    source: Source,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="OUT", help="Its suffix says the format; -: standard output.")
    ],
    model: Annotated[
        str,
        typer.Option(
            help="self (learn a dictionary from this mesh), self-network (fit a network to it: minutes), "
            "smooth (geometry only), a shipped model, or a model file."
        ),
    ] = "self",
    recipe: Annotated[
        Recipe, typer.Option(help="How the model is put to use: our way, or exactly the paper's.")
    ] = "default",
    report: Annotated[Path | None, typer.Option(help="Write the report as JSON; -: standard output.")] = None,
    preview: Annotated[
        Path | None, typer.Option("--preview", "--picture", help="Write a before/after picture as PNG.")
    ] = None,
    closeups: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Draw every chosen hole before and after, as hole_<id>.png in this folder."),
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Let OUT take the place of IN.")] = False,
    max_diameter: Annotated[float | None, typer.Option(help="Leave wider holes open (mesh units).")] = None,
    max_perimeter: Annotated[float | None, typer.Option(help="Leave longer rims open (mesh units).")] = None,
    all_but_largest: Annotated[bool, typer.Option(help="Leave the widest loop open.")] = False,
    hole: Annotated[list[int] | None, typer.Option(help="Fill just this hole; repeat for more.")] = None,
    include_borders: Annotated[
        bool, typer.Option("--include-borders", help="Treat outer borders of pieces like holes.")
    ] = False,
    cap: Annotated[Cap | None, typer.Option(help="Close open ends, as of tubes, by a plane patch.")] = None,
    rule: Annotated[
        list[str] | None,
        typer.Option(
            metavar="[CONDITION,...:]ACTION",
            help="What to do with some holes: max_diameter=5:smooth, kind=open_end:flat, id=3,id=4:skip. "
            "Repeat for more; the first that fits counts.",
        ),
    ] = None,
    patch_length: Annotated[float | None, typer.Option(help="Side of a patch (mesh units).")] = None,
    resolution: Annotated[int | None, typer.Option(help="Bins along one side of a patch.")] = None,
    overlap: Annotated[int | None, typer.Option(help="k: every quad carries 1 + 4 k patches.")] = None,
    atoms: Annotated[int | None, typer.Option(help="Atoms to learn (recipe paper, model self).")] = None,
    nonzero: Annotated[
        int | None, typer.Option(help="Atoms that one patch may use (recipe paper, model self).")
    ] = None,
    fit_steps: Annotated[int, typer.Option(help="Fit at most so many steps (model self-network).")] = FITTING.steps,
    fit_seconds: Annotated[float, typer.Option(help="Fit at most so long (model self-network).")] = FITTING.seconds,
    weld_tolerance: WeldTolerance = "auto",
    seed: Annotated[int, typer.Option(help="Start of every random choice.")] = 0,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress, no summary.")] = False,
) -> None:
    """Repair a mesh file."""
    from quadpatch.repair import repair_and_keep  # noqa: PLC0415  the libraries behind it take a second to load

    with _clear_errors(), _progress(quiet) as progress:
        options = RepairOptions(
            HoleOptions(
                max_diameter,
                max_perimeter,
                all_but_largest,
                tuple(hole) if hole else None,
                include_borders,
                cap,
                tuple(_rule(text) for text in rule or ()),
            ),
            PatchOptions(patch_length, resolution, overlap),
            seed,
            recipe,
            DictionaryOptions(atoms, nonzero),
            NetworkOptions(fit_steps, fit_seconds),
            _tolerance(weld_tolerance),
        )
        others = [path for path in (report, preview) if path]
        check_outputs(source, output, others, may_overwrite=overwrite)
        if closeups:
            check_folder(closeups, [source, output, *others])
        repaired = repair_and_keep(source, output, model, options, progress)
        logging.getLogger("quadpatch").addHandler(logging.NullHandler())  # what people read is in the warnings
        if report and not is_stream(report):  # drawing may take the process down
            _write_report(repaired, report)
        _draw(repaired, preview, closeups)
        _write_report(repaired, report)
    if not quiet:
        _errors.print(Text(summary(repaired.report)))


@app.command()
def holes(
    source: Source,
    weld_tolerance: WeldTolerance = "auto",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List the holes of a mesh file, and which of them would be filled."""
    from quadpatch.repair import inspect_file  # noqa: PLC0415  the libraries behind it take a second to load

    with _clear_errors():
        facts = inspect_file(source, _tolerance(weld_tolerance))
    if as_json:
        print(json.dumps(facts, indent=2))  # noqa: T201  data for standard output
        return
    unit = facts["length_unit"]
    table = Table(title=Text(f"{source.name}: {_holes(len(facts['holes']))}, lengths in {unit}"))
    for name in ("id", "edges", "perimeter", "diameter"):
        table.add_column(name, justify="right")
    for name in ("kind", "centre", "by default"):
        table.add_column(name, overflow="fold")
    for row in facts["holes"]:
        numbers = [f"{row[name]:.5g}" for name in ("perimeter", "diameter")]
        fate = (row["reason"] or "fill") if row["chosen"] else f"leave open: {row['reason']}"
        table.add_row(str(row["id"]), str(row["edges"]), *numbers, row["kind"], _centre(row), fate)
    console = Console()
    console.print(table, width=min(console.width, MAX_TABLE_WIDTH))
    for warning in facts["warnings"]:
        _errors.print(Text(f"Warning: {warning}"))


def _centre(row: dict[str, Any]) -> str:
    """Write the centre of a hole to a thousandth of its diameter."""
    digits = 3 - math.floor(math.log10(row["diameter"])) if row["diameter"] > 0 else 3
    return " ".join(f"{round(coordinate, digits) + 0.0:.7g}" for coordinate in row["centre"])


def _rule(text: str) -> HoleRule:
    """Read one `--rule`; what is no rule raises OptionError."""
    try:
        return HoleRule.from_dict(read_rule(text))
    except RuleTextError as error:
        raise OptionError(str(error)) from error


def _tolerance(word: str) -> float | Literal["auto"]:
    """Read `--weld-tolerance`; what is neither `auto` nor a number raises OptionError."""
    if word == "auto":
        return "auto"
    try:
        return float(word)
    except ValueError:
        raise OptionError(f"--weld-tolerance must be auto or a number; it is {word!r}") from None


def summary(report: dict[str, Any]) -> str:
    """One paragraph for people: what was found, filled and left open, and why."""
    counts = report["counts"]
    open_holes = counts["skipped"] + counts["refused"]
    base = report["model"].get("fitted_from")
    model = f"{base}, fitted to this mesh" if base else "the model"
    text = f"{_holes(counts['found'])}: {counts['filled']} filled by {model}, {counts['filled_smooth']} by geometry"
    text += _reasons(report, "filled_smooth") + f", {open_holes} left open" + _reasons(report, "skipped", "refused")
    seconds = sum(stage["seconds"] for stage in report["stages"])
    warnings = "".join(f" Warning: {warning}." for warning in report["warnings"])
    return f"{text}. {seconds:.1f} s.{warnings}"


def _reasons(report: dict[str, Any], *verdicts: str) -> str:
    """Count the reasons behind some verdicts, in brackets; empty where there are none."""
    counts = Counter(row["reason"] for row in report["holes"] if row["verdict"] in verdicts)
    return " (" + "; ".join(f"{count} × {reason}" for reason, count in counts.items()) + ")" if counts else ""


def _holes(count: int) -> str:
    return "1 hole" if count == 1 else f"{count} holes"


def _draw(repaired: "RepairedFile", preview: Path | None, closeups: Path | None) -> None:
    """Draw what was asked for; what fails is a warning in the report."""
    from quadpatch.preview.drawing import add_close_ups, add_picture  # noqa: PLC0415  see fill

    if preview:
        add_picture(repaired, preview)
    if closeups:
        add_close_ups(repaired, closeups)


def _write_report(repaired: "RepairedFile", path: Path | None) -> None:
    """Write the report, if it was asked for."""
    if path:
        write_whole(path, (json.dumps(repaired.report, indent=2) + "\n").encode())


@contextmanager
def _clear_errors() -> Iterator[None]:
    try:
        yield
    except QuadpatchError as error:
        _fail(error.code, str(error))
    except OSError as error:
        # Reading has errors of its own: this is the output, the report or the picture.
        _fail("not_writable", f"{error.filename} can't be written: {error.strerror}")


def _fail(code: str, message: str) -> NoReturn:
    """Print one line, unwrapped and as it is: scripts read it, and names of files may look like markup."""
    _errors.print(Text(f"{code}: {message}"), soft_wrap=True)
    sys.exit(1)


@contextmanager
def _progress(quiet: bool) -> Iterator[types.Progress]:
    """Show a bar on a terminal; nothing elsewhere."""
    if quiet or not _errors.is_terminal:
        yield types.no_progress
        return
    columns = TextColumn("{task.description:<14}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=_errors) as bars:
        tasks: dict[str, TaskID] = {}

        def progress(stage: str, fraction: float) -> None:
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=1.0)
            bars.update(tasks[stage], completed=fraction)

        yield progress
