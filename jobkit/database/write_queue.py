"""The order in which the threads of a process write to SQLite."""

import threading
from collections import deque

from jobkit.errors import DatabaseUnavailableError

# Between threads, and between processes.
BUSY_TIMEOUT_MS = 20_000


class WriteQueue:
    """Lets the threads of a process write to SQLite in the order in which they come.

    SQLite's own wait for its lock is a series of pauses: of several threads that write all the time, one may find the
    lock taken at each look until its time is over.
    """

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._tickets: deque[object] = deque()

    def __len__(self) -> int:
        """Return how many threads write or wait for it."""
        return len(self._tickets)

    def __enter__(self) -> None:
        ticket = object()
        with self._changed:
            self._tickets.append(ticket)
            is_first = False
            try:
                is_first = self._changed.wait_for(lambda: self._tickets[0] is ticket, BUSY_TIMEOUT_MS / 1000)
            finally:
                if not is_first:
                    self._tickets.remove(ticket)
                    self._changed.notify_all()
        if not is_first:
            raise DatabaseUnavailableError("other threads write to the database")

    def __exit__(self, *_: object) -> None:
        with self._changed:
            self._tickets.popleft()
            self._changed.notify_all()
