"""Looks after jobs, and takes no lease for run out that could not be renewed.

While the database is away, no worker can renew its lease, and all of them run out at once. So where no dispatcher has
led for longer than a handover takes, which is what an outage looks like afterwards, workers get one heartbeat to say
that they live.
"""

import time
from collections.abc import Callable

from jobkit.requeue import Reconciled


class LeaseReaper:
    """The periodic task that looks after jobs.

    Parameters
    ----------
    reconcile : callable
        Ends what is overdue and refills the queue, given whether to take leases that ran out.
    found_unled_at : callable
        Says when the lead was last found vacant, see `Leadership`.
    heartbeat_s : float
        Seconds between two heartbeats of an attempt.
    """

    def __init__(
        self, reconcile: Callable[[bool], Reconciled], found_unled_at: Callable[[], float], heartbeat_s: float
    ) -> None:
        self._reconcile = reconcile
        self._found_unled_at = found_unled_at
        self._heartbeat_s = heartbeat_s

    def look(self, _is_over: Callable[[], bool]) -> str:
        """Look once; return words about what was found.

        Raises
        ------
        DatabaseUnavailableError, QueueUnavailableError
        """
        found = self._reconcile(time.monotonic() > self._found_unled_at() + self._heartbeat_s)
        return "" if found == Reconciled(0, 0, 0) else str(found)
