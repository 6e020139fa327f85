"""Database: sessions that read, sessions that write, and migrations at start.

On SQLite a transaction that reads first and writes later fails at once when another one wrote in between, without
waiting for the busy timeout. So a writing session takes the write lock at its beginning (BEGIN IMMEDIATE), and the
rest is left to the timeout.
"""

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from sqlalchemy import Connection, Engine, create_engine, event, text
from sqlalchemy.engine import make_url
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session

from jobkit.errors import DatabaseUnavailableError, SettingsError

BUSY_TIMEOUT_MS = 20_000
# Any number will do, as long as all processes of this project take the same one.
_MIGRATION_LOCK = 0x51554144
_SUPPORTED = ("sqlite", "postgresql")


class Database:
    """One database, shared by all threads of a process.

    Parameters
    ----------
    url : str
        SQLAlchemy URL of SQLite (a file) or PostgreSQL.
    """

    def __init__(self, url: str) -> None:
        self._engine = _make_engine(url)
        self._writer = self._engine.execution_options(quadpatch_write=True)

    @property
    def engine(self) -> Engine:
        """The engine, for migrations and tests."""
        return self._engine

    @contextmanager
    def read(self) -> Iterator[Session]:
        """Open a session that sees one moment and writes nothing."""
        with _translated(), Session(self._engine, expire_on_commit=False) as session:
            yield session

    @contextmanager
    def write(self) -> Iterator[Session]:
        """Open a session that commits at its end, or rolls back when an error leaves it."""
        with _translated(), Session(self._writer, expire_on_commit=False) as session, session.begin():
            yield session

    def ping(self) -> None:
        """Raise DatabaseUnavailableError if the database does not answer."""
        with _translated(), self._engine.connect() as connection:
            connection.execute(text("SELECT 1"))

    def migrate(self) -> None:
        """Bring the tables to the latest revision; safe when several processes start at once."""
        if self._engine.dialect.name == "sqlite":
            self._migrate_sqlite()
        else:
            with self._engine.begin() as connection:
                connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": _MIGRATION_LOCK})
                _upgrade(connection)

    def close(self) -> None:
        """Close all connections."""
        self._engine.dispose()

    def _migrate_sqlite(self) -> None:
        path = Path(str(self._engine.url.database))
        with path.with_name(path.name + ".lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            # The file remembers its journal mode; to change it one must be alone, hence here and not on every connect.
            raw = self._engine.raw_connection()
            try:
                raw.cursor().execute("PRAGMA journal_mode = WAL")
            finally:
                raw.close()
            with self._writer.begin() as connection:
                _upgrade(connection)


def migration_config() -> Config:
    """Return Alembic's configuration without a file."""
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent / "migrations"))
    return config


@contextmanager
def _translated() -> Iterator[None]:
    try:
        yield
    except OperationalError as error:
        # The driver's text may name hosts and users, so it stays in the log.
        raise DatabaseUnavailableError("the database does not answer") from error


def _upgrade(connection: Connection) -> None:
    config = migration_config()
    config.attributes["connection"] = connection
    command.upgrade(config, "head")


def _make_engine(url: str) -> Engine:
    parsed = make_url(url)
    if parsed.get_backend_name() not in _SUPPORTED:
        raise SettingsError(f"database {parsed.get_backend_name()!r} is not supported; use {' or '.join(_SUPPORTED)}")
    if parsed.get_backend_name() != "sqlite":
        return create_engine(parsed, pool_pre_ping=True)
    if not parsed.database or parsed.database == ":memory:":
        raise SettingsError("SQLite needs a file: processes can't share a database in memory")
    Path(parsed.database).parent.mkdir(parents=True, exist_ok=True)
    engine = create_engine(parsed)
    event.listen(engine, "connect", _set_up_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _set_up_sqlite(connection: Any, _record: object) -> None:
    # The driver's own BEGIN comes too late and never IMMEDIATE; _begin_sqlite does it.
    connection.isolation_level = None
    cursor = connection.cursor()
    cursor.execute(f"PRAGMA busy_timeout = {BUSY_TIMEOUT_MS}")
    cursor.execute("PRAGMA foreign_keys = ON")
    # A 202 is a promise, also when the power fails: every commit reaches the disk.
    cursor.execute("PRAGMA synchronous = FULL")
    cursor.close()


def _begin_sqlite(connection: Connection) -> None:
    writes = connection.get_execution_options().get("quadpatch_write", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
