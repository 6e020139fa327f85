"""Counts that only grow, kept in the database: they survive restarts, and the removal of the rows they count."""

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Table, inspect
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from jobkit.database.table_base import Base
from jobkit.database.tables import AttemptCountRow


def count_attempt(session: Session, outcome: str, code: str | None) -> None:
    """Count an attempt that ends in this transaction.

    Parameters
    ----------
    session : Session
    outcome : str
        As in the row of the attempt.
    code : str or None
        Of the error that ended it.
    """
    add_up(session, AttemptCountRow, [{"outcome": outcome, "code": code or "", "count": 1}])


def add_up(session: Session, kind: type[Base], rows: Sequence[Mapping[str, Any]]) -> None:
    """Add rows to those with the same primary key, or insert them.

    Parameters
    ----------
    session : Session
    kind : type of Base
        A table whose other columns are all numbers.
    rows : sequence of mapping
        Values of all columns. Callers of one table name them in one order: two transactions that take the same rows
        in opposite order deadlock.
    """
    table: Table = inspect(kind).local_table  # type: ignore[assignment]
    insert = sqlite.insert if session.get_bind().dialect.name == "sqlite" else postgresql.insert
    statement = insert(table).values(list(rows))
    keys = [column.name for column in table.primary_key]
    sums = {c.name: c + statement.excluded[c.name] for c in table.columns if c.name not in keys}
    session.execute(statement.on_conflict_do_update(index_elements=keys, set_=sums))
