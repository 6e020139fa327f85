import multiprocessing
import threading
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import create_mock_engine, inspect, text
from sqlalchemy.dialects import postgresql
from sqlalchemy.exc import IntegrityError

from jobkit.database import Database
from jobkit.errors import DatabaseUnavailableError, SettingsError
from jobkit.tables import Base, JobRow, MeshRow, ModelRow


def test_migrations_lead_to_exactly_the_tables_of_the_models(database: Database) -> None:
    with database.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, Base.metadata) == []


def test_tables_can_be_written_for_postgresql() -> None:
    statements: list[str] = []
    dialect = postgresql.dialect()
    engine = create_mock_engine(
        "postgresql+psycopg://", lambda sql, *_: statements.append(str(sql.compile(dialect=dialect)))
    )
    Base.metadata.create_all(engine, checkfirst=False)
    created = "\n".join(statements)
    assert created.count("CREATE TABLE") == len(Base.metadata.tables)
    assert "TIMESTAMP WITH TIME ZONE" in created


def _migrate(url: str, barrier: "multiprocessing.synchronize.Barrier", outcome: "multiprocessing.Queue[str]") -> None:
    database = Database(url)
    barrier.wait(30)
    try:
        database.migrate()
    except Exception as error:  # noqa: BLE001 - the parent reports it
        outcome.put(repr(error))
    else:
        outcome.put("")


def test_processes_that_start_at_once_migrate_once(tmp_path: Path) -> None:
    url = f"sqlite:///{tmp_path / 'shared.db'}"
    context = multiprocessing.get_context("spawn")
    barrier, outcome = context.Barrier(3), context.Queue()
    processes = [context.Process(target=_migrate, args=(url, barrier, outcome)) for _ in range(3)]
    for process in processes:
        process.start()
    assert [outcome.get(timeout=60) for _ in processes] == ["", "", ""]
    for process in processes:
        process.join(30)
    outcome.close()
    outcome.join_thread()
    database = Database(url)
    assert set(inspect(database.engine).get_table_names()) == {*Base.metadata.tables, "alembic_version"}
    database.close()


def test_sqlite_writes_ahead_and_holds_foreign_keys(database: Database) -> None:
    with database.read() as session:
        assert session.scalar(text("PRAGMA journal_mode")) == "wal"
        assert session.scalar(text("PRAGMA foreign_keys")) == 1
        assert session.scalar(text("PRAGMA synchronous")) == 2


def test_a_job_without_its_mesh_is_refused(database: Database) -> None:
    now = datetime.now(UTC)
    values = {"state": "queued", "max_attempts": 1, "spec": {}, "model": {}, "created_at": now, "updated_at": now}
    with pytest.raises(IntegrityError), database.write() as session:
        session.add(JobRow(id="job_x", mesh_id="0" * 64, **values))


def test_writers_that_read_first_wait_for_each_other(database: Database) -> None:
    """A deferred transaction would fail at once here, whatever the busy timeout."""
    now = datetime.now(UTC)
    with database.write() as session:
        session.add(MeshRow(id="m", key="k", size_bytes=0, state="ready", created_at=now, updated_at=now, attempt=0))

    def count_up() -> None:
        for _ in range(20):
            with database.write() as session:
                row = session.get_one(MeshRow, "m")
                row.size_bytes += 1

    threads = [threading.Thread(target=count_up) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with database.read() as session:
        assert session.get_one(MeshRow, "m").size_bytes == 80


def test_moments_keep_their_instant_and_come_back_in_utc(database: Database) -> None:
    moment = datetime(2026, 11, 22, 10, 0, tzinfo=timezone(timedelta(hours=2)))
    with database.write() as session:
        session.add(
            ModelRow(
                name="n",
                version=1,
                kind="dictionary",
                format="onnx",
                sha256="0",
                size_bytes=0,
                key="k",
                card={},
                created_at=moment,
            )
        )
    with database.read() as session:
        back = session.get_one(ModelRow, ("n", 1)).created_at
    assert back == moment
    assert back.tzinfo is UTC


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
