"""Quotas of tenants under races, on either database: `jobkit/database/quotas.py`, `jobkit/access/stream_leases.py`."""

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from functools import partial
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import update

from jobkit.access.stream_leases import StreamLeases
from jobkit.access.tenants import Tenants
from jobkit.database.access_tables import StreamRow, TenantRow
from jobkit.database.clock import utc_now
from jobkit.database.idempotency import Idempotency
from jobkit.database.quotas import check_bytes, effective_quotas
from jobkit.database.session import Database
from jobkit.database.tables import JobRow
from jobkit.errors import (
    IdempotencyError,
    JobQuotaError,
    QuotaError,
    StorageQuotaError,
    StreamQuotaError,
    TenantBusyError,
)
from jobkit.jobs.admission import Admission, AdmissionRules
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.memory_needs import MemoryNeeds
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.reservations import Machine, MachineMemory
from jobkit.jobs.turns import busy_tenants
from jobkit.meshes import Meshes
from jobkit.retention import delete_job, delete_mesh
from jobkit.storage.base import ObjectStore, StoredObject
from jobkit.uploads.uploads import NewUpload, Uploads
from quadpatch_client.schema import JobSpec, Quotas, ResolvedModel, TenantChanges, UploadKind
from tests.jobkit.fixtures import finish
from tests.waiting import GUARD_S

TENANT, OTHER = "plant-north", "plant-south"


@pytest.fixture
def database(any_database: Database) -> Database:
    return any_database


def at_once(calls: list[Callable[[], Any]]) -> list[Any]:
    """Make all calls in the same moment; gives what they return, or the refusal."""
    barrier = threading.Barrier(len(calls))

    def run(call: Callable[[], Any]) -> Any:
        barrier.wait(GUARD_S)
        try:
            return call()
        except QuotaError as error:
            return error

    with ThreadPoolExecutor(len(calls)) as pool:
        return list(pool.map(run, calls))


def refusals(answers: list[Any]) -> list[QuotaError]:
    return [answer for answer in answers if isinstance(answer, QuotaError)]


def limited(database: Database, tenant: str = TENANT, **quotas: int) -> Database:
    Tenants(database).change(tenant, TenantChanges.model_validate(quotas))
    return database.of(tenant)


def add_mesh(database: Database, number: int, size: int = 100) -> str:
    sha256 = f"{number:064x}"
    return Meshes(database).add(StoredObject(f"meshes/{number:02x}/{sha256}", size, sha256), "a.ply", "ply")[0].id


def new_job(mesh_id: str) -> NewJob:
    return NewJob(JobSpec(mesh_id=mesh_id), ResolvedModel(requested="self", kind="self"), max_attempts=3)


def used(database: Database, tenant: str = TENANT) -> int:
    return Tenants(database).usage(tenant)[1].stored_bytes


def test_of_many_jobs_at_once_as_many_are_accepted_as_may_wait(database: Database) -> None:
    own = limited(database, jobs_waiting=5)
    mesh_id = add_mesh(own, 1)
    answers = at_once([lambda: Jobs(own).create(new_job(mesh_id)) for _ in range(12)])
    errors = refusals(answers)
    assert len(errors) == 7
    assert all(isinstance(error, JobQuotaError) and (error.limit, error.used) == (5, 5) for error in errors)
    assert Tenants(database).usage(TENANT)[1].jobs_waiting == 5
    other = limited(database, OTHER)
    Jobs(other).create(new_job(add_mesh(other, 1)))


def test_of_many_files_at_once_as_many_are_stored_as_fit(database: Database) -> None:
    own = limited(database, stored_bytes=450)
    uploads = Uploads(own, hours=1, most=100, max_bytes=10_000)
    calls: list[Callable[[], Any]] = [partial(add_mesh, own, i) for i in range(6)]
    calls += [lambda: uploads.create(NewUpload(UploadKind.WHOLE, 100), None) for _ in range(6)]
    errors = refusals(at_once(calls))
    assert len(errors) == 8
    assert all(isinstance(error, StorageQuotaError) and (error.limit, error.used) == (450, 400) for error in errors)
    assert used(database) == 400


def test_of_many_jobs_that_start_at_once_as_many_run_as_may(database: Database) -> None:
    own = limited(database, jobs_at_once=2)
    mesh_id = add_mesh(own, 1)
    ids = [Jobs(own).create(new_job(mesh_id))[0].id for _ in range(6)]
    answers = at_once([partial(Attempts(database).start, ids[i], f"w{i}", 60.0) for i in range(6)])
    assert len(refusals(answers)) == 4
    assert all(isinstance(error, TenantBusyError) for error in refusals(answers))
    assert Tenants(database).usage(TENANT)[1].jobs_at_work == 2
    with database.read() as session:
        assert busy_tenants(session) == [TENANT]


def test_a_tenant_that_runs_what_it_may_holds_up_no_other_one(database: Database, store: ObjectStore) -> None:
    own, other = limited(database, jobs_at_once=1), limited(database, OTHER)
    ids = [Jobs(own).create(new_job(add_mesh(own, 1)))[0].id for _ in range(3)]
    later = Jobs(other).create(new_job(add_mesh(other, 1)))[0].id
    machine = Machine("m", lambda: MachineMemory(1 << 20, 1 << 20))
    admission = Admission(database, MemoryNeeds(database), "w", machine, AdmissionRules(4096, 60.0))
    attempts = Attempts(database)
    first = attempts.start_next(ids[0], "w", 60.0, admission).attempt
    assert first.job_id == ids[0]
    # The entry of the queue is that of the tenant that has to wait.
    assert attempts.start_next(ids[1], "w", 60.0, admission).attempt.job_id == later
    with pytest.raises(TenantBusyError):
        attempts.start_next(ids[1], "w", 60.0, admission)
    assert Jobs(own).get(ids[1]).attempt == 0
    Jobs(own).request_cancel(ids[0])
    attempts.acknowledge_cancel(first)
    assert attempts.start_next(ids[2], "w", 60.0, admission).attempt.job_id == ids[1]


def test_a_job_that_waits_for_memory_holds_none_for_a_tenant_that_may_run_no_other(database: Database) -> None:
    own, other = limited(database, jobs_at_once=1), limited(database, OTHER)
    ids = [Jobs(own).create(new_job(add_mesh(own, 1)))[0].id for _ in range(2)]
    later = Jobs(other).create(new_job(add_mesh(other, 1)))[0].id
    memory = [MachineMemory(8192, 8192)]
    machine = Machine("m", lambda: memory[0])
    admission = Admission(database, MemoryNeeds(database), "w", machine, AdmissionRules(4096, 0.0))
    attempts = Attempts(database)
    attempts.start(ids[0], "w", 60.0, admission)
    with database.write() as session:
        waiting = {"memory_wait_since": JobRow.queued_at, "memory_wait_at": "m", "needed_memory_mb": 8192}
        session.execute(update(JobRow).where(JobRow.id == ids[1]).values(waiting))
    assert admission.fitting() == []
    second = Admission(database, MemoryNeeds(database), "w2", machine, AdmissionRules(4096, 0.0))
    assert attempts.start(later, "w2", 60.0, second).attempt.job_id == later


def test_of_many_streams_at_once_as_many_open_as_may(database: Database) -> None:
    limited(database, streams=3)
    processes = [StreamLeases(database), StreamLeases(database)]
    answers = at_once([partial(processes[i % 2].take, TENANT) for i in range(8)])
    leases = [answer for answer in answers if isinstance(answer, str)]
    assert (len(leases), len(refusals(answers))) == (3, 5)
    processes[0].give_back(leases[0])
    assert processes[1].take(TENANT) is not None
    with pytest.raises(StreamQuotaError):
        processes[0].take(TENANT)
    assert processes[0].take(OTHER) is None


def test_streams_of_a_killed_process_count_until_their_lease_is_over(database: Database) -> None:
    limited(database, streams=1)
    killed, alive = StreamLeases(database), StreamLeases(database)
    killed.take(TENANT)
    with database.write() as session:
        session.execute(update(StreamRow).values(until=utc_now() - timedelta(hours=1)))
    killed.renew()
    with pytest.raises(StreamQuotaError):
        alive.take(TENANT)
    with database.write() as session:
        session.execute(update(StreamRow).values(until=utc_now() - timedelta(hours=1)))
    assert alive.take(TENANT) is not None


def test_what_is_deleted_is_counted_no_more_and_results_are(database: Database, store: ObjectStore) -> None:
    own = limited(database, stored_bytes=1000)
    mesh_id = add_mesh(own, 1, 900)
    job_id = Jobs(own).create(new_job(mesh_id))[0].id
    finish(database, store, job_id)
    assert used(database) == 900 + len(b"repaired")
    with pytest.raises(StorageQuotaError):
        add_mesh(own, 2, 93)
    add_mesh(own, 2, 92)
    with own.read() as session, pytest.raises(StorageQuotaError) as caught:
        check_bytes(session, 1)
    assert (caught.value.limit, caught.value.used) == (1000, 1000)
    delete_job(own, store, job_id)
    delete_mesh(own, mesh_id)
    assert used(database) == 92


def test_an_upload_counts_as_large_as_it_is_to_be_and_its_mesh_once(database: Database) -> None:
    own = limited(database, stored_bytes=100)
    uploads = Uploads(own, hours=1, most=100, max_bytes=10_000)
    upload, _ = uploads.create(NewUpload(UploadKind.WHOLE, 100), None)
    assert used(database) == 100
    stored = StoredObject("meshes/aa/x", 100, "a" * 64)
    mesh, _ = Meshes(own).add(stored, "a.ply", "ply", is_counted=True)
    uploads.complete(upload.id, mesh.id)
    assert used(database) == 100
    uploads.delete(upload.id)
    assert used(database) == 100


@given(default=st.integers(0, 3), own=st.none() | st.integers(0, 3), tenant=st.sampled_from(["default", TENANT]))
def test_what_was_set_goes_before_the_default_and_the_operator_has_none(
    default: int, own: int | None, tenant: str
) -> None:
    session: Any = SimpleNamespace(info={"quotas": Quotas(jobs_waiting=default)})
    row = TenantRow(name=tenant, jobs_waiting=own)
    inherited = 0 if tenant == "default" else default
    assert effective_quotas(session, tenant, row).jobs_waiting == (inherited if own is None else own)
    assert effective_quotas(session, tenant, None).jobs_waiting == inherited


def test_deletions_and_additions_of_one_tenant_at_once_all_come_through(database: Database) -> None:
    own = limited(database, stored_bytes=100_000, jobs_waiting=1000)
    ids = [add_mesh(own, i) for i in range(8)]
    mesh_id = add_mesh(own, 99)
    calls: list[Callable[[], Any]] = [partial(delete_mesh, own, ids[i]) for i in range(8)]
    calls += [lambda: Jobs(own).create(new_job(mesh_id)) for _ in range(8)]
    calls += [partial(add_mesh, own, 100 + i) for i in range(8)]
    assert refusals(at_once(calls)) == []
    assert used(database) == 900


def test_one_idempotency_key_for_a_job_and_an_upload_at_once_makes_one_of_them(database: Database) -> None:
    """Both write the key and lock their tenant: in one order, or each would wait for what the other holds."""
    own = limited(database, stored_bytes=10**9, jobs_waiting=1000)
    mesh_id, uploads = add_mesh(own, 1), Uploads(own, 24, 1000, 1 << 20)

    def refused(call: Callable[[], Any]) -> bool:
        try:
            call()
        except IdempotencyError:
            return True
        return False

    for i in range(8):
        of_job, of_upload = (Idempotency("key_a", f"order-{i}", digest * 64) for digest in "12")
        job = partial(Jobs(own).create, new_job(mesh_id), of_job)
        upload = partial(uploads.create, NewUpload(UploadKind.WHOLE, 100), of_upload)
        assert sorted(at_once([partial(refused, job), partial(refused, upload)])) == [False, True]
