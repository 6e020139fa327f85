"""What the runs of a candidate say of it, all together.

Jobs count alike, however many holes they have: holes of one scan are filled by what one calibration found out, so they
are no independent measurements.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from quadpatch_client.schema import ShadowFigures
from quadpatch_rules.training_verdict import SAME

# Fewer jobs say nothing, and a gain has to be so many standard errors wide.
LEAST_JOBS = 10
SURE = 2.0


@dataclass(frozen=True)
class Measured:
    """One job: how many holes were compared, and the error of the candidate over that of the result."""

    holes: int
    ratio: float


def figures_of(baseline: str | None, measured: Sequence[Measured]) -> ShadowFigures:
    """Sum measured jobs up; `baseline` made their results."""
    logs = [math.log(job.ratio) for job in measured]
    n, better = len(logs), sum(job.ratio < 1 - SAME for job in measured)
    worse = sum(job.ratio > 1 + SAME for job in measured)
    mean = sum(logs) / n if n else 0.0
    spread = math.sqrt(sum((log - mean) ** 2 for log in logs) / (n * (n - 1))) if n > 1 else None
    verdict, may_be_default = _judge(n, (better, worse), mean, spread)
    return ShadowFigures(
        baseline=baseline,
        jobs=n,
        better=better,
        worse=worse,
        holes=sum(job.holes for job in measured),
        ratio=round(math.exp(mean), 5) if n else None,
        # Of the ratio itself: it is the mean of logarithms that has a standard error.
        standard_error=None if spread is None else round(math.exp(mean) * spread, 5),
        verdict=verdict,
        may_be_default=may_be_default,
    )


def _judge(n: int, counts: tuple[int, int], mean: float, spread: float | None) -> tuple[str, bool]:
    better, worse = counts
    noun = "job" if n == 1 else "jobs"
    if not n:
        return "nothing is measured yet", False
    if n < LEAST_JOBS or spread is None:
        return f"better on {better} of {n} {noun}: too few to judge by, {LEAST_JOBS} are needed", False
    if mean < math.log(1 - SAME) and mean < -SURE * spread and better > worse:
        return f"better on {better} of {n} {noun}: may be made default", True
    if mean > math.log(1 + SAME) and mean > SURE * spread:
        return f"worse on {worse} of {n} {noun}: not to be made default", False
    return f"better on {better} and worse on {worse} of {n} {noun}: no sure gain, not to be made default", False
