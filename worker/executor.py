"""RQ as an executor: one queue, one task at a time, in this very process.

The heavy work is done by engine children, so nothing is gained by RQ's own fork per job, and much is lost: a killed
parent would leave it running.

RQ's worker gives up when Valkey becomes unavailable during a task. The task itself needs no Valkey, and to start a
process anew takes time: so RQ's worker is replaced by a new one as soon as Valkey answers again.
"""

import contextlib
import logging
import secrets
import threading
import time
from collections.abc import Iterable

from redis.exceptions import RedisError
from rq import Queue, SimpleWorker
from rq.exceptions import StopRequested
from rq.serializers import JSONSerializer

from jobkit.queue import TaskQueue
from worker.entries import Entry

# RQ waits for a task for 15 s less than this, and notices a connection that hangs 10 s after that.
_TTL_S = 25
_PAUSE_S = 1.0

_log = logging.getLogger("quadpatch.worker.executor")


def execute(
    queue: TaskQueue,
    queue_name: str,
    name: str,
    draining: threading.Event,
    logging_level: str,
    abilities: Iterable[str] = (),
) -> None:
    """Take tasks until the process is asked to stop.

    Parameters
    ----------
    queue : TaskQueue
    queue_name : str
    name : str
        Of this worker, for people.
    draining : threading.Event
        Set by SIGTERM or SIGINT once tasks have been taken.
    logging_level : str
        Of RQ's own log lines.
    abilities : iterable of str
        What this worker can do that others may not, see `jobkit.queue`.
    """
    with contextlib.suppress(StopRequested):
        while not draining.is_set():
            try:
                Executor(queue, queue_name, name, draining, abilities).work(logging_level=logging_level)
            except RedisError as error:
                _log.warning("the queue does not answer: %s", error)
            if not draining.is_set():
                time.sleep(_PAUSE_S)


class Executor(SimpleWorker):  # type: ignore[misc]
    """An RQ worker that tells the running task when it is asked to stop."""

    # A Valkey that was restarted is back within a second; the default is a minute.
    max_connection_wait_time = 2.0
    log_result_lifespan = False

    def __init__(
        self,
        queue: TaskQueue,
        queue_name: str,
        name: str,
        draining: threading.Event,
        abilities: Iterable[str] = (),
    ) -> None:
        super().__init__(
            [Queue(queue_name, connection=queue.connection, serializer=JSONSerializer, job_class=Entry)],
            # RQ refuses a name that is still registered, as that of a killed worker is for a while.
            name=f"{name}-{secrets.token_hex(2)}",
            connection=queue.connection,
            serializer=JSONSerializer,
            job_class=Entry,
            log_job_description=False,
            worker_ttl=_TTL_S,
        )
        self._draining = draining
        self._task_queue, self._abilities = queue, abilities

    def register_birth(self) -> None:
        """Say in the entry of this worker what it can do, too."""
        super().register_birth()
        self._task_queue.note_abilities(self.key, self._abilities)

    def handle_warm_shutdown_request(self) -> None:
        """Pass the request on: the first SIGTERM or SIGINT drains, RQ itself obeys a second one at once."""
        self._draining.set()
        super().handle_warm_shutdown_request()

    def set_shutdown_requested_date(self) -> None:
        """Write nothing: this runs in a signal handler, and an unavailable Valkey would fail the running task."""

    def subscribe(self) -> None:
        """Take no commands through Valkey: a worker is controlled by signals and the database."""
