"""The heartbeat of one attempt: a thread that renews the lease, writes progress and reads the cancel flag.

Only this thread uses the database while the engine works, so a slow database never delays the supervision of the
engine.
"""

import logging
import threading
import time
from collections.abc import Callable
from contextvars import copy_context
from dataclasses import dataclass
from typing import Self

from jobkit.errors import DatabaseError, DatabaseUnavailableError, StaleAttemptError
from worker.failures import StopReason
from worker.progress import Progress

# How soon a cancel is noticed, and how often progress is written at most.
_TICK_S = 0.5
# Longer than a database takes to be restarted or to fail over.
OUTAGE_TIMEOUT_S = 120.0

_log = logging.getLogger("quadpatch.worker.heartbeat")


@dataclass(frozen=True)
class HeartbeatCalls:
    """What a heartbeat calls.

    Attributes
    ----------
    renew : callable
        Renews the lease, given the present and the peak memory, in MiB, and returns whether a client asked for the end;
        raises StaleAttemptError.
    is_cancel_requested : callable
        Reads the same between two renewals; raises StaleAttemptError.
    report : callable
        Writes stage and percent; raises StaleAttemptError.
    heartbeat_s : float
        Seconds between two renewals.
    outage_timeout_s : float
        Seconds for which an unavailable database is waited for: meanwhile no other worker can start the job either.
    """

    renew: Callable[[int, int], bool]
    is_cancel_requested: Callable[[], bool]
    report: Callable[[str, float], None]
    heartbeat_s: float
    outage_timeout_s: float = OUTAGE_TIMEOUT_S


class Heartbeat:
    """Beats from entering a `with` block until leaving it; progress is that of a job."""

    def __init__(self, heartbeat_calls: HeartbeatCalls, progress: Progress | None = None) -> None:
        self._heartbeat_calls = heartbeat_calls
        self._progress = progress or Progress()
        self._written_progress = ("", 0.0)
        self._memory_mb = 0
        self.peak_mb = 0
        self._stop_event = threading.Event()
        self._renewed_at = time.monotonic()
        self._thread = threading.Thread(target=copy_context().run, args=(self._beat,), name="heartbeat", daemon=True)
        self.stop_reason: StopReason | None = None

    def reach(self, stage: str, fraction: float) -> None:
        """Take note of progress; it is written with the next beat."""
        self._progress.reach(stage, fraction)

    def note_memory(self, memory_mb: float) -> None:
        """Take note of the engine's memory, in MiB; a new peak goes out with the next heartbeat."""
        self._memory_mb = int(memory_mb)
        self.note_peak(memory_mb)

    def note_peak(self, memory_mb: float) -> None:
        """Take note of the most memory that the engine had at once, in MiB."""
        self.peak_mb = max(self.peak_mb, int(memory_mb))

    def __enter__(self) -> Self:
        """Start beating."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop, and wait for a write that is under way."""
        self._stop_event.set()
        self._thread.join()

    def _beat(self) -> None:
        while not self._stop_event.wait(_TICK_S) and self.stop_reason is None:
            try:
                self._beat_once()
            except StaleAttemptError as error:
                _log.warning("the attempt was taken away: %s", error)
                self.stop_reason = StopReason.LOST
            except (DatabaseUnavailableError, DatabaseError) as error:
                _log.warning("a heartbeat failed: %r", error.__cause__ or error)
                if time.monotonic() - self._renewed_at > self._heartbeat_calls.outage_timeout_s:
                    self.stop_reason = StopReason.LOST

    def _beat_once(self) -> None:
        if time.monotonic() - self._renewed_at >= self._heartbeat_calls.heartbeat_s:
            is_cancel_requested = self._heartbeat_calls.renew(self._memory_mb, self.peak_mb)
            self._renewed_at = time.monotonic()
        else:
            is_cancel_requested = self._heartbeat_calls.is_cancel_requested()
        if is_cancel_requested:
            self.stop_reason = StopReason.CANCELED
            return
        progress = (self._progress.stage, self._progress.percent)
        if progress != self._written_progress:
            self._heartbeat_calls.report(*progress)
            self._written_progress = progress
