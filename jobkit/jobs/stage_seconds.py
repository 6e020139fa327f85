"""How long the stages of published jobs took, added up by stage, method and task."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from sqlalchemy.orm import Session

from jobkit.database.counters import add_up
from jobkit.database.tables import StageRow
from quadpatch_client.schema import Task
from quadpatch_rules.tasks import FILL


@dataclass(frozen=True)
class StageSeconds:
    """How long the stages of one job took.

    Attributes
    ----------
    method : str
        As in the spec: `dictionary`, `cnn` or `smooth`.
    seconds : mapping of str to float
        Wall-clock seconds by stage.
    task : str
        As in the spec.
    """

    method: str
    seconds: Mapping[str, float] = field(default_factory=dict)
    task: Task = FILL


def add_stages(session: Session, stages: StageSeconds) -> None:
    """Add the stages of a job to the sums, in the transaction that publishes it."""
    rows = [
        {"stage": stage, "method": stages.method, "task": stages.task, "count": 1, "seconds": seconds}
        for stage, seconds in sorted(stages.seconds.items())
    ]
    if rows:
        add_up(session, StageRow, rows)
