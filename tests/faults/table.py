"""The outcome of a campaign as a table for people."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence

from tests.faults.campaign import Outcome

RECOVERY_LIMIT_S = 30.0
CANCEL_LIMIT_S = 3.0
# A worker that is killed or cut off reports nothing: its lease has to run out.
SILENT_WORKER_FAULTS = ("worker killed", "worker frozen", "worker cut off")


def percentile(values: Iterable[float], share: float) -> float:
    """Return the smallest value that at least `share` of the values don't exceed; 0 where there are none."""
    row = sorted(values)
    return row[math.ceil(share * len(row)) - 1] if row else 0.0


def silent_worker_recoveries_s(outcome: Outcome) -> list[float]:
    """Return all recoveries after a worker stopped renewing its lease."""
    return [second for fault in SILENT_WORKER_FAULTS for second in outcome.recoveries_s.get(fault, [])]


def all_cancels_s(outcome: Outcome) -> list[float]:
    """Return all cancels of any kind."""
    return [second for kind in outcome.cancels_s.values() for second in kind]


def to_text(outcome: Outcome) -> str:
    """Write the table."""
    consistency = outcome.consistency
    states = ", ".join(f"{count} {state}" for state, count in sorted(consistency.states.items()))
    lines = [
        f"network: {outcome.network}; {outcome.seconds:.0f} s",
        "",
        f"accepted jobs                  {consistency.n_accepted:5d}   {states}",
        f"lost                           {len(consistency.lost_jobs):5d}",
        f"with two published results     {len(consistency.wrong_result_counts):5d}",
        f"stuck                          {len(consistency.stuck_jobs):5d}",
        f"made twice by a repetition     {len(consistency.duplicate_jobs):5d}",
        f"broken event logs              {len(consistency.event_gaps):5d}",
        f"published files broken         {len(consistency.broken_files):5d}",
        f"attempts never closed          {len(consistency.open_attempts):5d}",
        f"engines, folders left          {len(consistency.orphan_processes):5d} {len(consistency.orphan_folders)}",
        f"unpublished files to sweep     {consistency.n_unpublished_files:5d}",
        "",
        _times("recovery after a silent worker", silent_worker_recoveries_s(outcome), RECOVERY_LIMIT_S),
        *(_times(f"  after: {fault}", values) for fault, values in sorted(outcome.recoveries_s.items())),
        _times("cancel", all_cancels_s(outcome), CANCEL_LIMIT_S),
        *(_times(f"  of: {kind} job", values) for kind, values in sorted(outcome.cancels_s.items())),
        _counts("  running jobs were canceled in", Counter(_stages(outcome))),
        "",
        *_injection_rows(outcome),
        "",
        _counts("attempts ended", consistency.attempts),
        _counts("answers to clients", outcome.expected.answers),
        _counts("logged", Counter(outcome.phrase_counts)),
        *(f"BROKEN {name}: {jobs}" for name, jobs in consistency.violations.items() if jobs),
    ]
    return "\n".join(lines)


def _stages(outcome: Outcome) -> list[str]:
    return [cancel.stage or "no stage yet" for cancel in outcome.expected.cancels if cancel.kind == "running"]


def _injection_rows(outcome: Outcome) -> list[str]:
    counts = Counter(injection.fault for injection in outcome.injection_log.injections)
    last = {injection.fault: injection.evidence for injection in outcome.injection_log.injections}
    rows = [f"{fault:<28} {count:5d}   {last[fault]}" for fault, count in sorted(counts.items())]
    skipped = Counter(outcome.injection_log.skipped)
    return ["fault                      injected   evidence (the last one)", *rows, _counts("found no target", skipped)]


def _times(title: str, values: Sequence[float], limit_s: float | None = None) -> str:
    limit = f"   (limit of p95: {limit_s:g} s)" if limit_s is not None else ""
    middle, high, most = (percentile(values, share) for share in (0.5, 0.95, 1.0))
    return f"{title:<34} n {len(values):3d}   median {middle:5.1f} s   p95 {high:5.1f} s   most {most:5.1f} s{limit}"


def _counts(title: str, counts: Counter[str]) -> str:
    return f"{title}: " + (", ".join(f"{count} x {what}" for what, count in counts.most_common()) or "none")
