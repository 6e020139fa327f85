"""Results that equal jobs take over: the same meshes, options and model, by the same version of the software.

A job that takes a result over names its files where they lie (`cached_from`), so nothing is copied. They stay in the
store until no row names them (`jobkit/retention.py`). The source is locked while its result is taken over: it can't be
deleted at that moment.
"""

from datetime import datetime, timedelta

from sqlalchemy import or_, select
from sqlalchemy.orm import Session

from jobkit.database.tables import DamagedRow, JobRow
from jobkit.jobs.transitions import Transition, make_transition
from jobkit.storage.result_files import file_keys
from jobkit.version import VERSION
from quadpatch_client.schema import JobState

_WITH_RESULT = tuple(state.value for state in JobState if state.has_result)
# Sources that are tried: the files of the latest one may be damaged.
_MOST_SOURCES = 3


def reuse_result(session: Session, row: JobRow, now: datetime, retention_days: float = 0) -> bool:
    """End a queued job with the result of an equal one; return whether there is one.

    Parameters
    ----------
    session : Session
        One that writes.
    row : JobRow
    now : datetime
    retention_days : float
        Results of jobs that ended longer ago, and are not pinned, are left alone; 0: none are.
    """
    source = source_of(session, row, now, retention_days)
    if source is None:
        return False
    made_by, number = source.cached_from or source.id, source.cached_attempt or source.attempt
    values = {"result": source.result, "percent": 100.0, "cached_from": made_by, "cached_attempt": number}
    step = Transition(JobState.QUEUED, JobState(source.state), "succeeded", values, {"cached_from": made_by})
    return make_transition(session, row.id, step, now, JobRow.attempt == row.attempt)


def source_of(
    session: Session, row: JobRow, now: datetime, retention_days: float = 0, *, is_locked: bool = True
) -> JobRow | None:
    """Return the latest job with the result that `row` would make, locked unless asked not to; None: there is none."""
    if row.fingerprint is None:
        return None
    query = select(JobRow).where(
        JobRow.fingerprint == row.fingerprint,
        JobRow.tenant == row.tenant,
        JobRow.state.in_(_WITH_RESULT),
        JobRow.result["version"].as_string() == VERSION,
    )
    if retention_days:
        query = query.where(or_(JobRow.pinned, JobRow.finished_at > now - timedelta(days=retention_days)))
    query = query.order_by(JobRow.finished_at.desc()).limit(_MOST_SOURCES)
    sources = session.scalars(query.with_for_update(read=True) if is_locked else query)
    return next((source for source in sources if _is_whole(session, source)), None)


def _is_whole(session: Session, source: JobRow) -> bool:
    """Tell whether a job has every file that it was asked for, none of them known to be damaged."""
    roles = {file["role"] for file in (source.result or {}).get("files", [])}
    output = source.spec.get("output") or {}
    asked = {name for name in ("preview", "closeups", "html_report") if output.get(name)}
    keys = file_keys(source)
    if not keys or not asked <= roles:
        return False
    return session.scalars(select(DamagedRow.key).where(DamagedRow.key.in_(keys)).limit(1)).first() is None
