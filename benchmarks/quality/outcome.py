"""What an experiment gives: tables, figures as JSON, plots and pictures; and where they are put."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from PIL import Image
from rich.console import Console

from benchmarks.quality.tables import Table

# A palette makes pictures of clay half as large. It covers all colours, or the few tints would turn to steps.
_COLOURS, _REFINEMENTS = 192, 3


@dataclass(frozen=True)
class Outcome:
    """Outcome of one experiment.

    Attributes
    ----------
    name : str
    tables : sequence of Table
    data : mapping
        JSON-ready.
    plots : mapping of str to Figure or Image
        Plots, and pictures of meshes.
    """

    name: str
    tables: Sequence[Table]
    data: Mapping[str, Any]
    plots: Mapping[str, Figure | Image.Image] = field(default_factory=dict)

    def publish(self, output: Path, console: Console) -> None:
        """Print the tables; write NAME.json, NAME.md and one NAME_PLOT.png for each plot."""
        for table in self.tables:
            console.print(table.to_rich())
        output.mkdir(parents=True, exist_ok=True)
        (output / f"{self.name}.json").write_text(json.dumps(self.data, indent=1) + "\n")
        fragments = [table.to_markdown() for table in self.tables]
        for name, plot in self.plots.items():
            file = f"{self.name}_{name}.png"
            _save(plot, output / file)
            fragments.append(f"![{self.name}: {name.replace('_', ' ')}]({file})\n")
        (output / f"{self.name}.md").write_text("\n".join(fragments))


def _save(plot: Figure | Image.Image, path: Path) -> None:
    if isinstance(plot, Figure):
        plot.savefig(path, dpi=110)
    else:
        with_palette = plot.quantize(_COLOURS, Image.Quantize.MAXCOVERAGE, _REFINEMENTS, dither=Image.Dither.NONE)
        with_palette.save(path, format="PNG", optimize=True)


@dataclass
class Progress:
    """One line on stderr for each step."""

    n_steps: int
    console: Console = field(default_factory=lambda: Console(stderr=True, highlight=False))
    done: int = 0

    def step(self, what: str) -> None:
        """Say what was done."""
        self.done += 1
        self.console.print(f"[{self.done}/{self.n_steps}] {what}", markup=False, soft_wrap=True)
