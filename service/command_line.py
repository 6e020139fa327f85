"""What the commands of `python -m service` share: errors in one line, and columns.

Tested in `tests/service/test_main.py`.
"""

import argparse
import sys
from collections.abc import Sequence
from typing import NoReturn


class CommandParser(argparse.ArgumentParser):
    """Says what is wrong in one line, and exits with 2."""

    def error(self, message: str) -> NoReturn:
        """Write the message to standard error."""
        sys.stderr.write(f"quadpatch: {message}\n")
        sys.exit(2)


def print_columns(rows: Sequence[Sequence[str]]) -> None:
    """Print a table; its first row is the head."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for row in rows:
        sys.stdout.write("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() + "\n")
