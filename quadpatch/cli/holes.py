"""`holes` lists what could be filled.

Tested in `tests/quadpatch/cli/test_fill.py`.
"""

import json
import math
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from quadpatch.cli.flags import Source, WeldTolerance, read_tolerance
from quadpatch.cli.messages import clear_errors, say
from quadpatch.cli.reports import n_holes
from quadpatch.cli.scipy_start import prepare_libraries

MAX_TABLE_WIDTH = 100


def holes(
    source: Source,
    weld_tolerance: WeldTolerance = "auto",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List the holes of a mesh file, and which of them would be filled."""
    prepare_libraries()
    from quadpatch.repair import inspect_file  # noqa: PLC0415  slow to load

    with clear_errors():
        facts = inspect_file(source, read_tolerance(weld_tolerance))
    if as_json:
        print(json.dumps(facts, indent=2))  # noqa: T201  data for standard output
        return
    unit = facts["length_unit"]
    table = Table(title=Text(f"{source.name}: {n_holes(len(facts['holes']))}, lengths in {unit}"))
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
    for proposal in facts["bridges"]:
        say(_proposal(proposal, unit))
    for warning in facts["warnings"]:
        say(f"Warning: {warning}")


def _proposal(proposal: dict[str, Any], unit: str) -> str:
    """Say which loops face each other, and how they are joined."""
    first, second = proposal["holes"]
    where = "all around" if proposal["shape"] == "ring" else "along a part of their rims"
    facing = f"Loops {first} and {second} face each other {where}, {proposal['gap']:.4g} {unit} apart"
    return f"{facing}: --bridge {first}:{second} joins them; by default they are not joined."


def _centre(row: dict[str, Any]) -> str:
    """Write the centre of a hole to a thousandth of its diameter."""
    digits = 3 - math.floor(math.log10(row["diameter"])) if row["diameter"] > 0 else 3
    return " ".join(f"{round(coordinate, digits) + 0.0:.7g}" for coordinate in row["centre"])
