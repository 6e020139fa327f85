"""What the command lines of training have in common: errors as one line, and what was typed."""

import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer
from rich.console import Console

from jobkit.errors import JobkitError
from quadpatch.errors import QuadpatchError
from training.errors import TrainingError

# What does not change the model. The folder of a corpus is kept: the next command names it.
_DROPPED = ("--output", "--curve", "--checkpoint", "--resume", "--tensorboard")
_DROPPED_FLAGS = ("--register",)


@contextmanager
def refusals(console: Console) -> Iterator[None]:
    """Answer an error with its code and its sentence, and end the process with 1."""
    try:
        yield
    except (QuadpatchError, JobkitError, TrainingError) as error:
        console.print(f"error ({error.code}): {error}", style="red", highlight=False, markup=False)
        raise typer.Exit(1) from None


def command_line() -> str:
    """Return what was typed, without the folders that files lie in and without what does not change the bytes."""
    kept, arguments = ["python", "-m", "training"], iter(sys.argv[1:])
    dropped = set(_DROPPED) - ({"--output"} if sys.argv[1:2] == ["corpus"] else set())
    for argument in arguments:
        option, _, value = argument.partition("=")
        if option in dropped:
            if not value:
                next(arguments, None)
        elif option not in _DROPPED_FLAGS:
            kept.append(Path(argument).name if "/" in argument else argument)
    return shlex.join(kept)
