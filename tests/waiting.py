"""Waiting for events: the one place where tests look at the clock.

A test never says how long something may take, since the machine may do other work: it waits for the event. `GUARD_S`
only keeps a test from waiting for ever, and is far longer than anything takes on a busy machine.
"""

import time
from collections.abc import Callable
from pathlib import Path
from subprocess import Popen
from typing import TypeVar

import httpx

T = TypeVar("T")

GUARD_S = 300.0
_PAUSE_S = 0.05


def wait_until(
    condition: Callable[[], T | None], process: "Popen[bytes] | Popen[str] | None" = None, log: Path | None = None
) -> T:
    """Ask until the answer is true in the sense of `if`, and return it.

    Parameters
    ----------
    condition : callable
    process : subprocess.Popen, optional
        What brings the event about; its end is a failure at once.
    log : Path, optional
        What the process writes; part of the failure's message.

    Raises
    ------
    AssertionError
        If the process has ended, or after `GUARD_S` seconds.
    """
    started = time.monotonic()
    while not (answer := condition()):
        assert process is None or process.poll() is None, f"ended with {process.returncode}; {_text(log)}"
        assert time.monotonic() - started < GUARD_S, f"nothing for {GUARD_S:.0f} s; {_text(log)}"
        time.sleep(_PAUSE_S)
    return answer


def wait_until_answered(url: str, process: "Popen[bytes]", log: Path) -> None:
    """Wait until a server answers a GET at all.

    Parameters
    ----------
    url : str
    process : subprocess.Popen
        The server.
    log : Path
        What it writes.
    """

    # One client for all looks, and without certificates: to load them takes as long as a service needs to start.
    with httpx.Client(timeout=GUARD_S, trust_env=False, verify=False) as client:

        def answers() -> bool:
            try:
                client.get(url)
            except httpx.TransportError:
                return False
            return True

        wait_until(answers, process, log)


def end(process: "Popen[bytes]") -> None:
    """Ask a process to end, and wait for that; one that never does is killed, and fails the test.

    Parameters
    ----------
    process : subprocess.Popen
    """
    process.terminate()
    try:
        process.wait(GUARD_S)
    finally:
        process.kill()
        process.wait()


def let_others_run() -> None:
    """Give other threads some time to come to a place where they have to wait.

    What a test asserts holds also for those that come too late: it is then the weaker, not the false one.
    """
    time.sleep(0.3)


def _text(log: Path | None) -> str:
    return "" if log is None or not log.exists() else log.read_text(errors="replace")[-8000:]
