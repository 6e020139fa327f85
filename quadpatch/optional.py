"""Optional steps: what fails in one of them is told in a sentence, and the repair goes on.

A picture is such a step, and so is what new vertices carry besides their position. A finished mesh is worth more than
either of them.
"""

import logging
from collections.abc import Callable

from quadpatch.errors import QuadpatchError

_log = logging.getLogger(__name__)


def failure_of(step: Callable[[], object], passing: tuple[type[Exception], ...] = ()) -> str | None:
    """Run an optional step.

    Parameters
    ----------
    step : callable
    passing : tuple of exception types
        What is no failure of the step, and is raised as it is.

    Returns
    -------
    str or None
        Why it failed, fit for a report: no path and no traceback, which go to the log. None where it did not fail.
    """
    try:
        step()
    except passing:
        raise
    except Exception as error:  # noqa: BLE001 - an optional step may raise anything and never ends a repair
        _log.warning("an optional step failed", exc_info=True)
        return _sentence(error)
    return None


def _sentence(error: Exception) -> str:
    if isinstance(error, QuadpatchError):
        return str(error)
    if isinstance(error, MemoryError):
        return "there is not enough memory"
    if isinstance(error, OSError):
        return error.strerror or "a file can't be written"
    return f"an internal error ({type(error).__name__})"
