"""RQ as an executor: one queue, one task at a time, in this very process.

The heavy work is done by engine children, so nothing is gained by RQ's own fork per job, and much is lost: a killed
parent would leave it running.
"""

import threading

from rq import Queue, SimpleWorker
from rq.serializers import JSONSerializer

from jobkit.queue import TaskQueue


class Executor(SimpleWorker):  # type: ignore[misc]
    """An RQ worker that tells the running task when it is asked to stop."""

    # A Valkey that was restarted is back within a second; the default is a minute.
    max_connection_wait_time = 5.0
    log_result_lifespan = False

    def __init__(self, queue: TaskQueue, queue_name: str, name: str, draining: threading.Event) -> None:
        super().__init__(
            [Queue(queue_name, connection=queue.connection, serializer=JSONSerializer)],
            name=name,
            connection=queue.connection,
            serializer=JSONSerializer,
            log_job_description=False,
        )
        self._draining = draining

    def handle_warm_shutdown_request(self) -> None:
        """Pass the request on: the first SIGTERM or SIGINT drains, RQ itself obeys a second one at once."""
        self._draining.set()
        super().handle_warm_shutdown_request()
