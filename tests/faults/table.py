"""The outcome of a campaign as a table for people."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence

from tests.faults.campaign import Outcome

RECOVERY_LIMIT_S = 30.0
CANCEL_LIMIT_S = 3.0
# A worker that is killed, or cut off, says nothing: its lease has to run out.
LOSSES = ("worker killed", "worker frozen", "worker cut off")


def percentile(values: Iterable[float], share: float) -> float:
    """Return the smallest value that at least `share` of the values don't exceed; 0 where there are none."""
    row = sorted(values)
    return row[math.ceil(share * len(row)) - 1] if row else 0.0


def killed_recoveries_s(outcome: Outcome) -> list[float]:
    """Return all recoveries after a worker fell silent."""
    return [second for fault in LOSSES for second in outcome.recoveries_s.get(fault, [])]


def all_cancels_s(outcome: Outcome) -> list[float]:
    """Return all cancels of whatever kind."""
    return [second for kind in outcome.cancels_s.values() for second in kind]


def to_text(outcome: Outcome) -> str:
    """Write the table."""
    account = outcome.account
    states = ", ".join(f"{count} {state}" for state, count in sorted(account.states.items()))
    lines = [
        f"network: {outcome.network}; {outcome.seconds:.0f} s",
        "",
        f"accepted jobs                  {account.n_accepted:5d}   {states}",
        f"lost                           {len(account.lost):5d}",
        f"with two published results     {len(account.twice):5d}",
        f"stuck                          {len(account.stuck):5d}",
        f"made twice by a repetition     {len(account.unasked):5d}",
        f"broken event logs              {len(account.broken_logs):5d}",
        f"published files broken         {len(account.broken_files):5d}",
        f"attempts never closed          {len(account.open_attempts):5d}",
        f"engines, folders left          {len(account.left_processes):5d} {len(account.left_folders)}",
        f"unpublished files to sweep     {account.unpublished:5d}",
        "",
        _times("recovery after a silent worker", killed_recoveries_s(outcome), RECOVERY_LIMIT_S),
        *(_times(f"  after: {fault}", values) for fault, values in sorted(outcome.recoveries_s.items())),
        _times("cancel", all_cancels_s(outcome), CANCEL_LIMIT_S),
        *(_times(f"  of: {kind} job", values) for kind, values in sorted(outcome.cancels_s.items())),
        _counts("  running jobs were canceled in", Counter(_stages(outcome))),
        "",
        *_strikes(outcome),
        "",
        _counts("attempts ended", account.attempts),
        _counts("answers to clients", outcome.book.answers),
        _counts("logged", Counter(outcome.logged)),
        *(f"BROKEN {name}: {jobs}" for name, jobs in account.violations.items() if jobs),
    ]
    return "\n".join(lines)


def _stages(outcome: Outcome) -> list[str]:
    return [cancel.stage or "no stage yet" for cancel in outcome.book.cancels if cancel.kind == "running"]


def _strikes(outcome: Outcome) -> list[str]:
    counts = Counter(strike.fault for strike in outcome.record.strikes)
    last = {strike.fault: strike.evidence for strike in outcome.record.strikes}
    rows = [f"{fault:<28} {count:5d}   {last[fault]}" for fault, count in sorted(counts.items())]
    missed = Counter(outcome.record.missed)
    return ["fault                        struck   evidence (the last one)", *rows, _counts("found no victim", missed)]


def _times(title: str, values: Sequence[float], limit_s: float | None = None) -> str:
    limit = f"   (limit of p95: {limit_s:g} s)" if limit_s is not None else ""
    middle, high, most = (percentile(values, share) for share in (0.5, 0.95, 1.0))
    return f"{title:<34} n {len(values):3d}   median {middle:5.1f} s   p95 {high:5.1f} s   most {most:5.1f} s{limit}"


def _counts(title: str, counts: Counter[str]) -> str:
    return f"{title}: " + (", ".join(f"{count} x {what}" for what, count in counts.most_common()) or "none")
