"""What Prometheus gets besides the requests: read when it scrapes, at most once a second.

Figures of the database are the same from every API process; in queries take `max` over instances, not `sum`. Those
that fall when retention removes rows are gauges; what only grows is a counter.
"""

import platform
import shutil
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from importlib.metadata import version
from pathlib import Path

from prometheus_client import CollectorRegistry, ProcessCollector
from prometheus_client.core import GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from jobkit.database.leadership import DISPATCHER, current_leader
from jobkit.database.session import Database
from jobkit.errors import DatabaseUnavailableError, QueueUnavailableError
from jobkit.queue import TaskQueue
from jobkit.settings import Settings
from service.database_metrics import database_figures
from service.services import Services

CACHE_S = 1.0


def new_registry() -> CollectorRegistry:
    """Return a registry with the metrics that need no connection: this process and its build."""
    registry = CollectorRegistry(auto_describe=False)
    ProcessCollector(registry=registry)
    registry.register(_BuildCollector())
    return registry


class StateCollector(Collector):
    """Reads database, queue and disk at most once in `CACHE_S`.

    Parameters
    ----------
    services : Services
    clock : callable
        Monotonic seconds.
    """

    def __init__(self, services: Services, clock: Callable[[], float] = time.monotonic) -> None:
        self._services = services
        self._clock = clock
        self._lock = threading.Lock()
        self._metrics: list[Metric] = []
        self._read_at: float | None = None

    def collect(self) -> Iterable[Metric]:
        """Return the figures; a second scrape meanwhile waits and gets the same."""
        with self._lock:
            if self._read_at is None or self._clock() - self._read_at >= CACHE_S:
                self._metrics = list(_read(self._services))
                self._read_at = self._clock()
            return self._metrics


class _BuildCollector(Collector):
    def collect(self) -> Iterable[Metric]:
        """Return one constant."""
        labels = {"version": version("quadpatch"), "python_version": platform.python_version()}
        info = GaugeMetricFamily("quadpatch_build_info", "What runs here; always 1.", labels=list(labels))
        info.add_metric(list(labels.values()), 1)
        yield info


def _read(services: Services) -> Iterator[Metric]:
    """Read all figures. Figures of a part that does not answer are left out, and its `up` is 0."""
    yield from _database_metrics(services.database, services.settings)
    yield from _queue_metrics(services.queue)
    yield from _disk_metrics(services.settings.data_dir)


def _database_metrics(database: Database, settings: Settings) -> Iterator[Metric]:
    try:
        metrics = [*database_figures(database, settings.lease_s, settings.scrub_days), *_dispatcher_metrics(database)]
        is_up = True
    except DatabaseUnavailableError:
        metrics, is_up = [], False
    yield GaugeMetricFamily("quadpatch_database_up", "Whether the database answers.", value=is_up)
    yield from metrics


def _dispatcher_metrics(database: Database) -> Iterator[Metric]:
    leader = current_leader(database, DISPATCHER)
    leads = leader is not None and leader.left_s > 0
    yield GaugeMetricFamily("quadpatch_dispatcher_up", "Whether a dispatcher leads.", value=leads)
    since = GaugeMetricFamily(
        "quadpatch_dispatcher_leader_start_time_seconds", "When the leading dispatcher took the lead, in Unix time."
    )
    if leads and leader is not None:
        since.add_metric([], leader.since.timestamp())
    yield since


def _queue_metrics(queue: TaskQueue) -> Iterator[Metric]:
    entries = GaugeMetricFamily("quadpatch_queue_entries", "Entries in the queue of Redis or Valkey.")
    try:
        entries.add_metric([], queue.depth())
        is_up = True
    except QueueUnavailableError:
        is_up = False
    yield GaugeMetricFamily("quadpatch_queue_up", "Whether Redis or Valkey answers.", value=is_up)
    yield entries


def _disk_metrics(folder: Path) -> Iterator[Metric]:
    free = GaugeMetricFamily("quadpatch_disk_free_bytes", "Room on the disk of the data folder of this process.")
    size = GaugeMetricFamily("quadpatch_disk_size_bytes", "Size of the disk of the data folder of this process.")
    try:
        usage = shutil.disk_usage(folder)
    except OSError:
        return
    free.add_metric([], usage.free)
    size.add_metric([], usage.total)
    yield from (free, size)
