"""Periodic tasks, each in a thread of its own, done by the dispatcher that leads.

A slow one, such as a webhook that does not answer, holds up no other. An error in a task is logged, and the task
is done again after its interval.
"""

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from jobkit.database.leadership import Leadership
from jobkit.errors import JobkitError

_log = logging.getLogger("quadpatch.dispatcher")


@dataclass(frozen=True)
class PeriodicTask:
    """A task that is repeated at an interval.

    Attributes
    ----------
    name : str
        For the log.
    interval_s : float
        Seconds between two runs.
    work : callable
        Does what is due, in a way that does no harm if another dispatcher does it at the same moment; returns words
        about it for the log, empty where nothing was due. Given a callable that says whether to break off.
    """

    name: str
    interval_s: float
    work: Callable[[Callable[[], bool]], str]


class Dispatch:
    """Leads or stands by, until it is told to stop.

    Parameters
    ----------
    leadership : Leadership
    renew_s : float
        Seconds between two renewals of the lead.
    tasks : sequence of PeriodicTask
    """

    def __init__(self, leadership: Leadership, renew_s: float, tasks: Sequence[PeriodicTask]) -> None:
        self._leadership = leadership
        self._renew_s = renew_s
        self._tasks = tasks
        self._leads = threading.Event()
        self._stopped = threading.Event()

    def stop(self) -> None:
        """Ask `run` to return soon."""
        self._stopped.set()

    def run(self) -> None:
        """Work until stopped, then let another dispatcher lead."""
        threads = [threading.Thread(target=self._keep_doing, args=(task,), name=task.name) for task in self._tasks]
        for thread in threads:
            thread.start()
        try:
            self._keep_leading()
        finally:
            self._stopped.set()
            for thread in threads:
                thread.join()
            self._resign()

    def _keep_leading(self) -> None:
        while not self._stopped.is_set():
            try:
                leads = self._leadership.lead()
            except JobkitError as error:
                # The others can't reach the database either, or will lead once the lease has run out.
                _log.warning("the lead could not be taken or renewed: %s", error)
                leads = False
            if leads != self._leads.is_set():
                _log.info("leads now" if leads else "stands by")
            (self._leads.set if leads else self._leads.clear)()
            self._stopped.wait(self._renew_s)

    def _keep_doing(self, task: PeriodicTask) -> None:
        while not self._stopped.is_set():
            # Returns at once when this dispatcher leads, and often enough to notice a stop.
            if self._leads.wait(timeout=min(task.interval_s, 1.0)):
                _do(task, self._is_over)
                self._stopped.wait(task.interval_s)

    def _is_over(self) -> bool:
        return self._stopped.is_set() or not self._leads.is_set()

    def _resign(self) -> None:
        try:
            self._leadership.resign()
        except JobkitError as error:
            _log.warning("the lead was not handed on: %s", error)


def _do(task: PeriodicTask, is_over: Callable[[], bool]) -> None:
    try:
        words = task.work(is_over)
    except JobkitError as error:
        _log.warning("%s: %s", task.name, error)
    except Exception:  # noqa: BLE001 - the outermost handler of a task; its thread must go on
        _log.exception("%s failed", task.name)
    else:
        if words:
            _log.info("%s: %s", task.name, words)
