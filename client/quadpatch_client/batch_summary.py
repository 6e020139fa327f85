"""What came of a batch: a table for people and a CSV file for spreadsheets.

Tested in `tests/quadpatch_client/test_batch.py`.
"""

import csv
import os
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path

from rich.console import Console
from rich.table import Table

from quadpatch_client.file_repair import Row
from quadpatch_client.journal import DONE
from quadpatch_client.outputs import current_umask

_MOST_ROWS = 20
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


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


def write_csv(path: Path, rows: Sequence[Row]) -> None:
    """Write one line a file, in one step."""
    descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
    # With a byte order mark, or spreadsheets take names for another encoding.
    with os.fdopen(descriptor, "w", encoding="utf-8-sig", newline="") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(Row)])
        writer.writeheader()
        writer.writerows({name: _plain(value) for name, value in asdict(row).items()} for row in rows)
    whole = Path(name)
    whole.chmod(0o666 & ~current_umask())
    whole.replace(path)


def _plain(value: object) -> object:
    """Keep a spreadsheet from taking a text of the service, or a file name, for a formula."""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value
