"""Whether the service kept its guarantees during a campaign."""

from tests.faults.campaign import Outcome
from tests.faults.table import CANCEL_LIMIT_S, RECOVERY_LIMIT_S, all_cancels_s, percentile, silent_worker_recoveries_s


def all_violations(outcome: Outcome) -> list[str]:
    """Return a line for each violation, those of time limits included; empty where there is none."""
    violations = consistency_violations(outcome)
    recovery, cancel = percentile(silent_worker_recoveries_s(outcome), 0.95), percentile(all_cancels_s(outcome), 0.95)
    if recovery > RECOVERY_LIMIT_S:
        violations.append(f"95 of 100 interrupted jobs run again after {recovery:.1f} s, not {RECOVERY_LIMIT_S:g} s")
    if cancel > CANCEL_LIMIT_S:
        violations.append(f"95 of 100 cancels take {cancel:.1f} s, not {CANCEL_LIMIT_S:g} s")
    return violations


def consistency_violations(outcome: Outcome) -> list[str]:
    """Return a line for each violation that does not depend on time: lost, stuck, failed and repeated jobs, orphans."""
    violations = [f"{name}: {jobs}" for name, jobs in outcome.consistency.violations.items() if jobs]
    if outcome.consistency.states.get("failed"):
        violations.append(f"{outcome.consistency.states['failed']} jobs failed, none of which has a fault of its own")
    return violations
