"""What people read while a command runs: errors in one line, and bars of progress.

Tested in `tests/quadpatch/cli/test_fill.py`.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NoReturn

from rich.console import Console
from rich.text import Text

from quadpatch.errors import QuadpatchError
from quadpatch.progress import Progress, no_progress

if TYPE_CHECKING:
    from rich.progress import TaskID

errors = Console(stderr=True)


def say(message: str) -> None:
    """Print for people, as it is: names of files may look like markup."""
    errors.print(Text(message))


@contextmanager
def clear_errors() -> Iterator[None]:
    """Turn what is wrong with files, options and models into one line and exit code 1."""
    try:
        yield
    except QuadpatchError as error:
        _fail(error.code, str(error))
    except OSError as error:
        # Reading has errors of its own: this is the output, the report or the picture.
        _fail("not_writable", f"{error.filename} can't be written: {error.strerror}")


def _fail(code: str, message: str) -> NoReturn:
    """Print one line, unwrapped and as it is: scripts read it, and names of files may look like markup."""
    errors.print(Text(f"{code}: {message}"), soft_wrap=True)
    sys.exit(1)


@contextmanager
def progress_bars(quiet: bool) -> Iterator[Progress]:
    """Show a bar for each stage on a terminal; nothing elsewhere."""
    if quiet or not errors.is_terminal:
        yield no_progress
        return
    from rich import progress as rich_progress  # noqa: PLC0415  no script needs it

    columns = (
        rich_progress.TextColumn("{task.description:<14}"),
        rich_progress.BarColumn(),
        rich_progress.TimeElapsedColumn(),
    )
    with rich_progress.Progress(*columns, console=errors) as bars:
        tasks: dict[str, TaskID] = {}

        def progress(stage: str, fraction: float) -> None:
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=1.0)
            bars.update(tasks[stage], completed=fraction)

        yield progress
