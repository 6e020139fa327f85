import threading

import pytest

from jobkit.errors import DatabaseError, DatabaseUnavailableError, StaleAttemptError
from tests.waiting import GUARD_S, wait_until
from worker.failures import StopReason
from worker.heartbeat import Heartbeat, HeartbeatCalls


class FakeAttempt:
    """Stands in for the database; counts what is asked of it, and may fall ill."""

    def __init__(self, renewal: Exception | None = None, is_cancel_requested: bool = False) -> None:
        self.renewal = renewal
        self.cancel = is_cancel_requested
        self.renewals = 0
        self.memory_mb = (0, 0)
        self.reports: list[tuple[str, float]] = []
        self.has_beaten = threading.Event()

    def renew(self, memory_mb: int, peak_mb: int) -> bool:
        self.renewals += 1
        self.memory_mb = (memory_mb, peak_mb)
        if self.renewals >= 2:
            self.has_beaten.set()
        if self.renewal is not None:
            raise self.renewal
        return self.cancel

    def heartbeat_calls(self, outage_timeout_s: float = 30.0, heartbeat_s: float = 0.0) -> HeartbeatCalls:
        return HeartbeatCalls(
            self.renew, lambda: self.cancel, lambda *report: self.reports.append(report), heartbeat_s, outage_timeout_s
        )


def test_the_lease_is_renewed_and_progress_written_once() -> None:
    attempt = FakeAttempt()
    with Heartbeat(attempt.heartbeat_calls()) as heartbeat:
        heartbeat.reach("fill", 1.0)
        assert attempt.has_beaten.wait(GUARD_S)
        assert heartbeat.stop_reason is None
    assert attempt.reports == [("fill", 44.0)]


def test_the_present_and_the_most_memory_go_out_with_the_heartbeat() -> None:
    attempt = FakeAttempt()
    with Heartbeat(attempt.heartbeat_calls()) as heartbeat:
        for memory_mb in (100.0, 250.5, 80.0):
            heartbeat.note_memory(memory_mb)
        assert attempt.has_beaten.wait(GUARD_S)
        heartbeat.note_peak(300.0)
    assert attempt.memory_mb == (80, 250)
    assert heartbeat.peak_mb == 300


@pytest.mark.parametrize("heartbeat_s", [0.0, 3600.0])
def test_a_cancel_flag_comes_with_a_renewal_and_between_two(heartbeat_s: float) -> None:
    with Heartbeat(FakeAttempt(is_cancel_requested=True).heartbeat_calls(heartbeat_s=heartbeat_s)) as heartbeat:
        assert wait_until(lambda: heartbeat.stop_reason) is StopReason.CANCELED


def test_an_attempt_that_was_taken_away_is_lost() -> None:
    with Heartbeat(FakeAttempt(renewal=StaleAttemptError("taken")).heartbeat_calls()) as heartbeat:
        assert wait_until(lambda: heartbeat.stop_reason) is StopReason.LOST


@pytest.mark.parametrize(("outage_timeout_s", "reason"), [(0.0, StopReason.LOST), (3600.0, None)])
@pytest.mark.parametrize("error", [DatabaseUnavailableError("away"), DatabaseError("the database refuses a statement")])
def test_an_unavailable_database_is_waited_for_up_to_the_timeout(
    error: Exception, outage_timeout_s: float, reason: StopReason | None
) -> None:
    attempt = FakeAttempt(renewal=error)
    with Heartbeat(attempt.heartbeat_calls(outage_timeout_s)) as heartbeat:
        if reason is None:
            assert attempt.has_beaten.wait(GUARD_S)
            assert heartbeat.stop_reason is None
        else:
            assert wait_until(lambda: heartbeat.stop_reason) is reason
