"""Database: sessions that read, sessions that write, and migrations at start.

On SQLite a transaction that reads first and writes later fails at once when another one wrote in between, without
waiting for the busy timeout. So a writing session takes the write lock at its beginning (BEGIN IMMEDIATE). Threads of
one process take turns; between processes the rest is left to the timeout.

On PostgreSQL writing sessions run side by side (READ COMMITTED): every statement sees what has been committed until
then, and an UPDATE that waited for a row looks at its conditions again. So what was read before is stated once more in
the WHERE of the UPDATE, or the row is locked while it is read (`with_for_update`, which SQLite leaves out).
"""

import copy
import fcntl
import json
import re
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import Any, Self

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from sqlalchemy import Connection, Engine, create_engine, event, text
from sqlalchemy.engine import make_url
from sqlalchemy.exc import DBAPIError, IntegrityError, InterfaceError, OperationalError, SQLAlchemyError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError
from sqlalchemy.orm import Session

from jobkit.database.tenancy import TenantSession
from jobkit.database.write_queue import BUSY_TIMEOUT_MS, WriteQueue
from jobkit.errors import DatabaseError, DatabaseUnavailableError, RowConflictError, SettingsError
from quadpatch_client.schema import Quotas
from quadpatch_rules.text import encodable

# Any number, the same for all processes of this project.
_MIGRATION_LOCK = 0x51554144
_SUPPORTED = ("sqlite", "postgresql")
# PostgreSQL sorts two outages under internal errors: a standby that takes no writes, a transaction idle for too long.
_OUTAGES = ("25006", "25P03")
# How JSON writes half of a surrogate pair, and characters beyond the first 65,536, which are pairs of them.
_SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")
# More threads than connections wait for each other here, which is cheaper than in the server.
_POOL = {"pool_pre_ping": True, "pool_size": 10, "max_overflow": 10, "pool_timeout": 10.0}
_POSTGRES_PARAMETERS = {
    "connect_timeout": "5",
    # A host that disappears without closing its connections is noticed after some 20 s, not after two hours.
    "keepalives_idle": "10",
    "keepalives_interval": "3",
    "keepalives_count": "3",
    "tcp_user_timeout": "20000",
    "application_name": "quadpatch",
    # In milliseconds. No statement here takes a second; a process that hangs must not hold its locks.
    "options": "-c statement_timeout=30000 -c lock_timeout=20000 -c idle_in_transaction_session_timeout=30000",
}


class Database:
    """One database, shared by all threads of a process.

    Its sessions raise DatabaseUnavailableError in an outage, and DatabaseError or RowConflictError where a statement is
    refused, in place of the errors of SQLAlchemy.

    Parameters
    ----------
    url : str
        SQLAlchemy URL of SQLite (a file) or PostgreSQL. Parameters of the connection in its query go before ours.
    """

    def __init__(self, url: str) -> None:
        self._engine = _make_engine(url)
        self._reader = self._engine
        self._writer = self._engine.execution_options(quadpatch_write=True)
        self._write_queue: AbstractContextManager[object] = nullcontext()
        self._tenant: str | None = None
        self._quotas: Quotas | None = None
        if self._engine.dialect.name == "sqlite":
            self._write_queue = WriteQueue()
        if self._engine.dialect.name == "postgresql":
            self._reader = self._engine.execution_options(isolation_level="REPEATABLE READ", postgresql_readonly=True)
            self._writer = self._engine.execution_options(isolation_level="READ COMMITTED")

    @property
    def engine(self) -> Engine:
        """The engine, for migrations and tests."""
        return self._engine

    @property
    def tenant(self) -> str | None:
        """Whose rows its sessions see; None: all."""
        return self._tenant

    def of(self, tenant: str) -> Self:
        """Return the same database, as one tenant sees it."""
        view = copy.copy(self)
        view._tenant = tenant
        return view

    def limited(self, quotas: Quotas) -> Self:
        """Return the same database, with quotas for all tenants for which no others were set."""
        view = copy.copy(self)
        view._quotas = quotas
        return view

    @contextmanager
    def read(self) -> Iterator[Session]:
        """Open a session that sees one snapshot and writes nothing."""
        with _translated(), self._session(self._reader) as session:
            yield session

    @contextmanager
    def write(self) -> Iterator[Session]:
        """Open a session that commits at its end, or rolls back when an error leaves it."""
        with (
            self._write_queue,
            _translated(),
            self._session(self._writer) as session,
            session.begin(),
        ):
            yield session

    def _session(self, engine: Engine) -> TenantSession:
        return TenantSession(engine, expire_on_commit=False, info={"tenant": self._tenant, "quotas": self._quotas})

    def ping(self) -> None:
        """Raise DatabaseUnavailableError if the database does not answer."""
        with _translated(), self._engine.connect() as connection:
            connection.execute(text("SELECT 1"))

    def migrate(self, revision: str = "head") -> None:
        """Bring the tables to a revision, the latest by default; safe when several processes start at once."""
        with _translated():
            if self._engine.dialect.name == "sqlite":
                self._migrate_sqlite(revision)
            else:
                self._migrate_postgresql(revision)

    def close(self) -> None:
        """Close all connections, those of sessions that a thread still has when these end."""
        pool = self._engine.pool
        self._engine.dispose()
        # A pool that is disposed of keeps what comes back to it, open, for the garbage collector to complain about. The
        # engine has a new one by now.
        event.listen(pool, "checkin", _close_returned)

    def _migrate_postgresql(self, revision: str) -> None:
        with self._engine.begin() as connection:
            # Large tables take long, and so does a migration in another process.
            connection.execute(text("SET LOCAL statement_timeout = 0"))
            connection.execute(text("SET LOCAL lock_timeout = 0"))
            connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": _MIGRATION_LOCK})
            _move_tables(connection, revision)

    def _migrate_sqlite(self, revision: str) -> None:
        path = Path(str(self._engine.url.database))
        with path.with_name(path.name + ".lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            # The file remembers its journal mode; to change it needs exclusive access, so not on every connect.
            with self._writer.connect() as connection:
                cursor = connection.connection.cursor()
                cursor.execute("PRAGMA journal_mode = WAL")
                # Some changes make a table anew; with keys held, the old one could not be dropped.
                cursor.execute("PRAGMA foreign_keys = OFF")
                try:
                    with connection.begin():
                        _move_tables(connection, revision)
                finally:
                    cursor.execute("PRAGMA foreign_keys = ON")
                    cursor.close()


def write_json(value: Any) -> str:
    """Write the value of a JSON column."""
    text = json.dumps(value)
    return json.dumps(encodable(value)) if _SURROGATE.search(text) else text


def read_json_column(text: str | bytes) -> Any:
    """Read the value of a JSON column. Rows of earlier versions may hold what has no encoding: it is replaced."""
    text = text.decode() if isinstance(text, bytes) else text
    value = json.loads(text)
    return encodable(value) if _SURROGATE.search(text) else value


_JSON = {"json_serializer": write_json, "json_deserializer": read_json_column}


def migration_config() -> Config:
    """Return Alembic's configuration without a file."""
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parents[1] / "migrations"))
    return config


@contextmanager
def _translated() -> Iterator[None]:
    try:
        yield
    except SQLAlchemyError as error:
        raise _translation(error) from error


def _translation(error: SQLAlchemyError) -> Exception:
    if isinstance(error, PoolTimeoutError):
        return DatabaseUnavailableError("all connections to the database are busy")
    if isinstance(error, DBAPIError) and _is_outage(error):
        # The driver's text may name hosts and users, so it stays in the log.
        return DatabaseUnavailableError("the database does not answer")
    if isinstance(error, IntegrityError):
        return RowConflictError("a constraint of the database refuses a row")
    return DatabaseError("the database refuses a statement")


def _is_outage(error: DBAPIError) -> bool:
    if isinstance(error, OperationalError | InterfaceError) or error.connection_invalidated:
        return True
    return getattr(error.orig, "sqlstate", None) in _OUTAGES


def _move_tables(connection: Connection, revision: str) -> None:
    config = migration_config()
    config.attributes["connection"] = connection
    current = MigrationContext.configure(connection).get_current_revision() or ""
    # Revisions are numbers of four digits, so they sort as text, and `head` comes after all of them.
    move = command.downgrade if revision < current else command.upgrade
    move(config, revision)


def _make_engine(url: str) -> Engine:
    parsed = make_url(url)
    if parsed.drivername in ("postgres", "postgresql"):
        parsed = parsed.set(drivername="postgresql+psycopg")
    if parsed.get_backend_name() not in _SUPPORTED:
        raise SettingsError(f"database {parsed.get_backend_name()!r} is not supported; use {' or '.join(_SUPPORTED)}")
    if parsed.get_backend_name() != "sqlite":
        return create_engine(parsed.set(query={**_POSTGRES_PARAMETERS, **parsed.query}), **_POOL, **_JSON)
    if not parsed.database or parsed.database == ":memory:":
        raise SettingsError("SQLite needs a file: processes can't share a database in memory")
    Path(parsed.database).parent.mkdir(parents=True, exist_ok=True)
    engine = create_engine(parsed, **_JSON)
    event.listen(engine, "connect", _set_up_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _close_returned(connection: Any, _record: object) -> None:
    if connection is not None:
        connection.close()


def _set_up_sqlite(connection: Any, _record: object) -> None:
    # The driver's own BEGIN comes too late and never IMMEDIATE; _begin_sqlite does it.
    connection.isolation_level = None
    cursor = connection.cursor()
    cursor.execute(f"PRAGMA busy_timeout = {BUSY_TIMEOUT_MS}")
    cursor.execute("PRAGMA foreign_keys = ON")
    # A job that was accepted must survive a power failure: every commit reaches the disk.
    cursor.execute("PRAGMA synchronous = FULL")
    cursor.close()


def _begin_sqlite(connection: Connection) -> None:
    writes = connection.get_execution_options().get("quadpatch_write", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
