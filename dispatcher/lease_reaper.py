"""Ends jobs whose lease ran out, except leases that could not be renewed during an outage.

While the database is unavailable, no worker can renew its lease, and all leases run out at once. An outage shows
afterwards: no dispatcher has led for longer than a handover takes. Workers then get one more heartbeat interval.
"""

import time
from collections.abc import Callable

from jobkit.requeue import Reconciled


class LeaseReaper:
    """The periodic task that reconciles jobs.

    Parameters
    ----------
    reconcile : callable
        Ends what is overdue and refills the queue, given whether to take leases that ran out.
    found_leaderless_at : callable
        Says when the lead was last found vacant, see `Leadership`.
    heartbeat_s : float
        Seconds between two heartbeats of an attempt.
    """

    def __init__(
        self, reconcile: Callable[[bool], Reconciled], found_leaderless_at: Callable[[], float], heartbeat_s: float
    ) -> None:
        self._reconcile = reconcile
        self._found_leaderless_at = found_leaderless_at
        self._heartbeat_s = heartbeat_s

    def look(self, _is_over: Callable[[], bool]) -> str:
        """Reconcile once; return what was done in words.

        Raises
        ------
        DatabaseUnavailableError, QueueUnavailableError
        """
        counts = self._reconcile(time.monotonic() > self._found_leaderless_at() + self._heartbeat_s)
        return "" if counts == Reconciled(0, 0, 0) else str(counts)
