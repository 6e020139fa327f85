"""Queries for jobs, shared by all requests that arrive at the same time.

Most requests are polls, and most polls find nothing new. So requests that arrive during a query wait for the next one
and share it: one call in a thread and one short query for all of them. A job is read whole only if a caller wants it
whole and it has changed since it was read last. No answer is older than its request: a query that has started takes no
further caller.
"""

import asyncio
import logging
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field

import anyio.to_thread

from jobkit.errors import DatabaseError, DatabaseUnavailableError, JobNotFoundError
from jobkit.jobs.estimates import Estimates
from jobkit.jobs.jobs import Jobs, JobStatus
from quadpatch_client.schema import Job
from service.pacing import Pacer

_MOST_CACHED = 1000

_logger = logging.getLogger("service")


@dataclass(frozen=True)
class JobView:
    """State and revision of a job, its place in the queue, and the whole job where that was asked for."""

    status: JobStatus
    queue_position: int | None
    job: Job | None


@dataclass
class _Batch:
    """Requests that share a query: which jobs, and whether whole."""

    wanted: dict[str, bool] = field(default_factory=dict)
    task: asyncio.Task[dict[str, JobView]] | None = None


@dataclass(frozen=True)
class OwnJobs:
    """The jobs of a tenant, as the cache of all has them; without a tenant, all of them."""

    cache: "JobCache"
    tenant: str | None = None

    async def status(self, job_id: str) -> JobView:
        """Read state and revision of a job; raise JobNotFoundError."""
        view = await self.cache.status(job_id)
        self._check(view, job_id)
        return view

    async def job(self, job_id: str) -> Job:
        """Read a whole job; raise JobNotFoundError."""
        view = await self.cache.view(job_id)
        self._check(view, job_id)
        return view.job or await self.cache.read_alone(job_id)

    def _check(self, view: JobView, job_id: str) -> None:
        if self.tenant not in (None, view.status.tenant):
            raise JobNotFoundError(f"there is no job {job_id}")


class JobCache:
    """The jobs that all requests of a process read."""

    def __init__(self, jobs: Jobs, estimates: Estimates) -> None:
        self._jobs = jobs
        self._estimates = estimates
        self._one_at_a_time = asyncio.Lock()
        self._next_batch = _Batch()
        self._refresh_task: asyncio.Task[None] | None = None
        self._cached: OrderedDict[str, tuple[JobStatus, Job]] = OrderedDict()
        self._pacer = Pacer()

    async def status(self, job_id: str) -> JobView:
        """Read state and revision of a job; raise JobNotFoundError."""
        return await self._shared_view(job_id, is_whole=False)

    async def view(self, job_id: str) -> JobView:
        """Read a whole job with its state; raise JobNotFoundError.

        The job is None where it was removed right after the query, or its row can't be read: `read_alone` then fails
        for it alone.
        """
        return await self._shared_view(job_id, is_whole=True)

    async def read_alone(self, job_id: str) -> Job:
        """Read a job by a query of its own; raise JobNotFoundError."""
        return await anyio.to_thread.run_sync(self._jobs.get, job_id)

    async def _shared_view(self, job_id: str, is_whole: bool) -> JobView:
        self._start_refresh()
        batch = self._next_batch
        batch.wanted[job_id] = batch.wanted.get(job_id, False) or is_whole
        if batch.task is None:
            batch.task = asyncio.create_task(self._run_batch(batch))
        # A client that disconnects must not cancel the query of the others.
        view = (await asyncio.shield(batch.task)).get(job_id)
        await self._pacer.wait_turn()  # hundreds of requests may have shared the query
        if view is None:
            raise JobNotFoundError(f"there is no job {job_id}")
        return view

    def _start_refresh(self) -> None:
        """Refresh estimates beside the queries: with a long queue that takes longer than a caller should wait."""
        if self._estimates.is_due and (self._refresh_task is None or self._refresh_task.done()):
            self._refresh_task = asyncio.create_task(self._refresh())

    async def _refresh(self) -> None:
        try:
            await anyio.to_thread.run_sync(self._estimates.refresh)
        except (DatabaseUnavailableError, DatabaseError) as error:
            _logger.warning("estimates wait for the database: %r", error.__cause__ or error)

    async def _run_batch(self, batch: _Batch) -> dict[str, JobView]:
        async with self._one_at_a_time:
            self._next_batch = _Batch()
            return await anyio.to_thread.run_sync(self._read, batch.wanted)

    def _read(self, wanted: Mapping[str, bool]) -> dict[str, JobView]:
        if self._estimates.is_old:
            self._estimates.refresh()
        statuses = self._jobs.statuses(wanted)
        whole = {job_id: status for job_id, status in statuses.items() if wanted[job_id]}
        jobs = self._whole(whole)
        return {
            job_id: JobView(status, self._estimates.position(job_id, status.state), jobs.get(job_id))
            for job_id, status in statuses.items()
        }

    def _whole(self, statuses: Mapping[str, JobStatus]) -> dict[str, Job]:
        cached = {job_id: self._cached.get(job_id) for job_id in statuses}
        jobs = {job_id: entry[1] for job_id, entry in cached.items() if entry and entry[0] == statuses[job_id]}
        for job_id, job in self._jobs.get_many(statuses.keys() - jobs.keys()).items():
            jobs[job_id] = job
            self._cached[job_id] = (JobStatus(job.revision, job.state, job.pinned, statuses[job_id].tenant), job)
            self._cached.move_to_end(job_id)
        while len(self._cached) > _MOST_CACHED:
            self._cached.popitem(last=False)
        return {job_id: self._estimates.complete(job) for job_id, job in jobs.items()}
