"""Output for people: progress bars on a terminal, plain lines elsewhere, errors only when quiet.

All of it goes to stderr by default; stdout is for data.
"""

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from typing import TYPE_CHECKING, Any

from rich.console import Console

from quadpatch_client.progress import ByteProgress, no_progress

if TYPE_CHECKING:
    from quadpatch_client.schema import Job

_LABEL_WIDTH = 12


class Screen:
    """Messages and progress on a terminal, or in the log of a script.

    Parameters
    ----------
    quiet : bool
        Show errors only.
    console : rich.console.Console, optional
        Where to show it; None: stderr.
    as_json : bool
        Print what a command fails with as JSON on stdout, too.
    """

    def __init__(self, quiet: bool = False, console: Console | None = None, as_json: bool = False) -> None:
        self._as_json = as_json
        self.console = console or Console(stderr=True, highlight=False)
        self._quiet = quiet

    def say(self, text: str, style: str = "") -> None:
        """Print a line."""
        if not self._quiet:
            self.console.print(text, style=style, markup=False, soft_wrap=True)

    def tell(self, paragraph: str) -> None:
        """Print a paragraph, wrapped between words on a terminal, in one line elsewhere."""
        if not self._quiet:
            self.console.print(paragraph, markup=False, soft_wrap=not self.console.is_terminal)

    def complain(self, text: str) -> None:
        """Print an error, quiet or not."""
        self.console.print(f"error: {text}", style="red", markup=False, soft_wrap=True)

    def fail(self, message: str, exit_code: int, code: str, job: str | None = None) -> None:
        """Print what a command ends with.

        Parameters
        ----------
        message : str
        exit_code : int
        code : str
            Stable, for scripts.
        job : str, optional
            Id of the job that it is about.
        """
        self.complain(message)
        if self._as_json:
            error = {"code": code, "message": message, "exit_code": exit_code, "job": job}
            sys.stdout.write(json.dumps({"error": error}, indent=2) + "\n")

    @contextmanager
    def transfer(self, label: str) -> Iterator[ByteProgress]:
        """Show the progress of a transfer; yields the callback for it."""
        if self._quiet or not self.console.is_terminal:
            yield no_progress
            return
        from rich.progress import DownloadColumn, Progress, TransferSpeedColumn  # noqa: PLC0415  no script needs it

        with Progress(
            *_columns(), DownloadColumn(), TransferSpeedColumn(), console=self.console, transient=True
        ) as bar:
            task = bar.add_task(label, total=None)
            yield lambda done, total: bar.update(task, completed=done, total=total)

    @contextmanager
    def counting(self, label: str, done: int, total: int) -> Iterator[Callable[[str], None]]:
        """Show how many of a number of things are done; yields what is called with a line for each further one."""
        if self._quiet or not self.console.is_terminal:
            numbers = count(done + 1)
            yield lambda line: self.say(f"{next(numbers)}/{total}  {line}")
            return
        from rich.progress import MofNCompleteColumn, Progress, TimeElapsedColumn  # noqa: PLC0415  see above

        with Progress(*_columns(), MofNCompleteColumn(), TimeElapsedColumn(), console=self.console) as bar:
            task = bar.add_task(label, completed=done, total=total)

            def step(line: str) -> None:
                bar.console.print(line, markup=False, soft_wrap=True)
                bar.advance(task)

            yield step

    @contextmanager
    def repair(self) -> Iterator[Callable[["Job"], None]]:
        """Show the progress of a job; yields the callback for its changes."""
        if self._quiet:
            yield lambda job: None
            return
        if not self.console.is_terminal:
            yield _StageLines(self)
            return
        from rich.progress import Progress, TextColumn, TimeElapsedColumn  # noqa: PLC0415  see above

        status = TextColumn("{task.fields[status]}")
        with Progress(*_columns(), status, TimeElapsedColumn(), console=self.console, transient=True) as bar:
            task = bar.add_task("repairing", total=100.0, status="")
            yield lambda job: bar.update(task, completed=job.percent, status=status_line(job))


def status_line(job: "Job") -> str:
    """Describe the progress of a job: its stage or state, its place in the queue, and the seconds left."""
    position = None if job.queue_position is None else f"number {job.queue_position} in line"
    remaining = None if job.eta_s is None else f"about {_duration(job.eta_s)} left"
    return ", ".join(part for part in (_stage(job), position, remaining) if part)


class _StageLines:
    """One line per stage and per place in the queue, for logs."""

    def __init__(self, screen: Screen) -> None:
        self._screen = screen
        self._last: tuple[str, int | None] | None = None

    def __call__(self, job: "Job") -> None:
        progress = (_stage(job), job.queue_position)
        if progress != self._last:
            self._last = progress
            self._screen.say(f"{job.percent:5.1f} %  {status_line(job)}")


def _columns() -> list[Any]:
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn  # noqa: PLC0415  see above

    return [TextColumn(f"{{task.description:<{_LABEL_WIDTH}}}"), BarColumn(), TaskProgressColumn()]


def _stage(job: "Job") -> str:
    from quadpatch_client.schema import JobState  # noqa: PLC0415  loaded by the time that there is a job

    if job.state == JobState.RUNNING:
        return job.stage or "starting"
    if job.waits_for is not None:
        return f"waits for {job.waits_for}"
    return job.state.value.replace("_", " ")


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{max(round(seconds), 1)} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
