"""Also tests `jobkit/jobs/fingerprints.py` and `jobkit/storage/result_files.py`."""

import threading
from dataclasses import replace

import pytest
from sqlalchemy import select, update

from dispatcher.scrub import Scrub, ScrubLimits
from dispatcher.unreferenced_objects import sweep_objects
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow
from jobkit.errors import StaleAttemptError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.fingerprints import fingerprint_of
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.retention import delete_job, expire_jobs
from jobkit.storage.base import ObjectStore
from jobkit.storage.result_files import unnamed
from quadpatch_client.schema import JobSpec, JobState, ResolvedModel
from tests.jobkit.fixtures import DAY, AgingStore, age_rows, finish, keys_in, new_job, upload
from tests.waiting import GUARD_S

SELF = ResolvedModel(requested="self", kind="self")


@pytest.fixture
def database(any_database: Database) -> Database:
    return any_database


def reusing(database: Database, store: ObjectStore) -> NewJob:
    return replace(new_job(upload(database, store, b"ply")), may_reuse=True)


def plain(new: NewJob) -> NewJob:
    """The same without pictures, which the workers of these tests draw none of."""
    spec = new.spec.model_copy(update={"output": new.spec.output.model_copy(update={"preview": False})})
    return replace(new, spec=spec)


def test_a_fingerprint_covers_the_options_and_the_bytes_of_mesh_and_model() -> None:
    spec = JobSpec(mesh_id="0" * 64)
    known = fingerprint_of(spec, SELF)
    same = spec.model_copy(update={"label": "x", "priority": "bulk", "mesh_name": "a.ply", "metadata": {"a": "b"}})
    assert fingerprint_of(same, SELF.model_copy(update={"requested": "an-alias"})) == known
    others = [
        fingerprint_of(spec.model_copy(update={"mesh_id": "1" * 64}), SELF),
        fingerprint_of(spec.model_copy(update={"seed": 1}), SELF),
        fingerprint_of(spec, SELF.model_copy(update={"sha256": "2" * 64})),
    ]
    assert len({known, *others}) == 4


def test_what_stands_in_a_page_is_part_of_the_fingerprint_of_a_job_that_asks_for_one() -> None:
    spec = JobSpec.model_validate({"mesh_id": "0" * 64, "output": {"html_report": True}})
    known = fingerprint_of(spec, SELF)
    assert fingerprint_of(spec.model_copy(update={"priority": "bulk"}), SELF) == known
    changes = ({"label": "x"}, {"mesh_name": "a.ply"}, {"metadata": {"a": "b"}})
    assert len({known, *(fingerprint_of(spec.model_copy(update=change), SELF) for change in changes)}) == 4
    assert len({known, *(fingerprint_of(spec, SELF, name) for name in ("station 4", "station 5"))}) == 3


def test_a_page_never_names_the_key_of_another_job(database: Database, store: ObjectStore) -> None:
    new = replace(plain(reusing(database, store)), asked_by="station 4")
    first = finish(database, store, Jobs(database).create(new)[0].id)
    assert Jobs(database).create(replace(new, asked_by="station 5"))[0].cached_from == first.id
    with_page = new.spec.output.model_copy(update={"html_report": True})
    named = replace(new, spec=new.spec.model_copy(update={"output": with_page}))
    jobs = [Jobs(database).create(replace(named, asked_by=name))[0].id for name in ("station 4", "station 5", None)]
    assert [Attempts(database).start(job_id, "w", 30).asked_by for job_id in jobs] == ["station 4", "station 5", None]
    with database.read() as session:
        query = select(JobRow.fingerprint).where(JobRow.id.in_(jobs))
        assert len(set(session.scalars(query))) == 3


def test_a_job_takes_over_the_result_of_an_equal_one(database: Database, store: ObjectStore) -> None:
    new = plain(reusing(database, store))
    first = Jobs(database).create(new)[0]
    assert first.state == JobState.QUEUED
    finish(database, store, first.id)
    second = Jobs(database).create(new)[0]
    assert (second.state, second.cached_from, second.revision) == (JobState.SUCCEEDED, first.id, 2)
    assert second.result == Jobs(database).get(first.id).result
    assert Jobs(database).create(replace(new, may_reuse=False))[0].state == JobState.QUEUED


def test_a_job_that_waits_takes_over_the_result_of_one_that_ended_meanwhile(
    database: Database, store: ObjectStore
) -> None:
    new = plain(reusing(database, store))
    jobs = [Jobs(database).create(new)[0] for _ in range(2)]
    finish(database, store, jobs[0].id)
    with pytest.raises(StaleAttemptError, match="taken over"):
        Attempts(database).start(jobs[1].id, "w", 30)
    assert Jobs(database).get(jobs[1].id).cached_from == jobs[0].id


def test_another_version_and_another_tenant_are_no_source(database: Database, store: ObjectStore) -> None:
    new = plain(reusing(database, store))
    first = finish(database, store, Jobs(database).create(new)[0].id)
    assert first.result is not None
    for values in (
        {"result": first.result.model_copy(update={"version": "0.1.0"}).model_dump(mode="json")},
        {"tenant": "other"},
    ):
        with database.write() as session:
            session.execute(update(JobRow).where(JobRow.id == first.id).values(**values))
        assert Jobs(database).create(new)[0].state == JobState.QUEUED


def test_what_is_past_its_retention_is_left_alone_unless_it_is_kept(database: Database, store: ObjectStore) -> None:
    new = plain(reusing(database, store))
    first = finish(database, store, Jobs(database).create(new)[0].id)
    age_rows(database, 31 * DAY)
    assert Jobs(database, 30).create(new)[0].state == JobState.QUEUED
    with database.write() as session:
        session.execute(update(JobRow).where(JobRow.id == first.id).values(pinned=True))
    assert Jobs(database, 30).create(new)[0].cached_from == first.id


def test_retention_keeps_files_until_no_job_names_them(database: Database, store: ObjectStore) -> None:
    new = plain(reusing(database, store))
    first = finish(database, store, Jobs(database).create(new)[0].id)
    age_rows(database, 31 * DAY)
    second = Jobs(database).create(new)[0]
    assert expire_jobs(database, store, 30, utc_now()) == 1
    key = f"results/{first.id}/1/repaired.ply"
    assert key in keys_in(store)
    assert list(Jobs(database).with_files(second.id)[1].values()) == [key]
    with database.read() as session:
        assert unnamed(session, {first.id, "job_unknown"}) == {"job_unknown"}
    delete_job(database, store, second.id)
    assert key not in keys_in(store)


def test_the_bytes_of_a_result_are_counted_once_as_long_as_a_job_names_it(
    database: Database, store: ObjectStore
) -> None:
    new = plain(reusing(database, store))
    first = finish(database, store, Jobs(database).create(new)[0].id)
    others = [Jobs(database).create(new)[0] for _ in range(2)]

    def counted() -> dict[str, int]:
        with database.read() as session:
            return {row.id: row.result_bytes for row in session.scalars(select(JobRow)) if row.result_bytes}

    assert list(counted()) == [first.id]
    n_bytes = counted()[first.id]
    delete_job(database, store, first.id)
    assert counted() == {others[0].id: n_bytes}
    delete_job(database, store, others[0].id)
    assert counted() == {others[1].id: n_bytes}
    delete_job(database, store, others[1].id)
    assert counted() == {}


def test_the_sweep_and_the_scrub_know_whose_files_they_are(database: Database, store: ObjectStore) -> None:
    new = plain(reusing(database, store))
    first = finish(database, store, Jobs(database).create(new)[0].id)
    second = Jobs(database).create(new)[0]
    delete_job(database, store, first.id)
    aging = AgingStore(store)
    aging.wait(2 * DAY)
    age_rows(database, 2 * DAY)
    sweep_objects(database, aging, utc_now())
    assert f"results/{first.id}/1/repaired.ply" in keys_in(store)
    age_rows(database, 40 * DAY)
    counts = Scrub(database, store, ScrubLimits(30, 1e9), lambda _: None).round()
    assert (counts.objects, counts.damaged) == (2, 0)
    assert Jobs(database).get(second.id).state == JobState.SUCCEEDED


def test_a_deletion_at_the_same_moment_leaves_a_whole_result_or_a_job_that_runs(
    database: Database, store: ObjectStore
) -> None:
    new = plain(reusing(database, store))
    for _ in range(5):
        first = finish(database, store, Jobs(database).create(replace(new, may_reuse=False))[0].id)
        threads = [threading.Thread(target=delete_job, args=(database, store, first.id))]
        made: list[str] = []
        threads.append(threading.Thread(target=lambda: made.append(Jobs(database).create(new)[0].id)))  # noqa: B023
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(GUARD_S)
        job, keys = Jobs(database).with_files(made[0])
        if job.state == JobState.SUCCEEDED:
            assert set(keys.values()) <= keys_in(store)
        with database.write() as session:
            others = list(session.scalars(select(JobRow.id).where(JobRow.state == JobState.QUEUED.value)))
        for job_id in others:
            Jobs(database).request_cancel(job_id)
        delete_job(database, store, job.id)
