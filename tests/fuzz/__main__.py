"""`python -m tests.fuzz`, or `make fuzz`: damaged meshes through the repair, and what came of them as a table.

The exit code is 1 where a run crashed, changed what was measured, or has a fault that the report does not name. The
files of such runs stay in a folder.
"""

import argparse
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from tests.fuzz.campaign import KINDS, Outcome, run

_COLUMNS = ("damage", "runs", "filled", "refused", "folds", "crossings", "unnamed", "not kept", "crashes")


def main(arguments: list[str]) -> int:
    """Run one campaign; returns the exit code."""
    parser = argparse.ArgumentParser(prog="make fuzz ARGS=...", description=__doc__)
    parser.add_argument("--count", type=int, default=300, help="runs; default 300")
    parser.add_argument("--first", type=int, default=0, help="number of the first run; default 0")
    parser.add_argument("--seed", type=int, default=1, help="of all chance; default 1")
    parser.add_argument("--keep", type=Path, default=Path("var/fuzz"), help="folder for runs with a fault")
    chosen = parser.parse_args(arguments)
    outcomes = []
    for number in range(chosen.first, chosen.first + chosen.count):
        folder = chosen.keep / f"seed{chosen.seed}_{number}"
        outcomes.append(run(chosen.seed, number, folder))
        if outcomes[-1].is_sound:
            shutil.rmtree(folder)
        else:
            (folder / "outcome.txt").write_text(f"{outcomes[-1]}\n{outcomes[-1].crash}")
            sys.stderr.write(_said(outcomes[-1], folder))
    sys.stdout.write(to_text(outcomes))
    return 0 if all(outcome.is_sound for outcome in outcomes) else 1


def to_text(outcomes: Sequence[Outcome]) -> str:
    """Sum the runs up, one line for each kind of damage."""
    rows: list[tuple[str, ...]] = [_COLUMNS]
    for kind in (*KINDS, ""):
        mine = [outcome for outcome in outcomes if kind in (outcome.kind, "")]
        if mine:
            rows.append((kind or "all", *map(str, _sums(mine))))
    widths = [max(len(row[k]) for row in rows) for k in range(len(_COLUMNS))]
    lines = []
    for row in rows:
        cells = [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append("  ".join([row[0].ljust(widths[0]), *cells]) + "\n")
    return "".join(lines)


def _sums(outcomes: Sequence[Outcome]) -> tuple[int, ...]:
    return (
        len(outcomes),
        sum(outcome.filled for outcome in outcomes),
        sum(outcome.refused for outcome in outcomes),
        sum(outcome.folds for outcome in outcomes),
        sum(outcome.crossings for outcome in outcomes),
        sum(outcome.unnamed for outcome in outcomes),
        sum(not outcome.is_kept for outcome in outcomes),
        sum(bool(outcome.crash) for outcome in outcomes),
    )


def _said(outcome: Outcome, folder: Path) -> str:
    if outcome.crash:
        what = outcome.crash.strip().splitlines()[-1]
    elif not outcome.is_kept:
        what = "measured vertices or triangles changed"
    else:
        what = (
            f"{outcome.folds} folds of which {outcome.named_folds} are named, "
            f"{outcome.crossings} crossing triangles of which {outcome.named_crossings} are named"
        )
    return f"run {outcome.number} ({outcome.kind}): {what}; files in {folder}\n"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
