import threading
from dataclasses import replace

import pytest

from jobkit.database.idempotency import Idempotency
from jobkit.database.session import Database
from jobkit.errors import IdempotencyError, JobFinishedError, JobNotFoundError, MeshNotFoundError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.search import JobSearch
from jobkit.meshes import Meshes
from jobkit.storage.base import StoredObject
from quadpatch_client.schema import Job, JobResult, JobSpec, JobState, ResolvedModel

KEY = Idempotency("station-1", "order-17", "a" * 64)


def test_a_job_comes_back_as_it_was_written(database: Database, job: Job, new_job: NewJob) -> None:
    assert Jobs(database).get(job.id) == job
    assert job.state == JobState.QUEUED
    assert job.spec == new_job.spec
    assert job.links.cancel == f"/v1/jobs/{job.id}/cancel"
    assert job.links.result is None


def test_an_unknown_job_is_named_as_such(database: Database) -> None:
    with pytest.raises(JobNotFoundError, match="job_none"):
        Jobs(database).get("job_none")


def test_a_job_needs_its_mesh(database: Database) -> None:
    new = NewJob(JobSpec(mesh_id="f" * 64), ResolvedModel(requested="self", kind="self"), 1)
    with pytest.raises(MeshNotFoundError):
        Jobs(database).create(new)


def test_a_job_keeps_the_name_that_its_mesh_had(database: Database, new_job: NewJob) -> None:
    meshes, jobs = Meshes(database), Jobs(database)
    mesh = meshes.get(new_job.spec.mesh_id)
    stored = StoredObject("meshes/ab/abc", mesh.size_bytes, mesh.id)
    ids = []
    for name in ("first.ply", "second.ply"):
        meshes.add(stored, name, "ply")
        ids.append(jobs.create(new_job)[0].id)
    named = replace(new_job, spec=new_job.spec.model_copy(update={"mesh_name": "third.ply"}))
    ids.append(jobs.create(named)[0].id)
    assert [jobs.get(job_id).mesh_name for job_id in ids] == ["first.ply", "second.ply", "third.ply"]


def test_a_repeated_key_gives_the_first_job(database: Database, new_job: NewJob) -> None:
    first, is_new = Jobs(database).create(new_job, KEY)
    again, is_new_again = Jobs(database).create(new_job, KEY)
    assert (is_new, is_new_again) == (True, False)
    assert again == first


def test_one_key_for_two_requests_is_refused(database: Database, new_job: NewJob) -> None:
    Jobs(database).create(new_job, KEY)
    with pytest.raises(IdempotencyError, match="order-17"):
        Jobs(database).create(new_job, Idempotency(KEY.principal, KEY.key, "b" * 64))


def test_two_clients_may_use_the_same_key(database: Database, new_job: NewJob) -> None:
    first, _ = Jobs(database).create(new_job, KEY)
    second, is_new = Jobs(database).create(new_job, Idempotency("station-2", KEY.key, KEY.request_sha256))
    assert is_new
    assert second.id != first.id


def test_one_key_sent_many_times_at_once_makes_one_job(database: Database, new_job: NewJob) -> None:
    ids: list[str] = []
    threads = [threading.Thread(target=lambda: ids.append(Jobs(database).create(new_job, KEY)[0].id)) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(ids) == 8
    assert len(set(ids)) == 1


def test_pages_hold_every_job_once_though_new_ones_arrive(database: Database, new_job: NewJob) -> None:
    jobs = Jobs(database)
    old = [jobs.create(new_job)[0].id for _ in range(7)]
    seen: list[str] = []
    cursor = None
    while True:
        page = jobs.page(limit=2, cursor=cursor)
        seen += [job.id for job in page.items]
        jobs.create(new_job)
        cursor = page.next_cursor
        if cursor is None:
            break
    assert sorted(seen) == sorted(old)
    assert seen == sorted(seen, reverse=True)


def test_a_page_can_be_of_one_state(database: Database, new_job: NewJob) -> None:
    jobs = Jobs(database)
    queued, running = (jobs.create(new_job)[0].id for _ in range(2))
    Attempts(database).start(running, "w", 30)
    assert [job.id for job in jobs.page(10, search=JobSearch([JobState.RUNNING])).items] == [running]
    assert [job.id for job in jobs.page(10, search=JobSearch([JobState.QUEUED])).items] == [queued]
    assert jobs.page(10, search=JobSearch([JobState.FAILED])).items == []


def test_a_queued_job_is_canceled_at_once_and_twice_is_once(database: Database, job: Job) -> None:
    jobs = Jobs(database)
    first = jobs.request_cancel(job.id)
    assert first.state == JobState.CANCELED
    assert jobs.request_cancel(job.id) == first


def test_a_running_job_is_asked_to_stop_once(database: Database, job: Job) -> None:
    jobs = Jobs(database)
    Attempts(database).start(job.id, "w", 30)
    first = jobs.request_cancel(job.id)
    assert first.state == JobState.CANCELING
    assert jobs.request_cancel(job.id) == first


def test_a_job_that_ended_otherwise_cannot_be_canceled(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempts.publish(attempts.start(job.id, "w", 30).attempt, JobResult(format="ply"))
    with pytest.raises(JobFinishedError, match="succeeded"):
        Jobs(database).request_cancel(job.id)


def test_events_tell_the_whole_story_in_pages(database: Database, job: Job) -> None:
    attempts, jobs = Attempts(database), Jobs(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    attempts.report_progress(attempt, "read", 3.0)
    attempts.publish(attempt, JobResult(format="ply"))
    first = jobs.events(job.id, limit=3)
    assert [event.type for event in first.items] == ["queued", "started", "progress"]
    assert first.items[2].data == {"stage": "read", "percent": 3.0}
    assert first.next_after == 3
    rest = jobs.events(job.id, after=3, limit=3)
    assert [event.type for event in rest.items] == ["succeeded"]
    assert rest.next_after is None
