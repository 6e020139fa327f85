import time

from dispatcher.lease_reaper import LeaseReaper
from jobkit.requeue import Reconciled

HEARTBEAT_S = 3600.0


def test_workers_get_a_heartbeat_after_a_time_without_a_leader_and_none_otherwise() -> None:
    took_leases: list[bool] = []

    def reconcile(takes_leases: bool) -> Reconciled:
        took_leases.append(takes_leases)
        return Reconciled(0, 0, 0)

    found_at = float("-inf")
    reaper = LeaseReaper(reconcile, lambda: found_at, heartbeat_s=HEARTBEAT_S)
    reaper.look(lambda: False)
    found_at = time.monotonic()
    reaper.look(lambda: False)
    found_at -= HEARTBEAT_S
    reaper.look(lambda: False)
    assert took_leases == [True, False, True]


def test_what_was_found_is_told_in_words_and_nothing_in_none() -> None:
    found = [Reconciled(0, 0, 0), Reconciled(2, 1, 0)]
    reaper = LeaseReaper(lambda _: found.pop(0), time.monotonic, heartbeat_s=1.0)
    assert reaper.look(lambda: False) == ""
    assert "ended=2" in reaper.look(lambda: False)
