"""Ctrl-C while a job is being made: held back until it is known which one has to be canceled."""

import signal
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any, Self


class HeldInterrupt:
    """Holds the first Ctrl-C back until `release`, or the end of a `with` block; a second one interrupts at once.

    Parameters
    ----------
    say : callable
        Gets a line for the person at the terminal.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say = say
        self._has_come = False
        self._usual: Any = None

    def __enter__(self) -> Self:
        # In other threads and in the background it would not interrupt anyway.
        is_main = threading.current_thread() is threading.main_thread()
        if is_main and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            self._usual = signal.signal(signal.SIGINT, self._keep)
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def release(self) -> None:
        """Let Ctrl-C interrupt again.

        Raises
        ------
        KeyboardInterrupt
            If it came meanwhile.
        """
        if self._usual is not None:
            signal.signal(signal.SIGINT, self._usual)
            self._usual = None
        if self._has_come:
            self._has_come = False
            raise KeyboardInterrupt

    def _keep(self, number: int, frame: FrameType | None) -> None:
        if self._has_come:
            raise KeyboardInterrupt
        self._has_come = True
        self._say("interrupted: the job is canceled as soon as the service has answered; Ctrl-C again leaves it")
