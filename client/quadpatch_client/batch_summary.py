"""What came of a batch: a table for people and a CSV file for spreadsheets.

Tested in `tests/quadpatch_client/test_batch.py`.
"""

import csv
import os
import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from quadpatch_client.file_repair import Row
from quadpatch_client.journal import DONE
from quadpatch_client.outputs import current_umask

_MOST_ROWS = 20
# What the table of the service calls the states of a file.
_STATES = {"done": "succeeded", "done_with_warnings": "succeeded_with_warnings"}
# Columns that an entry of an earlier version has in other places.
_OF_ROW = {
    "job_id": "job",
    "holes_found": "found",
    "holes_filled": "filled",
    "holes_filled_smooth": "filled_smooth",
    "holes_skipped": "skipped",
    "holes_refused": "refused",
    "new_triangles": "new_triangles",
    "work_seconds": "seconds",
}


def row_text(row: Row) -> str:
    """Return a row as one line for a log."""
    if row.state in DONE:
        filled = (row.filled or 0) + (row.filled_smooth or 0)
        left_open = (row.skipped or 0) + (row.refused or 0)
        warning = f"; WARNING: {row.reason}" if row.reason else ""
        return f"{row.file}: {filled} of {row.found} holes filled, {left_open} left open, {row.seconds:.1f} s{warning}"
    return f"{row.file}: {row.state}: {row.reason}"


def print_summary(console: Console, rows: Sequence[Row]) -> None:
    """Print how many files ended how, and what to look at: warnings and failures, at most 20 of each."""
    counts = Counter(row.state for row in rows)
    done = [row for row in rows if row.state in DONE]
    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("files", "holes", "filled", "left open", "triangles added", "seconds of work"):
        table.add_column(name, justify="right")
    numbers = (
        len(done),
        sum(row.found or 0 for row in done),
        sum((row.filled or 0) + (row.filled_smooth or 0) for row in done),
        sum((row.skipped or 0) + (row.refused or 0) for row in done),
        sum(row.new_triangles or 0 for row in done),
        round(sum(row.seconds or 0.0 for row in done)),
    )
    table.add_row(*(f"{number:,}" for number in numbers))
    console.print(table)
    states = (*DONE, "skipped", "failed")
    console.print(", ".join(f"{counts[state]:,} {state.replace('_', ' ')}" for state in states if counts[state]))
    for state, style in (("done_with_warnings", "yellow"), ("failed", "red")):
        _print_some(console, [row for row in rows if row.state == state], style)


def _print_some(console: Console, rows: Sequence[Row], style: str) -> None:
    for row in rows[:_MOST_ROWS]:
        console.print(row_text(row), markup=False, style=style)
    if len(rows) > _MOST_ROWS:
        console.print(f"… and {len(rows) - _MOST_ROWS:,} more; see the CSV file")


def figures(row: Row) -> dict[str, Any]:
    """Return what the table says of a file, by the columns that the service's table of a batch has."""
    from quadpatch_client.schema import FIGURES  # noqa: PLC0415  loads the wire schema, which --help does without

    known = {column: getattr(row, name) for column, name in _OF_ROW.items()} | row.figures
    said = {"mesh_name": row.file, "state": _STATES.get(row.state, row.state), "reason": row.reason or None}
    return {**dict.fromkeys(FIGURES), **known, **said}


def write_csv(path: Path, rows: Sequence[Row]) -> None:
    """Write one line a file, in one step."""
    from quadpatch_client.schema import FIGURES, spreadsheet_cell  # noqa: PLC0415  see figures

    descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
    # With a byte order mark, or spreadsheets take names for another encoding.
    with os.fdopen(descriptor, "w", encoding="utf-8-sig", newline="") as file:
        writer = csv.DictWriter(file, FIGURES)
        writer.writeheader()
        writer.writerows({name: spreadsheet_cell(value) for name, value in figures(row).items()} for row in rows)
    whole = Path(name)
    whole.chmod(0o666 & ~current_umask())
    whole.replace(path)
