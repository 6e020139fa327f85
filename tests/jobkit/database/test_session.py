"""Also tests `jobkit/migrations/versions/0001_first_tables.py`,
`jobkit/migrations/versions/0002_leases_and_webhooks.py`, `jobkit/migrations/versions/0007_tasks_of_jobs.py`,
`jobkit/migrations/versions/0010_tenants_and_keys.py`, `jobkit/migrations/versions/0013_tenants.py`,
`jobkit/migrations/versions/0014_batches.py` and `jobkit/migrations/versions/0015_callbacks.py`."""

import json
import multiprocessing
import signal
import sqlite3
import threading
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import func, inspect, select, text
from sqlalchemy.exc import DataError

from jobkit.access.tenants import Tenants
from jobkit.database.session import Database
from jobkit.database.table_base import Base
from jobkit.database.tables import JobRow, MeshRow, ModelRow
from jobkit.errors import DatabaseError, DatabaseUnavailableError, RowConflictError, SettingsError
from jobkit.meshes import Meshes
from tests.servers import PostgresServer, fresh_database, running_postgres
from tests.waiting import GUARD_S, let_others_run

NOW = datetime(2026, 11, 22, 10, 0, tzinfo=UTC)


@pytest.fixture
def database(any_database: Database) -> Database:
    return any_database


@pytest.fixture(params=["sqlite", "postgresql"])
def empty_url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """A database without a table, of either kind."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path / 'empty.db'}"
        return
    with fresh_database(request.getfixturevalue("postgres"), "template0") as url:
        yield url


def mesh_row(mesh_id: str) -> MeshRow:
    times = {"created_at": NOW, "updated_at": NOW, "used_at": NOW}
    return MeshRow(id=mesh_id, key="k", size_bytes=0, state="ready", attempt=0, **times)


def differences(database: Database) -> list[object]:
    with database.engine.connect() as connection:
        return list(
            compare_metadata(MigrationContext.configure(connection, opts={"compare_type": True}), Base.metadata)
        )


def test_migrations_lead_to_exactly_the_tables_of_the_models(database: Database) -> None:
    assert differences(database) == []


def test_an_upgrade_keeps_the_rows_and_fills_what_is_new_and_so_does_the_way_back(empty_url: str) -> None:
    database = Database(empty_url)
    database.migrate("0001")
    with database.engine.begin() as connection:
        values = {"now": NOW if database.engine.dialect.name == "postgresql" else "2026-11-22 10:00:00.000000"}
        for statement in ROWS_OF_0001:
            connection.execute(text(statement), values)
    database.migrate()
    assert differences(database) == []
    with database.read() as session:
        job, mesh = session.get_one(JobRow, "job_a"), session.get_one(MeshRow, "m")
    assert (job.queued_at, job.forgiven, job.pinned, job.not_before) == (NOW, 0, False, None)
    assert job.mesh_name == "scan.ply"
    assert (job.task, job.reference_id) == ("fill", None)
    assert (mesh.used_at, mesh.pinned) == (NOW, False)
    assert Meshes(database).calibrations("m") is None
    for revision in ("0001", "head"):
        database.migrate(revision)
        with database.engine.connect() as connection:
            counts = [connection.scalar(text(f"SELECT count(*) FROM {table}")) for table in FULL]
        assert counts == [1, 1, 1, 1, 1]
    database.close()


def test_sums_of_stages_come_through_an_upgrade_and_back(empty_url: str) -> None:
    database = Database(empty_url)
    database.migrate("0006")
    rows = {"fill": ("fill", 2, 5.0), "denoise": ("learn", 1, 9.0)}
    insert = "INSERT INTO stages (stage, method, {more}count, seconds) VALUES ('{0}', 'smooth', {task}{1}, {2})"
    with database.engine.begin() as connection:
        connection.execute(text(insert.format(*rows["fill"], more="", task="")))
    database.migrate()
    with database.engine.begin() as connection:
        connection.execute(text(insert.format(*rows["denoise"], more="task, ", task="'denoise', ")))
        found = connection.execute(text("SELECT task, stage, count, seconds FROM stages ORDER BY seconds")).all()
    assert [tuple(row) for row in found] == [(task, *row) for task, row in rows.items()]
    database.migrate("0006")
    with database.engine.connect() as connection:
        found = connection.execute(text("SELECT stage, count, seconds FROM stages")).all()
    assert [tuple(row) for row in found] == [rows["fill"]]
    database.close()


def test_tenants_that_keys_name_and_sizes_of_results_come_through_an_upgrade(empty_url: str) -> None:
    database = Database(empty_url)
    database.migrate("0001")
    with database.engine.begin() as connection:
        values = {"now": NOW if database.engine.dialect.name == "postgresql" else "2026-11-22 10:00:00.000000"}
        for statement in ROWS_OF_0001:
            connection.execute(text(statement), values)
    database.migrate("0012")
    result = json.dumps({"format": "ply", "files": [{"size_bytes": 1 << 33}, {"size_bytes": 5}]})
    key = "INSERT INTO keys (id, name, scopes, sha256, created_at, tenant) VALUES ('k', 'x', '[]', 's', :now, 'plant')"
    with database.engine.begin() as connection:
        connection.execute(text("UPDATE jobs SET result = :result"), {"result": result})
        connection.execute(text(key), values)
    database.migrate()
    with database.read() as session:
        assert session.get_one(JobRow, "job_a").result_bytes == (1 << 33) + 5
    assert [tenant.name for tenant in Tenants(database).list_all().items] == ["default", "plant"]
    for revision in ("0012", "head"):
        database.migrate(revision)
    assert differences(database) == []
    database.close()


def test_deliveries_know_their_receiver_after_an_upgrade_and_callbacks_go_on_the_way_back(empty_url: str) -> None:
    database = Database(empty_url)
    database.migrate("0012")
    values = {"now": NOW if database.engine.dialect.name == "postgresql" else "2026-11-22 10:00:00.000000"}
    with database.engine.begin() as connection:
        for statement in ROWS_OF_0012:
            connection.execute(text(statement), values)
    database.migrate()
    callback = (
        ROWS_OF_0012[1].replace("(id, webhook_id", "(id, receiver").replace("'msg_a', 'wh_a'", "'msg_b', 'a host'")
    )
    with database.engine.begin() as connection:
        connection.execute(text(callback), values)
    assert deliveries_of(database, "receiver") == [("msg_a", "wh_a"), ("msg_b", "a host")]
    database.migrate("0012")
    assert deliveries_of(database, "webhook_id") == [("msg_a", "wh_a")]
    database.close()


def deliveries_of(database: Database, column: str) -> list[tuple[str, str]]:
    with database.engine.connect() as connection:
        return [tuple(row) for row in connection.execute(text(f"SELECT id, {column} FROM deliveries ORDER BY id"))]


ROWS_OF_0012 = (
    "INSERT INTO webhooks (id, url, secret, events, enabled, created_at, updated_at)"
    " VALUES ('wh_a', 'https://a', 's', '[]', '1', :now, :now)",
    "INSERT INTO deliveries (id, webhook_id, type, payload, state, tries, created_at)"
    " VALUES ('msg_a', 'wh_a', 'job.failed', '{}', 'pending', 0, :now)",
)
FULL = ("meshes", "jobs", "attempts", "events", "idempotency_keys")
ROWS_OF_0001 = (
    "INSERT INTO meshes (id, key, size_bytes, filename, state, attempt, created_at, updated_at)"
    " VALUES ('m', 'k', 1, 'scan.ply', 'ready', 1, :now, :now)",
    "INSERT INTO jobs"
    " (id, mesh_id, state, attempt, max_attempts, revision, percent, spec, model, created_at, updated_at)"
    " VALUES ('job_a', 'm', 'queued', 1, 3, 2, 0, '{}', '{}', :now, :now)",
    "INSERT INTO attempts (job_id, number, worker, started_at) VALUES ('job_a', 1, 'w', :now)",
    "INSERT INTO events (job_id, sequence, type, at, attempt, data) VALUES ('job_a', 1, 'queued', :now, 0, '{}')",
    "INSERT INTO idempotency_keys (principal, key, request_sha256, job_id, created_at)"
    " VALUES ('p', 'k', '0', 'job_a', :now)",
)


def write_while(database: Database, mesh_id: str, act: Callable[[], object], statement: str = "SELECT 1") -> None:
    with database.write() as session:
        session.add(mesh_row(mesh_id))
        session.flush()
        act()
        session.execute(text(statement))


def _migrate(url: str, barrier: "multiprocessing.synchronize.Barrier", outcome: "multiprocessing.Queue[str]") -> None:
    database = Database(url)
    barrier.wait(GUARD_S)
    try:
        database.migrate()
    except Exception as error:  # noqa: BLE001 - the parent reports it
        outcome.put(repr(error))
    else:
        outcome.put("")


@pytest.mark.slow
def test_processes_that_start_at_once_migrate_once(empty_url: str) -> None:
    context = multiprocessing.get_context("spawn")
    barrier, outcome = context.Barrier(3), context.Queue()
    processes = [context.Process(target=_migrate, args=(empty_url, barrier, outcome)) for _ in range(3)]
    for process in processes:
        process.start()
    assert [outcome.get(timeout=GUARD_S) for _ in processes] == ["", "", ""]
    for process in processes:
        process.join(GUARD_S)
    outcome.close()
    outcome.join_thread()
    database = Database(empty_url)
    assert set(inspect(database.engine).get_table_names()) == {*Base.metadata.tables, "alembic_version"}
    database.close()


@pytest.mark.parametrize("any_database", ["sqlite"], indirect=True)
def test_sqlite_writes_ahead_and_holds_foreign_keys(database: Database) -> None:
    database.migrate()
    with database.read() as session:
        assert session.scalar(text("PRAGMA journal_mode")) == "wal"
        assert session.scalar(text("PRAGMA foreign_keys")) == 1
        assert session.scalar(text("PRAGMA synchronous")) == 2


def test_a_job_without_its_mesh_is_refused(database: Database) -> None:
    values = {"state": "queued", "max_attempts": 1, "spec": {}, "model": {}, "created_at": NOW, "updated_at": NOW}
    with pytest.raises(RowConflictError), database.write() as session:
        session.add(JobRow(id="job_x", mesh_id="0" * 64, queued_at=NOW, **values))


def test_writers_that_read_first_wait_for_each_other(database: Database) -> None:
    """A deferred transaction would fail at once on SQLite, and an unlocked row would lose counts on PostgreSQL."""
    with database.write() as session:
        session.add(mesh_row("m"))

    def count_up() -> None:
        for _ in range(20):
            with database.write() as session:
                row = session.get_one(MeshRow, "m", with_for_update=True)
                row.size_bytes += 1

    threads = [threading.Thread(target=count_up) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with database.read() as session:
        assert session.get_one(MeshRow, "m").size_bytes == 80


def test_a_reading_session_sees_one_moment(database: Database) -> None:
    with database.read() as session:
        assert session.scalar(select(func.count()).select_from(MeshRow)) == 0
        with database.write() as other:
            other.add(mesh_row("m"))
        assert session.scalar(select(func.count()).select_from(MeshRow)) == 0
    with database.read() as session:
        assert session.scalar(select(func.count()).select_from(MeshRow)) == 1


def test_moments_keep_their_instant_and_come_back_in_utc(database: Database) -> None:
    moment = datetime(2026, 11, 22, 10, 0, tzinfo=timezone(timedelta(hours=2)))
    facts = {"kind": "dictionary", "format": "onnx", "sha256": "0", "size_bytes": 0, "key": "k", "card": {}}
    with database.write() as session:
        session.add(ModelRow(name="n", version=1, created_at=moment, **facts))
    with database.read() as session:
        back = session.get_one(ModelRow, ("n", 1)).created_at
    assert back == moment
    assert back.tzinfo is UTC


def test_more_threads_than_connections_take_turns(database: Database) -> None:
    n_threads, barrier = 40, threading.Barrier(40)
    seen: list[int] = []

    def ask() -> None:
        barrier.wait(GUARD_S)
        with database.read() as session:
            seen.append(session.scalar(select(1)) or 0)

    threads = [threading.Thread(target=ask) for _ in range(n_threads)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert seen == [1] * n_threads


@pytest.mark.parametrize("url", ["mysql://host/db", "sqlite://", "sqlite:///:memory:"])
def test_a_database_that_processes_cannot_share_is_refused(url: str) -> None:
    with pytest.raises(SettingsError):
        Database(url)


def test_a_database_that_cannot_be_opened_is_unavailable_and_keeps_its_place_secret(tmp_path: Path) -> None:
    database = Database(f"sqlite:///{tmp_path / 'secret-place' / 'quadpatch.db'}")
    (tmp_path / "secret-place").rmdir()
    with pytest.raises(DatabaseUnavailableError) as caught:
        database.ping()
    assert "secret-place" not in str(caught.value)
    database.close()


@pytest.mark.parametrize("scheme", ["postgres", "postgresql", "postgresql+psycopg"])
def test_postgresql_is_found_under_its_usual_schemes(postgres: PostgresServer, scheme: str) -> None:
    database = Database(postgres.url("migrated").replace("postgresql+psycopg", scheme))
    with database.read() as session:
        assert session.scalar(text("SELECT current_database()")) == "migrated"
    database.close()


def test_a_server_that_is_gone_keeps_its_password_secret() -> None:
    database = Database("postgresql://somebody:hunter2@127.0.0.1:1/db")
    for call in (database.ping, database.migrate):
        with pytest.raises(DatabaseUnavailableError) as caught:
            call()
        assert "hunter2" not in str(caught.value)
    database.close()


def test_every_way_to_lose_postgresql_is_an_outage_that_passes() -> None:
    with running_postgres() as server:
        database = Database(server.url("migrated"))
        for how in (signal.SIGINT, signal.SIGKILL):
            with pytest.raises(DatabaseUnavailableError):
                write_while(database, how.name, lambda: server.stop(how))  # noqa: B023 - called at once
            with pytest.raises(DatabaseUnavailableError):
                database.ping()
            server.start()
            with database.write() as session:
                assert session.get(MeshRow, how.name) is None
        database.close()


def test_a_connection_that_an_administrator_ends_is_an_outage_that_passes(postgres: PostgresServer) -> None:
    with fresh_database(postgres) as url:
        database = Database(url)
        with pytest.raises(DatabaseUnavailableError), database.read() as session:
            session.execute(text("SELECT pg_terminate_backend(pg_backend_pid())"))
        database.ping()
        database.close()


@pytest.mark.parametrize("timeout", ["statement_timeout", "idle_in_transaction_session_timeout"])
def test_a_transaction_that_takes_too_long_is_an_outage_that_passes(postgres: PostgresServer, timeout: str) -> None:
    with fresh_database(postgres) as url:
        database = Database(f"{url}?options=-c%20{timeout}%3D50")
        with pytest.raises(DatabaseUnavailableError):
            write_while(database, "m", let_others_run, "SELECT pg_sleep(60)")
        database.ping()
        database.close()


def test_a_standby_that_takes_no_writes_is_an_outage(postgres: PostgresServer) -> None:
    with fresh_database(postgres) as url:
        database = Database(f"{url}?options=-c%20default_transaction_read_only%3Don")
        database.ping()
        with pytest.raises(DatabaseUnavailableError), database.write() as session:
            session.add(mesh_row("m"))
        database.close()


@pytest.mark.parametrize("any_database", ["postgresql"], indirect=True)
def test_a_refused_statement_is_a_fault_and_no_outage(database: Database) -> None:
    with pytest.raises(DatabaseError), database.read() as session:
        session.execute(text("SELECT no_such_column"))
    with pytest.raises(DatabaseError) as caught, database.write() as session:
        session.add(mesh_row("m" * 65))
    assert isinstance(caught.value.__cause__, DataError)


def test_a_missing_row_is_a_fault(database: Database) -> None:
    with pytest.raises(DatabaseError), database.read() as session:
        session.get_one(MeshRow, "m")


def test_a_connection_that_a_thread_still_has_is_closed_when_it_comes_back(any_database: Database) -> None:
    """As when a process of the API ends while a thread reads: a connection that stays open is a leak."""
    with any_database.read() as session:
        session.execute(text("SELECT 1"))
        connection: Any = session.connection().connection.dbapi_connection
        any_database.close()
        session.execute(text("SELECT 1"))
    if any_database.engine.dialect.name == "postgresql":
        assert connection.closed
    else:
        with pytest.raises(sqlite3.ProgrammingError, match="closed database"):
            connection.execute("SELECT 1")
