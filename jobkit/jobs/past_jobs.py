"""What past jobs took, as a basis for what a job like them will take.

A past job is similar if its task is the same, its model of the same kind, chosen with the same effort, and its mesh of
about the same size. A kind or size with too few past jobs is no basis.

Tested in `tests/jobkit/jobs/test_estimates.py`.
"""

import statistics
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from sqlalchemy import Select, func, literal, select
from sqlalchemy.orm import Session

from jobkit.database.tables import JobRow, MeshRow
from quadpatch_client.schema import JobState

_SUCCEEDED = [state.value for state in JobState if state.has_result]
# Fewer past jobs are no basis; older ones may have run on another machine or version.
MIN_PAST = 3
_MAX_PAST = 500


class Sample(NamedTuple):
    """What a job of a kind on a mesh of so many bytes took: seconds, or MiB."""

    kind: str
    size_bytes: int
    amount: float


@dataclass(frozen=True)
class PastJob:
    """What a job took that succeeded; `kind` is its task with the kind of its model and the effort.

    Attributes
    ----------
    kind : str
    size_bytes : int
        Of its mesh.
    seconds : float
        From its start to its end.
    peak_memory_mb : int or None
        The most memory of its engine, in MiB; None of jobs by versions that did not note it.
    """

    kind: str
    size_bytes: int
    seconds: float
    peak_memory_mb: int | None = None

    @property
    def seconds_by_size(self) -> Sample:
        """The job as a basis of estimates of time."""
        return Sample(self.kind, self.size_bytes, self.seconds)


class Rates:
    """Amounts for each byte of past jobs, by kind and size class.

    Parameters
    ----------
    past : iterable of Sample
    typical : callable
        Takes the amounts for each byte of similar jobs, and returns the one to expect.
    """

    def __init__(self, past: Iterable[Sample], typical: Callable[[Sequence[float]], float] = statistics.median) -> None:
        self._typical = typical
        self._by_class: dict[tuple[str, int], list[float]] = defaultdict(list)
        for kind, size_bytes, amount in past:
            if size_bytes:
                self._by_class[kind, size_bytes.bit_length()].append(amount / size_bytes)
        self._rates: dict[tuple[str, int], float | None] = {}

    def amount(self, kind: str, size_bytes: int) -> float | None:
        """Return the expected amount of a job; None where too few are similar."""
        size_class = size_bytes.bit_length()
        if (kind, size_class) not in self._rates:
            # Sizes of a class differ by two at most, with its neighbours by four.
            similar_rates = [
                r for c in (size_class - 1, size_class, size_class + 1) for r in self._by_class.get((kind, c), ())
            ]
            self._rates[kind, size_class] = self._typical(similar_rates) if len(similar_rates) >= MIN_PAST else None
        rate = self._rates[kind, size_class]
        return None if rate is None else rate * size_bytes


def read_past(session: Session) -> list[PastJob]:
    """Return the jobs that succeeded last, the latest first."""
    peak_memory_mb = JobRow.result["peak_memory_mb"].as_integer().label("peak_memory_mb")
    rows = session.execute(
        kinds_and_sizes(JobRow.started_at, JobRow.finished_at, peak_memory_mb)
        .where(JobRow.state.in_(_SUCCEEDED), JobRow.finished_at.is_not(None), JobRow.started_at.is_not(None))
        .where(JobRow.cached_from.is_(None))
        .order_by(JobRow.finished_at.desc())
        .limit(_MAX_PAST)
    )
    return [
        PastJob(row.kind, row.size_bytes, (row.finished_at - row.started_at).total_seconds(), row.peak_memory_mb)
        for row in rows
    ]


def kind_of(task: str, model_kind: str, effort: str | None = None) -> str:
    """Name the kind of a job, as `kinds_and_sizes` does; `auto` alone has an effort."""
    return " ".join(filter(None, (task, model_kind, effort)))


def kinds_and_sizes(*columns: Any) -> Select[*tuple[Any, ...]]:
    """Return a query for jobs: their id, kind, the bytes of their mesh (`size_bytes`), and more columns."""
    # Efforts differ tenfold.
    effort = func.coalesce(literal(" ").concat(JobRow.spec["method"]["effort"].as_string()), "")
    kind = JobRow.task.concat(" ").concat(JobRow.model["kind"].as_string()).concat(effort).label("kind")
    return select(JobRow.id, kind, MeshRow.size_bytes, *columns).join(MeshRow, MeshRow.id == JobRow.mesh_id)
