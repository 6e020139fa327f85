"""Stages of a repair: progress to the outside, seconds and memory to the report, and steps whose failure is a warning.

A picture is such an optional step, and so is what new vertices carry besides their position. A finished mesh is worth
more than either of them.
"""

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from resource import RUSAGE_SELF, getrusage

from quadpatch.errors import QuadpatchError
from quadpatch.processes import ProcessPool
from quadpatch.progress import Fraction, Progress, no_progress, part_of
from quadpatch_rules.stages import Stage

_log = logging.getLogger(__name__)


@dataclass
class Stages:
    """Reports when a stage starts and ends; adds up its seconds; has the processes that share the work."""

    progress: Progress = no_progress
    pool: ProcessPool = field(default_factory=ProcessPool)
    seconds: dict[str, float] = field(default_factory=dict)
    peak_memory_mib: dict[str, int] = field(default_factory=dict)
    _current: Stage | None = None

    def part(self, start: float, end: float) -> Fraction:
        """Return what turns the done fraction of a part of this stage into one of the whole stage, and reports it."""
        name = self._current

        def reach(fraction: float) -> None:
            if name is not None:
                self.progress(name, fraction)

        return part_of(reach, start, end)

    @contextmanager
    def stage(self, name: Stage) -> Iterator[None]:
        """Time what happens inside."""
        self._current = name
        self.progress(name, 0.0)
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
            self.peak_memory_mib[name] = peak_memory_mib() + self.pool.extra_memory_mib
        self.progress(name, 1.0)


def peak_memory_mib() -> int:
    """Return the most memory that this process has had at once."""
    return getrusage(RUSAGE_SELF).ru_maxrss // 1024


def harmless(progress: Progress) -> Progress:
    """Wrap a listener so that what it raises ends no repair; it is not called again after that."""
    listeners = [progress]

    def report(stage: str, fraction: float) -> None:
        if listeners and failure_of(lambda: listeners[0](stage, fraction)) is not None:
            listeners.clear()

    return report


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
