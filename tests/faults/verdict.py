"""Whether a campaign kept every promise."""

from tests.faults.campaign import Outcome
from tests.faults.table import CANCEL_LIMIT_S, RECOVERY_LIMIT_S, all_cancels_s, killed_recoveries_s, percentile


def faults_found(outcome: Outcome) -> list[str]:
    """Return in words what was not kept; empty where all is well."""
    found = broken_promises(outcome)
    recovery, cancel = percentile(killed_recoveries_s(outcome), 0.95), percentile(all_cancels_s(outcome), 0.95)
    if recovery > RECOVERY_LIMIT_S:
        found.append(f"95 of 100 struck jobs run again after {recovery:.1f} s, not {RECOVERY_LIMIT_S:g} s")
    if cancel > CANCEL_LIMIT_S:
        found.append(f"95 of 100 cancels take {cancel:.1f} s, not {CANCEL_LIMIT_S:g} s")
    return found


def broken_promises(outcome: Outcome) -> list[str]:
    """Return what no clock has a say in: jobs that were lost, stuck, failed or published twice, and leftovers."""
    found = [f"{name}: {jobs}" for name, jobs in outcome.account.violations.items() if jobs]
    if outcome.account.states.get("failed"):
        found.append(f"{outcome.account.states['failed']} jobs failed, none of which has a fault of its own")
    return found
