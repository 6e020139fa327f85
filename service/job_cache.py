"""Looks at jobs, shared by all requests that ask at the same time.

Most requests are polls, and most polls find nothing new. So requests that come while a look is under way wait for the
next one and share it: one hop to a thread and one short query for all of them, however many there are. A job is read
whole only if a caller wants it whole and it has changed since it was read last. No caller is told of a moment before
the request: a look that has begun takes no further caller in.
"""

import asyncio
import logging
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field

import anyio.to_thread
from sqlalchemy.exc import SQLAlchemyError

from jobkit.errors import DatabaseUnavailableError, JobNotFoundError
from jobkit.jobs.estimates import Estimates
from jobkit.jobs.jobs import Glance, Jobs
from jobkit.schema import Job
from service.turns import Turns

_MOST_KEPT = 1000

_logger = logging.getLogger("service")


@dataclass(frozen=True)
class Sight:
    """A job at a glance, its place in the queue, and the whole of it where that was asked for."""

    glance: Glance
    queue_position: int | None
    job: Job | None


@dataclass
class _Batch:
    """Requests that share a look: which jobs, and whether whole."""

    wanted: dict[str, bool] = field(default_factory=dict)
    task: asyncio.Task[dict[str, Sight]] | None = None


class JobCache:
    """Where all requests of a process look for jobs."""

    def __init__(self, jobs: Jobs, estimates: Estimates) -> None:
        self._jobs = jobs
        self._estimates = estimates
        self._one_at_a_time = asyncio.Lock()
        self._next = _Batch()
        self._refreshing: asyncio.Task[None] | None = None
        self._kept: OrderedDict[str, tuple[Glance, Job]] = OrderedDict()
        self._turns = Turns()

    async def glance(self, job_id: str) -> Sight:
        """Look whether a job has changed; raise JobNotFoundError."""
        return await self._share(job_id, is_whole=False)

    async def job(self, job_id: str) -> Job:
        """Look at all of a job; raise JobNotFoundError."""
        job = (await self._share(job_id, is_whole=True)).job
        if job is None:  # removed right after the glance, or a row that can't be read: this fails for it alone
            return await anyio.to_thread.run_sync(self._jobs.get, job_id)
        return job

    async def _share(self, job_id: str, is_whole: bool) -> Sight:
        self._keep_fresh()
        batch = self._next
        batch.wanted[job_id] = batch.wanted.get(job_id, False) or is_whole
        if batch.task is None:
            batch.task = asyncio.create_task(self._look(batch))
        # A client that hangs up must not take the others' look away.
        sight = (await asyncio.shield(batch.task)).get(job_id)
        await self._turns.take()  # a look may have served hundreds, whose answers are written now
        if sight is None:
            raise JobNotFoundError(f"there is no job {job_id}")
        return sight

    def _keep_fresh(self) -> None:
        """See to estimates beside the looks: a long queue takes longer to go through than a caller should wait."""
        if self._estimates.is_due and (self._refreshing is None or self._refreshing.done()):
            self._refreshing = asyncio.create_task(self._refresh())

    async def _refresh(self) -> None:
        try:
            await anyio.to_thread.run_sync(self._estimates.refresh)
        except (DatabaseUnavailableError, SQLAlchemyError) as error:
            _logger.warning("estimates wait for the database: %r", error.__cause__ or error)

    async def _look(self, batch: _Batch) -> dict[str, Sight]:
        async with self._one_at_a_time:
            self._next = _Batch()
            return await anyio.to_thread.run_sync(self._read, batch.wanted)

    def _read(self, wanted: Mapping[str, bool]) -> dict[str, Sight]:
        if self._estimates.is_old:
            self._estimates.refresh()
        glances = self._jobs.glances(wanted)
        whole = {job_id: glance for job_id, glance in glances.items() if wanted[job_id]}
        jobs = self._whole(whole)
        return {
            job_id: Sight(glance, self._estimates.position(job_id, glance.state), jobs.get(job_id))
            for job_id, glance in glances.items()
        }

    def _whole(self, glances: Mapping[str, Glance]) -> dict[str, Job]:
        kept = {job_id: self._kept.get(job_id) for job_id in glances}
        jobs = {job_id: entry[1] for job_id, entry in kept.items() if entry and entry[0] == glances[job_id]}
        for job_id, job in self._jobs.get_many(glances.keys() - jobs.keys()).items():
            jobs[job_id] = job
            self._kept[job_id] = (Glance(job.revision, job.state, job.pinned), job)
            self._kept.move_to_end(job_id)
        while len(self._kept) > _MOST_KEPT:
            self._kept.popitem(last=False)
        return {job_id: self._estimates.complete(job) for job_id, job in jobs.items()}
