"""Supervision of one engine child: its progress, its limits, its end on request, and the reason of its end."""

import contextlib
import json
import logging
import os
import selectors
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psutil

from quadpatch_rules.text import printable
from worker.engine.client import ChildEnd, EngineChild, ForkServer, ForkServerLostError
from worker.engine.limits import EngineLimits
from worker.engine.request import LOG_NAME, EngineRequest
from worker.failures import EngineFailedError, EngineStoppedError, Failure, StopReason, crashed, over_memory, over_time

_TICK_S = 0.1
_CHUNK_BYTES = 65536
# A report is some hundred bytes; a longer line is a fault of the child.
_LINE_LIMIT_BYTES = 1 << 20
_LONGEST_STAGE = 64
_MOST_LOG_LINES = 40
_LOG_TAIL_BYTES = 8000
_FULL_MEMORY = 0.9
# The child closes its pipe as it ends; the kernel then frees its memory, which takes a while for gigabytes.
_EXIT_TIMEOUT_S = 30.0

_log = logging.getLogger("quadpatch.worker.engine")


@dataclass(frozen=True)
class Observer:
    """What the supervision calls.

    Attributes
    ----------
    on_progress : callable
        Called with the stage and the done fraction of that stage.
    stop_reason : callable
        Asked ten times a second whether to end the engine, and why.
    on_memory : callable
        Called ten times a second with the engine's resident memory, in MiB.
    on_peak : callable
        Called once, when the engine has ended, with the most resident memory that it had at once, in MiB.
    """

    on_progress: Callable[[str, float], None]
    stop_reason: Callable[[], StopReason | None]
    on_memory: Callable[[float], None] = lambda _: None
    on_peak: Callable[[float], None] = lambda _: None


def run_engine(
    fork_server: ForkServer,
    request: EngineRequest,
    folder: Path,
    observer: Observer,
    clock: Callable[[], float] = time.monotonic,
) -> Failure | None:
    """Run a request to its end; results lie in `folder` afterwards.

    Parameters
    ----------
    fork_server : ForkServer
    request : EngineRequest
    folder : Path
    observer : Observer
    clock : callable
        Gives the seconds by which the limit on time goes.

    Returns
    -------
    Failure or None
        What ended the engine in an optional step, after the result was delivered.

    Raises
    ------
    EngineFailedError
        If there is no result, with the reason.
    EngineStoppedError
        If the observer wanted it to end.
    """
    request.save(folder)
    try:
        child = fork_server.start_child(folder)
    except ForkServerLostError as error:
        _log.error("no engine could be started: %s", error)
        raise EngineFailedError(crashed(None, None)) from error
    watch = _Watch(fork_server, child, request.limits, observer, clock)
    try:
        watch.listen()
    finally:
        end = watch.end()
        observer.on_peak(watch.peak_mb if end is None else end.peak_mb + watch.peak_of_helpers_mb)
    failure = watch.failure
    if failure is None and not watch.is_done:
        failure = _diagnose(None if end is None else end.status, watch, request.limits, folder / LOG_NAME)
    if failure is None:
        return None
    log_engine_tail(folder / LOG_NAME)
    if not watch.is_delivered:
        raise EngineFailedError(failure)
    _log.warning("the engine ended in an optional step: %s: %s", failure.code, failure.message)
    return failure


class _Watch:
    def __init__(
        self,
        fork_server: ForkServer,
        child: EngineChild,
        limits: EngineLimits,
        observer: Observer,
        clock: Callable[[], float],
    ) -> None:
        self._fork_server = fork_server
        self._child = child
        self._limits = limits
        self._observer = observer
        self._clock = clock
        self._deadline = clock() + limits.time_s
        self._buffer = b""
        self.stage: str | None = None
        self.failure: Failure | None = None
        self.is_done = False
        self.is_delivered = False
        self.peak_mb = 0.0
        self.peak_of_helpers_mb = 0.0
        self._helpers: list[int] = []

    def listen(self) -> None:
        """Read reports until the child closes its pipe or has to be ended."""
        with selectors.DefaultSelector() as selector:
            selector.register(self._child.reports, selectors.EVENT_READ)
            while self.failure is None:
                if selector.select(_TICK_S) and not self._read():
                    return
                self._keep_limits()
                reason = self._observer.stop_reason()
                if reason is not None:
                    raise EngineStoppedError(reason)

    def end(self) -> ChildEnd | None:
        """Make sure that the child and all that it started have ended; return how it did, None if unknown."""
        os.close(self._child.reports)
        if not self.is_done:
            self._kill()
        end = self._fork_server.wait_child(self._child, _EXIT_TIMEOUT_S)
        if end is None:
            # Without an answer the fork server has ended or hangs; its children end with it.
            self._kill()
            self._fork_server.close()
        return end

    def _kill(self) -> None:
        # At first the child does not lead a process group yet; later the whole group has to end.
        for kill in (os.killpg, os.kill):
            with contextlib.suppress(ProcessLookupError, PermissionError):
                kill(self._child.pid, signal.SIGKILL)

    def _read(self) -> bool:
        chunk = os.read(self._child.reports, _CHUNK_BYTES)
        self._buffer += chunk
        if len(self._buffer) > _LINE_LIMIT_BYTES:
            self.failure = crashed(None, self.stage)
        while b"\n" in self._buffer and not self.is_done:
            line, _, self._buffer = self._buffer.partition(b"\n")
            self._handle_report(json.loads(line))
        return bool(chunk) and not self.is_done

    def _handle_report(self, report: dict[str, Any]) -> None:
        if "stage" in report:
            self.stage = printable(str(report["stage"]), _LONGEST_STAGE)
            self._observer.on_progress(self.stage, float(report["fraction"]))
        elif "processes" in report:
            self._helpers = [int(pid) for pid in report["processes"]]
        elif "delivered" in report:
            self.is_delivered = True
        elif report["ok"]:
            self.is_done = True
        else:
            self.failure = Failure(**report["failure"])

    def _keep_limits(self) -> None:
        if self._clock() > self._deadline:
            self.failure = over_time(self._limits.time_s, self.stage)
            return
        of_helpers_mb = sum(_own_mb(pid, self._child.pid) for pid in self._helpers)
        self.peak_of_helpers_mb = max(self.peak_of_helpers_mb, of_helpers_mb)
        resident_mb = _resident_mb(self._child.pid) + of_helpers_mb
        self.peak_mb = max(self.peak_mb, resident_mb)
        self._observer.on_memory(resident_mb)
        if resident_mb > self._limits.memory_mb:
            self.failure = over_memory(self._limits.memory_mb, self.stage)


def _resident_mb(pid: int) -> float:
    try:
        return float(psutil.Process(pid).memory_info().rss) / 2**20
    except psutil.Error:
        return 0.0  # it has ended; its pipe is closed then


def _own_mb(pid: int, group: int) -> float:
    """Memory of a process that it shares with no other: what it adds to that of the engine which forked it."""
    try:
        return float(psutil.Process(pid).memory_full_info().uss) / 2**20 if os.getpgid(pid) == group else 0.0
    except (psutil.Error, OSError):
        return 0.0


def _diagnose(status: int | None, watch: _Watch, limits: EngineLimits, log: Path) -> Failure:
    """Return why a child ended without a report."""
    stage = watch.stage
    # Native code that is refused memory throws, and an uncaught throw ends in SIGABRT.
    if b"bad_alloc" in _tail(log):
        return over_memory(limits.memory_mb, stage)
    # The kernel kills a process when memory runs out; one far below its limit was not the reason.
    if status == -signal.SIGKILL and watch.peak_mb > _FULL_MEMORY * limits.memory_mb:
        return over_memory(limits.memory_mb, stage)
    if status == -signal.SIGXCPU:
        return over_time(limits.time_s, stage)
    name = signal.Signals(-status).name if status is not None and status < 0 else None
    return crashed(name, stage)


def log_engine_tail(log: Path) -> None:
    """Copy the end of an engine's log into the log of the worker."""
    text = _tail(log).decode(errors="replace").strip()
    for line in text.splitlines()[-_MOST_LOG_LINES:]:
        _log.warning("the engine's log: %s", line)


def _tail(log: Path) -> bytes:
    if not log.exists():
        return b""
    with log.open("rb") as file:
        file.seek(max(0, log.stat().st_size - _LOG_TAIL_BYTES))
        return file.read()
