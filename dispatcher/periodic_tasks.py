"""Everything that a leading dispatcher does, and how often."""

from dispatcher.batches import follow_batches
from dispatcher.lease_reaper import LeaseReaper
from dispatcher.loop import PeriodicTask
from dispatcher.retention import Sweeper, forget_audit, remove_expired
from dispatcher.scrub import ROUND_S, scrub_task
from dispatcher.webhooks import deliver_webhooks, forget_old_deliveries
from jobkit.database.leadership import Leadership
from jobkit.database.session import Database
from jobkit.jobs.timeouts import TimeLimits
from jobkit.queue import TaskQueue
from jobkit.requeue import reconcile
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore

_HOUR_S = 3_600.0


def periodic_tasks(
    settings: Settings, database: Database, store: ObjectStore, queue: TaskQueue, leadership: Leadership
) -> list[PeriodicTask]:
    """Return the periodic tasks of a leading dispatcher.

    Parameters
    ----------
    settings : Settings
    database : Database
    store : ObjectStore
    queue : TaskQueue
    leadership : Leadership
        Of this dispatcher.
    """
    limits = TimeLimits(settings.queue_time_limit_s, settings.total_time_limit_s, settings.job_memory_limit_mb)
    reaper = LeaseReaper(
        lambda takes_leases: reconcile(database, queue, limits, takes_leases=takes_leases),
        lambda: leadership.found_leaderless_at,
        settings.heartbeat_s,
    )
    sweeper = Sweeper(database, store)
    return [
        PeriodicTask("jobs", settings.dispatch_s, reaper.look),
        PeriodicTask("batches", settings.dispatch_s, lambda is_over: follow_batches(database, is_over)),
        PeriodicTask("webhooks", settings.dispatch_s, lambda is_over: deliver_webhooks(database, settings, is_over)),
        PeriodicTask(
            "webhook log", _HOUR_S, lambda is_over: forget_old_deliveries(database, settings.webhook_log_days, is_over)
        ),
        PeriodicTask("audit log", _HOUR_S, lambda is_over: forget_audit(database, settings.audit_log_days, is_over)),
        PeriodicTask("retention", settings.sweep_s, lambda is_over: remove_expired(settings, database, store, is_over)),
        PeriodicTask("sweep", settings.sweep_s, sweeper.sweep),
        PeriodicTask("scrub", ROUND_S, scrub_task(settings, database, store)),
    ]
