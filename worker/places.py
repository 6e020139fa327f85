"""The places of a tenant whose jobs at once have a limit: at the end of a job the next one is put into the queue.

Entries of a tenant that ran as many jobs as it may were taken out of the queue meanwhile, and started nothing.

Tested in `tests/worker/test_jobs.py`.
"""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from jobkit.errors import DatabaseError, DatabaseUnavailableError, QueueUnavailableError
from jobkit.requeue import submit_next
from worker.context import Context

_log = logging.getLogger("quadpatch.worker.places")


@contextmanager
def place_given_back(context: Context, tenant: str) -> Iterator[None]:
    """Put the next job of a tenant into the queue at the end of a `with` block, where its jobs at once have a limit."""
    try:
        yield
    finally:
        try:
            submit_next(context.database, context.queue, tenant)
        except (DatabaseUnavailableError, DatabaseError, QueueUnavailableError) as error:
            _log.warning("the next job of a tenant is submitted by the dispatcher: %s", error)
