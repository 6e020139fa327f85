"""What an experiment gives: tables, figures as JSON, plots; and where they are put."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from rich.console import Console

from benchmarks.quality.tables import Table


@dataclass(frozen=True)
class Outcome:
    """Outcome of one experiment."""

    name: str
    tables: Sequence[Table]
    data: Mapping[str, Any]
    plots: Mapping[str, Figure] = field(default_factory=dict)

    def publish(self, output: Path, console: Console) -> None:
        """Print the tables; write NAME.json, NAME.md and one NAME_PLOT.png for each plot."""
        for table in self.tables:
            console.print(table.to_rich())
        output.mkdir(parents=True, exist_ok=True)
        (output / f"{self.name}.json").write_text(json.dumps(self.data, indent=1) + "\n")
        fragments = [table.to_markdown() for table in self.tables]
        for name, plot in self.plots.items():
            file = f"{self.name}_{name}.png"
            plot.savefig(output / file, dpi=110)
            fragments.append(f"![{self.name}: {name.replace('_', ' ')}]({file})\n")
        (output / f"{self.name}.md").write_text("\n".join(fragments))


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
