"""The heartbeat of one attempt: a thread that keeps the lease, writes progress and brings the cancel flag back.

It alone talks to the database while the engine works, so a slow disk never holds up the watch over the engine.
"""

import logging
import threading
import time
from collections.abc import Callable
from contextvars import copy_context
from dataclasses import dataclass
from typing import Self

from sqlalchemy.exc import SQLAlchemyError

from jobkit.errors import DatabaseUnavailableError, StaleAttemptError
from worker.failures import StopReason
from worker.progress import Progress

# How soon a cancel is noticed, and how often progress is written at most.
_TICK_S = 0.5
# Longer than a database takes to be restarted or to fail over.
PATIENCE_S = 120.0

_log = logging.getLogger("quadpatch.worker.heartbeat")


@dataclass(frozen=True)
class HeartbeatCalls:
    """How an attempt shows that it is alive.

    Attributes
    ----------
    renew : callable
        Renews the lease, given the most memory that was seen, in MiB; raises StaleAttemptError.
    is_canceled : callable
        Reads whether a client asked for the end.
    report : callable
        Writes stage and percent; raises StaleAttemptError.
    heartbeat_s : float
        Seconds between two renewals.
    patience_s : float
        Seconds for which a database that is away is waited for: while it is, no other worker can start the job either.
    """

    renew: Callable[[int], object]
    is_canceled: Callable[[], bool]
    report: Callable[[str, float], None]
    heartbeat_s: float
    patience_s: float = PATIENCE_S


class Heartbeat:
    """Beats from entering a `with` block until leaving it."""

    def __init__(self, heartbeat_calls: HeartbeatCalls) -> None:
        self._heartbeat_calls = heartbeat_calls
        self._progress = Progress()
        self._written = ("", 0.0)
        self._peak_mb = 0
        self._ended = threading.Event()
        self._renewed_at = time.monotonic()
        self._thread = threading.Thread(target=copy_context().run, args=(self._beat,), name="heartbeat", daemon=True)
        self.stop_reason: StopReason | None = None

    def reach(self, stage: str, fraction: float) -> None:
        """Take note of progress; it is written with the next beat."""
        self._progress.reach(stage, fraction)

    def note_memory(self, memory_mb: float) -> None:
        """Take note of the engine's memory, in MiB; a new peak goes out with the next heartbeat."""
        self._peak_mb = max(self._peak_mb, int(memory_mb))

    def __enter__(self) -> Self:
        """Start beating."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop, and wait for a write that is under way."""
        self._ended.set()
        self._thread.join()

    def _beat(self) -> None:
        while not self._ended.wait(_TICK_S) and self.stop_reason is None:
            try:
                self._keep_alive()
            except StaleAttemptError as error:
                _log.warning("the attempt was taken away: %s", error)
                self.stop_reason = StopReason.LOST
            except (DatabaseUnavailableError, SQLAlchemyError) as error:
                _log.warning("a heartbeat failed: %s", error)
                if time.monotonic() - self._renewed_at > self._heartbeat_calls.patience_s:
                    self.stop_reason = StopReason.LOST

    def _keep_alive(self) -> None:
        if time.monotonic() - self._renewed_at >= self._heartbeat_calls.heartbeat_s:
            self._heartbeat_calls.renew(self._peak_mb)
            self._renewed_at = time.monotonic()
        if self._heartbeat_calls.is_canceled():
            self.stop_reason = StopReason.CANCELED
            return
        reached = (self._progress.stage, self._progress.percent)
        if reached != self._written:
            self._heartbeat_calls.report(*reached)
            self._written = reached
