"""A small supervisor: starts programs in order, restarts those that end, stops them in reverse order.

It has one thread on purpose. Children are tied to the thread that forks them (`quadpatch_rules.parent_death`), and each
writes straight into its own log file, so nothing is lost when the supervisor itself is killed.
"""

import contextlib
import os
import signal
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from onebox.errors import StartError
from onebox.logs import log_tail, start_anew
from quadpatch_rules.parent_death import parent_death_signal

_TICK_S = 0.1
_FIRST_DELAY_S = 0.5
_LONGEST_DELAY_S = 30.0
# A program that ran this long was healthy: after its next end the shortest delay applies again.
_HEALTHY_AFTER_S = 30.0
_LOG_LIMIT_BYTES = 10_000_000


def always_ready() -> bool:
    """Count a program as started as soon as it is running."""
    return True


@dataclass(frozen=True)
class Program:
    """One program to keep running.

    Attributes
    ----------
    name : str
        Names its log file.
    command : sequence of str
    environment : mapping
        Added to this process's own.
    ready : callable
        Tells whether it does its work already; asked until True before the next program is started.
    stop_timeout_s : float
        Seconds between SIGTERM and SIGKILL.
    is_alongside : bool
        Start and stop it side by side with the program before it.
    withheld : tuple of str
        Beginnings of the names of variables that it does not get: secrets that it has no use for.
    """

    name: str
    command: Sequence[str]
    environment: Mapping[str, str] = field(default_factory=dict)
    ready: Callable[[], bool] = always_ready
    stop_timeout_s: float = 10.0
    is_alongside: bool = False
    withheld: tuple[str, ...] = ()


@dataclass
class _Child:
    program: Program
    process: subprocess.Popen[bytes] | None = None
    started_at: float = 0.0
    delay_s: float = _FIRST_DELAY_S
    restart_at: float | None = None
    log_start: int = 0


class Supervisor:
    """Keeps programs running until `stop` is called or a signal asks for the end.

    Parameters
    ----------
    programs : sequence of Program
        Started in this order, stopped in the reverse one.
    log_folder : Path
        Gets one file per program, `{name}.log`.
    say : callable
        Gets a line for the person at the terminal whenever something happens to a program.
    """

    def __init__(self, programs: Sequence[Program], log_folder: Path, say: Callable[[str], None]) -> None:
        self._children = [_Child(program) for program in programs]
        self._log_folder = log_folder
        self._say = say
        self._is_stopping = False

    def log_path(self, name: str) -> Path:
        """File that the named program writes to."""
        return self._log_folder / f"{name}.log"

    @property
    def is_stopping(self) -> bool:
        """Whether a stop was requested, so that `start` may have returned before all programs were ready."""
        return self._is_stopping

    def request_stop(self, *_: object) -> None:
        """Ask `start` and `watch` to return soon; fit to be a signal handler."""
        self._is_stopping = True

    def start(self, timeout_s: float = 300.0) -> None:
        """Start the programs, each once the one before it is ready; returns early when a stop is requested.

        Those that stand alongside each other come up together.

        Raises
        ------
        StartError
            If a program ends, or is not ready within the time limit. What was started before keeps running:
            call `stop`.
        """
        self._log_folder.mkdir(parents=True, exist_ok=True)
        for group in _groups(self._children):
            for child in group:
                self._launch(child)
            for child in group:
                self._wait_until_ready(child, timeout_s)

    def watch(self) -> None:
        """Restart programs that end, with growing delays, until a stop is requested."""
        while not self._is_stopping:
            for child in self._children:
                self._look_after(child)
            time.sleep(_TICK_S)

    def stop(self) -> None:
        """End every program, the last started first: SIGTERM, a wait, SIGKILL."""
        self._is_stopping = True
        for group in reversed(_groups(self._children)):
            for child in group:
                if child.process is not None and child.process.poll() is None:
                    child.process.send_signal(signal.SIGTERM)
            for child in group:
                self._reap(child)

    def _launch(self, child: _Child) -> None:
        path = self.log_path(child.program.name)
        if path.exists() and path.stat().st_size > _LOG_LIMIT_BYTES:
            start_anew(path)
        with path.open("ab") as log:
            child.log_start = log.tell()
            try:
                child.process = subprocess.Popen(
                    child.program.command,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=subprocess.STDOUT,
                    env=_environment(child.program),
                    preexec_fn=parent_death_signal(os.getpid()),  # noqa: PLW1509 - there is one thread only
                    start_new_session=True,  # Ctrl-C reaches the supervisor alone, which ends them in order
                )
            except OSError as error:
                raise StartError(f"{child.program.name} could not be started: {error}") from error
        child.started_at = time.monotonic()
        child.restart_at = None

    def _wait_until_ready(self, child: _Child, timeout_s: float) -> None:
        name, process = child.program.name, child.process
        deadline = time.monotonic() + timeout_s
        while not self._is_stopping:
            if process is not None and process.poll() is not None:
                raise StartError(f"{name} ended at once ({_ending(process.returncode)}); {self._log_tail(child)}")
            if child.program.ready():
                return
            if time.monotonic() > deadline:
                raise StartError(f"{name} was not ready within {timeout_s:.0f} s; {self._log_tail(child)}")
            time.sleep(_TICK_S / 2)

    def _log_tail(self, child: _Child) -> str:
        return log_tail(self.log_path(child.program.name), child.log_start)

    def _look_after(self, child: _Child) -> None:
        if child.restart_at is not None:
            if time.monotonic() >= child.restart_at:
                self._launch(child)
            return
        if child.process is None:
            return
        if child.process.poll() is None:
            self._bound_log(child)
            return
        if time.monotonic() - child.started_at > _HEALTHY_AFTER_S:
            child.delay_s = _FIRST_DELAY_S
        ending = _ending(child.process.returncode)
        self._say(f"{child.program.name} ended ({ending}); starting it again in {child.delay_s:g} s")
        child.restart_at = time.monotonic() + child.delay_s
        child.delay_s = min(2 * child.delay_s, _LONGEST_DELAY_S)

    def _bound_log(self, child: _Child) -> None:
        path = self.log_path(child.program.name)
        # A full disk, or a log file that was removed, must not end the supervision of the programs.
        with contextlib.suppress(OSError):
            if path.stat().st_size > _LOG_LIMIT_BYTES:
                start_anew(path)
                child.log_start = 0

    def _reap(self, child: _Child) -> None:
        if child.process is None:
            return
        try:
            child.process.wait(child.program.stop_timeout_s)
        except subprocess.TimeoutExpired:
            self._say(f"{child.program.name} did not stop within {child.program.stop_timeout_s:.0f} s and is killed")
            child.process.kill()
            child.process.wait()


def _environment(program: Program) -> dict[str, str]:
    inherited = {name: value for name, value in os.environ.items() if not name.startswith(program.withheld)}
    return {**inherited, **program.environment}


def _groups(children: Sequence[_Child]) -> list[list[_Child]]:
    """Group what starts and stops together."""
    groups: list[list[_Child]] = []
    for child in children:
        if groups and child.program.is_alongside:
            groups[-1].append(child)
        else:
            groups.append([child])
    return groups


def _ending(returncode: int) -> str:
    if returncode < 0:
        return f"signal {signal.Signals(-returncode).name}"
    return f"exit code {returncode}"


def stop(process: subprocess.Popen[bytes], timeout_s: float) -> None:
    """Ask one process to end, and end it when it takes longer than `timeout_s`."""
    process.terminate()
    try:
        process.wait(timeout_s)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
