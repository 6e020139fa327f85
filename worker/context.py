"""What every task of a worker process shares: opened once at start, handed to the tasks by name.

RQ calls tasks by their dotted path with plain arguments, so the context is looked up and not passed; it is set
by `python -m worker` alone.
"""

import secrets
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path

from jobkit.database.session import Database
from jobkit.jobs.admission import Admission, AdmissionRules
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.memory_needs import MemoryNeeds
from jobkit.jobs.reservations import Machine
from jobkit.meshes import Meshes
from jobkit.models.proofs import Proofs
from jobkit.models.registry import Registry
from jobkit.queue import NETWORKS, TaskQueue
from jobkit.settings import Settings
from jobkit.shadows.runs import ShadowRuns
from jobkit.storage.base import ObjectStore
from jobkit.telemetry import Telemetry
from jobkit.views import Views
from worker.engine.client import ForkServer
from worker.machine_memory import machine_memory


@dataclass(frozen=True)
class Context:
    """Open connections and folders of one worker process.

    Attributes
    ----------
    name : str
        Of this worker, for people.
    n_threads : int
        Of numerical libraries in an engine.
    n_processes : int
        That may share one repair.
    draining : threading.Event
        Set once the worker is asked to stop.
    telemetry : Telemetry
        Takes the spans of attempts and stages.
    abilities : frozenset of str
        What it can do that others may not, see `jobkit.queue`.
    """

    name: str
    settings: Settings
    database: Database
    store: ObjectStore
    queue: TaskQueue
    fork_server: ForkServer
    n_threads: int
    n_processes: int = 1
    draining: threading.Event = field(default_factory=threading.Event)
    telemetry: Telemetry = field(default_factory=Telemetry)
    abilities: frozenset[str] = frozenset({NETWORKS})

    @property
    def attempts(self) -> Attempts:
        """Attempts at jobs."""
        return Attempts(self.database, fits_networks=NETWORKS in self.abilities)

    @cached_property
    def admission(self) -> Admission:
        """The memory of this worker's tasks."""
        settings = self.settings
        machine = Machine(settings.machine or socket.gethostname(), partial(machine_memory, settings.machine_memory_mb))
        rules = AdmissionRules(settings.job_memory_limit_mb, settings.memory_wait_s)
        return Admission(self.database, MemoryNeeds(self.database), self.name, machine, rules)

    @property
    def jobs(self) -> Jobs:
        """Jobs as clients see them."""
        return Jobs(self.database)

    @property
    def meshes(self) -> Meshes:
        """Uploaded meshes."""
        return Meshes(self.database)

    @property
    def proofs(self) -> Proofs:
        """Proofs of models."""
        return Proofs(self.database)

    @property
    def views(self) -> Views:
        """Views of meshes, jobs and models."""
        return Views(self.database)

    @property
    def shadow_runs(self) -> ShadowRuns:
        """Runs of candidates."""
        return ShadowRuns(self.database)

    @property
    def registry(self) -> Registry:
        """Models."""
        return Registry(self.database, self.store)

    @property
    def work_folder(self) -> Path:
        """Where engine children work; one folder per request, removed afterwards."""
        return self.settings.data_dir.resolve() / "work" / self.name

    @property
    def cache_folder(self) -> Path:
        """Where models lie that were fetched from the store."""
        return self.settings.data_dir.resolve() / "cache"


_CURRENT: ContextVar[Context] = ContextVar("worker context")


def current_context() -> Context:
    """Return the context of this worker process; raise LookupError outside of one."""
    return _CURRENT.get()


@contextmanager
def use_context(context: Context) -> Iterator[None]:
    """Make the context the current one for the length of a `with` block."""
    token = _CURRENT.set(context)
    try:
        yield
    finally:
        _CURRENT.reset(token)


def worker_name(pid: int) -> str:
    """Name a worker by machine and process.

    The end is random: in a container every worker has the same process id, and RQ refuses the name of a worker that
    was killed until its entry in Redis expires.
    """
    return f"{socket.gethostname()}-{pid}-{secrets.token_hex(3)}"
