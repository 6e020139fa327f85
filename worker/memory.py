"""The memory that a worker's tasks reserve, and the jobs that wait for what they give back.

An unavailable database or queue keeps no task from running and none from ending: reservations end with their lease, and
the dispatcher puts what waits into the queue again.

Tested in `tests/worker/test_jobs.py`.
"""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from jobkit.errors import DatabaseError, DatabaseUnavailableError, QueueUnavailableError
from jobkit.queue import job_entry
from jobkit.requeue import submit_job
from worker.context import Context

_OUTAGES = (DatabaseUnavailableError, DatabaseError, QueueUnavailableError)

_log = logging.getLogger("quadpatch.worker.memory")


def reserve_memory(context: Context, needed_mb: int) -> None:
    """Reserve what a task needs that is not held up, in MiB."""
    try:
        context.admission.reserve(needed_mb, context.settings.lease_s)
    except _OUTAGES as error:
        _log.warning("memory was not reserved: %s", error)


@contextmanager
def memory_given_back(context: Context) -> Iterator[None]:
    """Give back at the end of a `with` block what its task has reserved, and submit the jobs that fit then."""
    try:
        yield
    finally:
        try:
            context.admission.release()
        except _OUTAGES as error:
            _log.warning("memory is given back when its lease is over: %s", error)
        submit_fitting(context)


def submit_fitting(context: Context) -> None:
    """Put the jobs that waited for memory and fit now to the front of the queue, the oldest first."""
    try:
        jobs = context.admission.fitting()
        entries = context.queue.entries() if jobs else set()
        for job_id, attempt in reversed(jobs):
            if job_entry(job_id, attempt + 1) not in entries:
                submit_job(context.database, context.queue, job_id, attempt, at_front=True)
        context.admission.refresh()
    except _OUTAGES as error:
        _log.warning("jobs that wait for memory are submitted later: %s", error)
