import threading
from collections.abc import Collection
from typing import Any

import anyio
import pytest

from jobkit.database.session import Database
from jobkit.errors import JobNotFoundError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.estimates import Estimates
from jobkit.jobs.jobs import Jobs, JobStatus
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.storage.base import ObjectStore
from quadpatch_client.schema import Job, JobSpec, JobState, ResolvedModel
from service.job_cache import JobCache, OwnJobs
from tests.service.rounds import most_in_a_round
from tests.waiting import GUARD_S


class CountingJobs(Jobs):
    """Counts the queries, and holds the first one up until it is let go."""

    def __init__(self, database: Database) -> None:
        super().__init__(database)
        self.status_queries: list[set[str]] = []
        self.read_whole: list[set[str]] = []
        self.has_begun = threading.Event()
        self.may_go_on = threading.Event()

    def statuses(self, job_ids: Collection[str]) -> dict[str, JobStatus]:
        self.status_queries.append(set(job_ids))
        found = super().statuses(job_ids)
        self.has_begun.set()
        assert self.may_go_on.wait(GUARD_S)
        return found

    def get_many(self, job_ids: Collection[str]) -> dict[str, Job]:
        self.read_whole.append(set(job_ids))
        return super().get_many(job_ids)


@pytest.fixture
def job(database: Database, store: ObjectStore) -> Job:
    with store.writer("meshes") as writer:
        writer.write(b"ply\n")
        stored = writer.commit()
    mesh = Meshes(database).add(stored, "scan.ply", "ply")[0]
    new = NewJob(JobSpec(mesh_id=mesh.id), ResolvedModel(requested="self", kind="self"), max_attempts=2)
    return Jobs(database).create(new)[0]


@pytest.fixture
def jobs(database: Database) -> CountingJobs:
    return CountingJobs(database)


def test_who_comes_during_a_look_shares_the_next_one_and_sees_what_has_changed_meanwhile(
    database: Database, job: Job, jobs: CountingJobs
) -> None:
    found: dict[int, Any] = {}

    async def look(place: int) -> None:
        found[place] = await job_cache.job(job.id)

    async def live() -> None:
        async with anyio.create_task_group() as tasks:
            tasks.start_soon(look, 0)
            await anyio.to_thread.run_sync(jobs.has_begun.wait)
            await anyio.to_thread.run_sync(Attempts(database).start, job.id, "test", 30.0)
            for place in range(1, 50):
                tasks.start_soon(look, place)
            await anyio.sleep(0)
            jobs.may_go_on.set()

    job_cache = OwnJobs(JobCache(jobs, Estimates(database)))
    anyio.run(live)
    assert len(jobs.status_queries) == 2
    assert {found[place].state for place in range(1, 50)} == {JobState.RUNNING}


def test_a_job_is_read_whole_once_for_each_change_and_only_if_a_request_wants_it(
    database: Database, job: Job, jobs: CountingJobs
) -> None:
    jobs.may_go_on.set()
    job_cache = OwnJobs(JobCache(jobs, Estimates(database)))

    async def live() -> None:
        await job_cache.status(job.id)
        assert (await job_cache.job(job.id)).revision == 1
        await job_cache.job(job.id)
        await anyio.to_thread.run_sync(Attempts(database).start, job.id, "test", 30.0)
        assert (await job_cache.status(job.id)).status.revision == 2
        assert (await job_cache.job(job.id)).revision == 2

    anyio.run(live)
    assert [ids for ids in jobs.read_whole if ids] == [{job.id}, {job.id}]


def test_what_the_board_shows_is_what_the_database_holds(database: Database, job: Job) -> None:
    job_cache = OwnJobs(JobCache(Jobs(database), Estimates(database)))
    attempts = Attempts(database)

    async def live() -> None:
        attempt = attempts.start(job.id, "test", 30).attempt
        for percent in (10.0, 20.0):
            attempts.report_progress(attempt, "fill", percent)
            assert await job_cache.job(job.id) == Jobs(database).get(job.id)

    anyio.run(live)


def test_one_unknown_job_leaves_the_others_their_answers(database: Database, job: Job) -> None:
    job_cache = OwnJobs(JobCache(Jobs(database), Estimates(database)))
    refused = []

    async def unknown() -> None:
        with pytest.raises(JobNotFoundError):
            await job_cache.job("job_" + "0" * 26)
        refused.append(True)

    async def live() -> None:
        async with anyio.create_task_group() as tasks:
            tasks.start_soon(unknown)
            assert (await job_cache.job(job.id)).id == job.id

    anyio.run(live)
    assert refused


def test_a_client_that_disconnects_does_not_cancel_the_query_of_others(
    database: Database, job: Job, jobs: CountingJobs
) -> None:
    job_cache = OwnJobs(JobCache(jobs, Estimates(database)))
    found = []

    async def look() -> None:
        found.append(await job_cache.job(job.id))

    async def live() -> None:
        async with anyio.create_task_group() as tasks, anyio.create_task_group() as hasty:
            hasty.start_soon(look)
            await anyio.sleep(0)
            tasks.start_soon(look)
            await anyio.to_thread.run_sync(jobs.has_begun.wait)
            hasty.cancel_scope.cancel()
            jobs.may_go_on.set()

    anyio.run(live)
    assert [seen.id for seen in found] == [job.id]


def test_those_that_shared_a_look_write_their_answers_one_after_the_other(
    database: Database, job: Job, jobs: CountingJobs
) -> None:
    job_cache = OwnJobs(JobCache(jobs, Estimates(database)))
    jobs.may_go_on.set()
    assert anyio.run(most_in_a_round, lambda: job_cache.job(job.id), 100) == 1
    assert len(jobs.status_queries) < 10
