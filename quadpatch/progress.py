"""How a task tells its caller how far it is.

A module of its own, without numpy: the command line needs it before it knows whether there is anything to do.

Tested in `tests/quadpatch/cli/test_start.py`.
"""

from collections.abc import Callable

# Called as progress(stage, fraction done of that stage in 0..1).
Progress = Callable[[str, float], None]


def no_progress(stage: str, fraction: float) -> None:
    """Ignore progress."""


# Called with the done fraction of some work, 0..1.
Fraction = Callable[[float], None]


def no_fraction(done: float) -> None:
    """Ignore how far it is."""


def part_of(whole: Fraction, start: float, end: float) -> Fraction:
    """Return what turns the done fraction of a part of some work into one of the whole."""
    return lambda done: whole(start + done * (end - start))
