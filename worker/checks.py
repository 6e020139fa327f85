"""Checks of uploads, analyses and proofs: an engine opens each once, under a lease, and the check is settled.

Tested in `tests/worker/test_proofs.py`.
"""

import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from jobkit.errors import QueueUnavailableError, StaleAttemptError
from worker.context import Context
from worker.engine.supervision import Observer
from worker.failures import OUTAGE_DELAY_S, Failure, StopReason
from worker.heartbeat import Heartbeat, HeartbeatCalls
from worker.memory import reserve_memory
from worker.outcomes import outcome_of

T = TypeVar("T")

_log = logging.getLogger("quadpatch.worker.checks")


@dataclass(frozen=True)
class Check:
    """A started check, and the ways to settle it; those that write raise StaleAttemptError where it was taken away.

    Attributes
    ----------
    subject : str
        What is checked, for the log.
    is_last : bool
        Whether a failure settles it.
    renew : callable
        Prolongs the lease by so many seconds.
    refuse : callable
        Settles it with the code and the message of a failure.
    release : callable
        Hands it back undone.
    forgive : callable
        Hands it back and does not count it; it is not taken again for so many seconds.
    submit : callable
        Puts it into the queue again; raises QueueUnavailableError.
    needed_mb : int
        Memory that its engine is expected to need, in MiB.
    gives_way : callable
        Tells whether it is to end now, and to be forgiven: something else comes first.
    """

    subject: str
    is_last: bool
    renew: Callable[[float], None]
    refuse: Callable[[str, str], None]
    release: Callable[[], None]
    forgive: Callable[[float], None]
    submit: Callable[[], object]
    needed_mb: int
    gives_way: Callable[[], bool] = lambda: False


def run_check(
    context: Context,
    check: Check,
    work: Callable[[Observer], T],
    accept: Callable[[T], None],
    describe: Callable[[T], str],
) -> None:
    """Do the work of a check and settle it.

    Parameters
    ----------
    context : Context
    check : Check
    work : callable
        Runs the engine under an observer; raises what `worker.outcomes.outcome_of` knows.
    accept : callable
        Writes what the work gave; raises StaleAttemptError.
    describe : callable
        Describes what the work gave, for the log.
    """
    outcome = outcome_of(lambda: _work_with_heartbeat(context, check, work), check.subject)
    try:
        if isinstance(outcome, Failure | StopReason):
            _settle(check, outcome)
            summary = outcome.code if isinstance(outcome, Failure) else outcome.value
        else:
            accept(outcome)
            summary = describe(outcome)
    except StaleAttemptError as error:
        _log.warning("%s may write no more: %s", check.subject, error)
    else:
        _log.info("%s: %s", check.subject, summary)


def _work_with_heartbeat(context: Context, check: Check, work: Callable[[Observer], T]) -> T:
    settings = context.settings
    reserve_memory(context, check.needed_mb)

    def renew(memory_mb: int, _peak_mb: int) -> bool:
        check.renew(settings.lease_s)
        context.admission.renew(settings.lease_s, memory_mb)
        return check.gives_way()

    heartbeat_calls = HeartbeatCalls(
        renew=renew,
        is_cancel_requested=check.gives_way,
        report=lambda stage, percent: None,
        heartbeat_s=settings.heartbeat_s,
    )
    with Heartbeat(heartbeat_calls) as heartbeat:

        def stop_reason() -> StopReason | None:
            return StopReason.DRAINED if context.draining.is_set() else heartbeat.stop_reason

        return work(Observer(heartbeat.reach, stop_reason, heartbeat.note_memory))


def _settle(check: Check, outcome: Failure | StopReason) -> None:
    if outcome is StopReason.LOST:
        raise StaleAttemptError(f"{check.subject} lost its lease")
    if isinstance(outcome, Failure) and outcome.is_outside:
        # The dispatcher puts it into the queue again when the time has come.
        check.forgive(OUTAGE_DELAY_S)
        return
    if isinstance(outcome, Failure) and (not outcome.retryable or check.is_last):
        check.refuse(outcome.code, outcome.message)
        return
    if outcome is StopReason.CANCELED:
        check.forgive(0.0)
        return
    if outcome is StopReason.DRAINED:
        check.forgive(0.0)
    else:
        check.release()
    try:
        check.submit()
    except QueueUnavailableError:
        _log.warning("the queue does not answer; %s is put into it later", check.subject)
