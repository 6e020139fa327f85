"""Looks after jobs, and takes no lease for run out that nobody could renew.

While the database is away, no worker can renew its lease, and all of them run out at once. So after a time without a
look, which is an outage, a dispatcher that has just started or begun to lead, or a machine that slept, workers get one
heartbeat to say that they live.
"""

import time
from collections.abc import Callable

from jobkit.errors import QueueUnavailableError
from jobkit.reconcile import Reconciled


class Keeper:
    """The duty that looks after jobs.

    Parameters
    ----------
    reconcile : callable
        Ends what is overdue and refills the queue, given whether to take leases that ran out.
    heartbeat_s : float
        Seconds between two heartbeats of an attempt.
    """

    def __init__(self, reconcile: Callable[[bool], Reconciled], heartbeat_s: float) -> None:
        self._reconcile = reconcile
        self._heartbeat_s = heartbeat_s
        self._looked_at = float("-inf")
        self._takes_leases_at = float("-inf")

    def look(self, _is_over: Callable[[], bool]) -> str:
        """Look once; return words about what was found.

        Raises
        ------
        DatabaseUnavailableError, QueueUnavailableError
        """
        now = time.monotonic()
        if now - self._looked_at > self._heartbeat_s:
            self._takes_leases_at = now + self._heartbeat_s
        try:
            found = self._reconcile(now >= self._takes_leases_at)
        except QueueUnavailableError:
            self._looked_at = time.monotonic()  # the database was there
            raise
        self._looked_at = time.monotonic()
        return "" if found == Reconciled(0, 0, 0) else str(found)
