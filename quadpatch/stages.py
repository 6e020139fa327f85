"""Stages of a repair: progress to the outside, seconds to the report."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from quadpatch.optional import failure_of
from quadpatch.types import Progress, no_progress


@dataclass
class Stages:
    """Reports when a stage starts and ends; adds up its seconds."""

    progress: Progress = no_progress
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time what happens inside."""
        self.progress(name, 0.0)
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
        self.progress(name, 1.0)


def harmless(progress: Progress) -> Progress:
    """Wrap a listener so that what it raises ends no repair; it is not called again after that."""
    listeners = [progress]

    def report(stage: str, fraction: float) -> None:
        if listeners and failure_of(lambda: listeners[0](stage, fraction)) is not None:
            listeners.clear()

    return report
