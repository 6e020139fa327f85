"""Everything that a leading dispatcher does, and how often."""

from dispatcher.loop import Duty
from jobkit.database import Database
from jobkit.overdue import TimeLimits
from jobkit.queue import TaskQueue
from jobkit.reconcile import Reconciled, reconcile
from jobkit.settings import Settings
from jobkit.store import ObjectStore


def duties_of(settings: Settings, database: Database, store: ObjectStore, queue: TaskQueue) -> list[Duty]:
    """Return the duties.

    Parameters
    ----------
    settings : Settings
    database : Database
    store : ObjectStore
    queue : TaskQueue
    """
    limits = TimeLimits(settings.queue_time_limit_s, settings.total_time_limit_s, settings.job_memory_limit_mb)
    return [
        Duty("jobs", settings.dispatch_s, lambda is_over: _look_after_jobs(database, queue, limits)),
    ]


def _look_after_jobs(database: Database, queue: TaskQueue, limits: TimeLimits) -> str:
    found = reconcile(database, queue, limits)
    return "" if found == Reconciled(0, 0, 0) else str(found)
