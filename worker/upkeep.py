"""A thread of every worker that makes the queue follow the database, at start and every few seconds."""

import logging
import threading
from typing import Self

from sqlalchemy.exc import SQLAlchemyError

from jobkit.database import Database
from jobkit.errors import QueueUnavailableError
from jobkit.queue import TaskQueue
from jobkit.reconcile import Reconciled, reconcile

_log = logging.getLogger("quadpatch.worker.upkeep")


class Upkeep:
    """Reconciles from entering a `with` block until leaving it.

    Parameters
    ----------
    database : Database
    queue : TaskQueue
        One of its own: a worker that waits for tasks holds its connection for minutes.
    interval_s : float
        Seconds between two looks.
    """

    def __init__(self, database: Database, queue: TaskQueue, interval_s: float) -> None:
        self._database = database
        self._queue = queue
        self._interval_s = interval_s
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="upkeep", daemon=True)

    def __enter__(self) -> Self:
        """Start looking."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop, and wait for a look that is under way."""
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        while True:
            try:
                found = reconcile(self._database, self._queue)
            except QueueUnavailableError as error:
                _log.warning("the queue was not looked after: %s", error)
            except SQLAlchemyError:
                _log.warning("the queue was not looked after", exc_info=True)
            else:
                if found != Reconciled(0, 0, 0):
                    _log.info("looked after the queue: %s", found)
            if self._ended.wait(self._interval_s):
                return
