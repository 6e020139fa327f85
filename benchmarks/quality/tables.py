"""Tables of figures, for the console and for Markdown; means of ratios."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from rich.table import Table as RichTable

NOTHING = "–"


@dataclass(frozen=True)
class Table:
    """A title, column heads and rows of cells; the first column names the row.

    Attributes
    ----------
    n_summary : int
        So many of the last rows sum the others up; they are set in bold.
    """

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    n_summary: int = 0

    def to_rich(self) -> RichTable:
        """For the console."""
        table = RichTable(title=self.title)
        for i, column in enumerate(self.columns):
            table.add_column(column, justify="right" if i else "left")
        for i, row in enumerate(self.rows):
            table.add_row(*row, style="bold" if self._is_summary(i) else "")
        return table

    def to_markdown(self) -> str:
        """For a document: the title as a bold line, then a pipe table."""
        lines = [f"**{self.title}**", "", _pipes(self.columns), _pipes(["---", *["---:"] * (len(self.columns) - 1)])]
        for i, row in enumerate(self.rows):
            lines.append(_pipes([f"**{cell}**" for cell in row] if self._is_summary(i) else row))
        return "\n".join(lines) + "\n"

    def _is_summary(self, i: int) -> bool:
        return i >= len(self.rows) - self.n_summary


def _pipes(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def geometric_mean(values: Iterable[float | None]) -> float | None:
    """Geometric mean of what was measured; None where anything is missing, or a mean would hide it."""
    found = list(values)
    present = [value for value in found if value is not None]
    if not present or len(present) < len(found):
        return None
    return float(np.exp(np.mean(np.log(present))))


def ratio(value: float | None, reference: float | None) -> float | None:
    """One measure over another, None where either is missing."""
    return None if value is None or not reference else value / reference


def figure(value: float | None, digits: int = 3) -> str:
    """Write a figure, or a dash for none."""
    return NOTHING if value is None else f"{value:.{digits}f}"


def scientific(value: float | None) -> str:
    """Write a length of the unit cube in millionths, or a dash for none."""
    return NOTHING if value is None else f"{1e6 * value:.0f}"
