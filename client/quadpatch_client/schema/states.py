r"""The life of a job, of a mesh and of a model version, written once.

::

    queued -> running -> succeeded | succeeded_with_warnings | failed
       \         \-> queued (attempt lost or drained, attempts left)
        \-> canceling -> canceled      (a queued job is canceled at once, and one that takes over a result succeeds)
"""

from enum import StrEnum
from types import MappingProxyType


class JobState(StrEnum):
    """Where a job stands."""

    QUEUED = "queued"
    RUNNING = "running"
    CANCELING = "canceling"
    CANCELED = "canceled"
    SUCCEEDED = "succeeded"
    SUCCEEDED_WITH_WARNINGS = "succeeded_with_warnings"
    FAILED = "failed"

    @property
    def is_terminal(self) -> bool:
        """Whether the job has ended."""
        return not TRANSITIONS[self]

    @property
    def has_result(self) -> bool:
        """Whether the job ended with a repaired mesh."""
        return self in (JobState.SUCCEEDED, JobState.SUCCEEDED_WITH_WARNINGS)


TRANSITIONS = MappingProxyType(
    {
        JobState.QUEUED: frozenset(
            {
                JobState.RUNNING,
                JobState.SUCCEEDED,
                JobState.SUCCEEDED_WITH_WARNINGS,
                JobState.CANCELED,
                JobState.FAILED,
            }
        ),
        JobState.RUNNING: frozenset(
            {
                JobState.SUCCEEDED,
                JobState.SUCCEEDED_WITH_WARNINGS,
                JobState.FAILED,
                JobState.QUEUED,
                JobState.CANCELING,
            }
        ),
        JobState.CANCELING: frozenset({JobState.CANCELED}),
        JobState.CANCELED: frozenset[JobState](),
        JobState.SUCCEEDED: frozenset[JobState](),
        JobState.SUCCEEDED_WITH_WARNINGS: frozenset[JobState](),
        JobState.FAILED: frozenset[JobState](),
    }
)


class MeshState(StrEnum):
    """Where the analysis of an uploaded mesh stands."""

    ANALYSING = "analysing"
    READY = "ready"
    REJECTED = "rejected"


class ModelState(StrEnum):
    """Where the proof of a model version stands."""

    PROVING = "proving"
    READY = "ready"
    REFUSED = "refused"
