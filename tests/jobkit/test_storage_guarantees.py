"""Database and store together: whatever happens in whatever order, and wherever a process is killed."""

import contextlib
from collections.abc import Callable
from datetime import timedelta

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sqlalchemy import select

from dispatcher.missing_objects import MissingCounts, MissingObjects
from dispatcher.unreferenced_objects import GRACE, sweep_objects
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow
from jobkit.errors import ConflictError, NotFoundError, StaleAttemptError, StoreUnavailableError
from jobkit.jobs.jobs import Jobs
from jobkit.meshes import Meshes, is_missing
from jobkit.retention import delete_job, delete_mesh, expire_jobs, expire_meshes, pin_job, pin_mesh
from jobkit.storage.base import ObjectStore, StoredObject, result_key
from jobkit.storage.removals import assure, named_keys
from quadpatch_client.schema import JobState
from tests.jobkit.fixtures import (
    AgingStore,
    KilledError,
    age_rows,
    clear,
    fail,
    finish,
    keys_in,
    new_job,
    put,
    sha256,
    upload,
)

RETENTION_DAYS = 2.0
# What ends a step without being a fault: the object is missing, or in use.
EXPECTED = (KilledError, NotFoundError, ConflictError, StaleAttemptError, StoreUnavailableError)
STEPS = ("upload", "put", "register", "create", "finish", "fail", "cancel", "pin", "unpin", "delete job", "delete mesh")
TURNS = ("expire", "sweep", "wait", "wait long", "kill before", "kill after")


class World:
    """A database and a store, and all that can be done to them; `which` picks a mesh or a job."""

    def __init__(self, database: Database, store: ObjectStore) -> None:
        self.database = database
        self.store = AgingStore(store)
        self.put: dict[int, StoredObject] = {}
        self.job_ids: list[str] = []
        self.steps: dict[str, Callable[[int], object]] = {
            "upload": lambda which: upload(database, self.store, b"%d" % which),
            "put": lambda which: self.put.update({which: put(self.store, b"%d" % which)}),
            "register": self._register,
            "create": self._create,
            "finish": lambda which: finish(database, self.store, self._job(which)),
            "fail": lambda which: fail(database, self.store, self._job(which)),
            "cancel": lambda which: Jobs(database).request_cancel(self._job(which)),
            "pin": lambda which: self._pin(which, True),
            "unpin": lambda which: self._pin(which, False),
            "delete job": lambda which: delete_job(database, self.store, self._job(which)),
            "delete mesh": lambda which: delete_mesh(database, self._mesh(which)),
            "expire": lambda which: self.expire(),
            "sweep": lambda which: sweep_objects(database, self.store, utc_now()),
            "wait": lambda which: self.wait(timedelta(hours=13)),
            "wait long": lambda which: self.wait(timedelta(hours=50)),
            "kill before": lambda which: self._load(which, False),
            "kill after": lambda which: self._load(which, True),
        }

    def wait(self, by: timedelta) -> None:
        self.store.wait(by)
        age_rows(self.database, by)

    def expire(self) -> None:
        expire_jobs(self.database, self.store, RETENTION_DAYS, utc_now())
        expire_meshes(self.database, RETENTION_DAYS, utc_now())

    def _register(self, which: int) -> None:
        """Go on with an upload that was put into the store some time ago."""
        stored = self.put.pop(which, None)
        if stored is not None:
            assure(self.database, self.store, stored.key, claim_wait_s=0)
            Meshes(self.database).add(stored, "late.ply", "ply")

    def _create(self, which: int) -> None:
        mesh = Meshes(self.database).get(self._mesh(which))
        self.job_ids.append(Jobs(self.database).create(new_job(mesh))[0].id)

    def _pin(self, which: int, is_pinned: bool) -> None:
        pin_mesh(self.database, self._mesh(which), is_pinned)
        pin_job(self.database, self._job(which), is_pinned)

    def _load(self, which: int, kills_after: bool) -> None:
        self.store.kill_countdown, self.store.kills_after = which, kills_after

    def _mesh(self, which: int) -> str:
        return sha256(b"%d" % which)

    def _job(self, which: int) -> str:
        return self.job_ids[which % len(self.job_ids)] if self.job_ids else "job_none"

    def named(self) -> set[str]:
        """Return the keys that rows name."""
        with self.database.read() as session:
            meshes = [row for row in session.scalars(select(MeshRow)) if not is_missing(row)]
            jobs = session.scalars(select(JobRow))
            files = {
                result_key(row.id, row.attempt, file["name"])
                for row in jobs
                for file in (row.result or {}).get("files", [])
            }
            return {row.key for row in meshes} | files

    def kept_by_a_pin(self) -> set[str]:
        with self.database.read() as session:
            jobs = session.scalars(select(JobRow.id).where(JobRow.pinned))
            meshes = session.scalars(select(MeshRow.id).where(MeshRow.pinned))
            return {*jobs, *meshes}

    def old_objects(self) -> set[str]:
        return {found.key for found in self.store.keys("") if found.modified_at < utc_now() - GRACE}


@pytest.mark.slow
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(script=st.lists(st.tuples(st.sampled_from(STEPS + TURNS), st.integers(0, 2)), min_size=3, max_size=40))
def test_no_row_lacks_its_object_and_no_old_object_its_row(
    database: Database, store: ObjectStore, script: list[tuple[str, int]]
) -> None:
    clear(database, store)
    world = World(database, store)
    anchor = upload(database, world.store, b"an old row, so that the database counts as grown up")
    pin_mesh(database, anchor.id, True)
    world.wait(GRACE * 2)
    for name, which in script:
        pinned = world.kept_by_a_pin()
        with contextlib.suppress(*EXPECTED):
            world.steps[name](which)
        assert world.named() <= keys_in(store), name
        if name in ("expire", "sweep"):
            assert pinned <= world.kept_by_a_pin()
    world.store.kill_countdown = None
    world.wait(timedelta(hours=25))
    sweep_objects(database, world.store, utc_now())
    assert MissingObjects(database, world.store).look() == MissingCounts()
    with database.read() as session:
        unnamed = world.old_objects() - world.named() - named_keys(session, keys_in(store))
        at_work = {row.id for row in session.scalars(select(JobRow)) if not JobState(row.state).is_terminal}
    assert {key for key in unnamed if key.split("/")[1] not in at_work} == set()


@settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(script=st.lists(st.tuples(st.sampled_from(STEPS), st.integers(0, 2)), min_size=3, max_size=30))
def test_when_all_has_expired_nothing_is_left_but_what_is_pinned_or_unfinished(
    database: Database, store: ObjectStore, script: list[tuple[str, int]]
) -> None:
    clear(database, store)
    world = World(database, store)
    for name, which in script:
        with contextlib.suppress(*EXPECTED):
            world.steps[name](which)
    anchor = upload(database, world.store, b"keeps the database grown up")
    pin_mesh(database, anchor.id, True)
    world.wait(timedelta(days=4))
    world.expire()
    world.wait(timedelta(days=4))
    world.expire()
    sweep_objects(database, world.store, utc_now())
    with database.read() as session:
        jobs = list(session.scalars(select(JobRow)))
        meshes = list(session.scalars(select(MeshRow)))
    assert all(row.pinned or not JobState(row.state).is_terminal for row in jobs)
    used = {row.mesh_id for row in jobs}
    assert all(row.pinned or row.id in used for row in meshes)
    results = {key for key in keys_in(store) if key.startswith("results/")}
    assert keys_in(store) == {row.key for row in meshes} | results
    assert {key.split("/")[1] for key in results} <= {row.id for row in jobs}
