"""Quotas of tenants: how much each may store, how many jobs may wait and run, how many streams may be open.

What a request adds is written first. Then the row of the tenant is locked, last of all locks, so that no two
transactions wait for each other in a circle, and what the tenant has is counted. Requests of one tenant therefore pass
here one after the other, whatever process answers them, and one that is over the quota is rolled back. Each count is of
rows that are there, read from an index: there is no sum of its own that could come apart from them.

A session that is opened for no tenant, as those of workers and of the dispatcher are, stores and submits without limit.
"""

from sqlalchemy import ColumnElement, func, select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import InstrumentedAttribute, Session

from jobkit.database.access_tables import StreamRow, TenantRow
from jobkit.database.clock import shared_now, utc_now
from jobkit.database.tables import JobRow, MeshRow, ModelRow
from jobkit.database.tenancy import DEFAULT_TENANT, tenant_of
from jobkit.database.upload_tables import UploadRow
from jobkit.database.view_tables import ViewRow
from jobkit.errors import JobQuotaError, StorageQuotaError, TenantBusyError
from jobkit.settings import Settings
from quadpatch_client.schema import JobState, Quotas, UploadKind, UploadState, Usage

NO_QUOTAS = Quotas()
_AT_WORK = (JobState.RUNNING.value, JobState.CANCELING.value)


def default_quotas(settings: Settings) -> Quotas:
    """Return what holds for tenants for which nothing else was set."""
    return Quotas(
        stored_bytes=settings.tenant_stored_mb << 20,
        jobs_waiting=settings.tenant_jobs_waiting,
        jobs_at_once=settings.tenant_jobs_at_once,
        streams=settings.tenant_streams,
        requests_per_minute=settings.tenant_requests_per_minute,
    )


def quotas_of(session: Session, tenant: str) -> Quotas:
    """Return what holds for a tenant."""
    return effective_quotas(session, tenant, session.get(TenantRow, tenant))


def effective_quotas(session: Session, tenant: str, row: TenantRow | None) -> Quotas:
    """Return what was set for a tenant, and defaults for the rest; the operator has no defaults."""
    defaults: Quotas = NO_QUOTAS if tenant == DEFAULT_TENANT else session.info.get("quotas") or NO_QUOTAS
    return defaults.model_copy(update={} if row is None else own_quotas(row))


def own_quotas(row: TenantRow) -> dict[str, int]:
    """Return what was set for a tenant."""
    values = {name: getattr(row, name) for name in Quotas.model_fields}
    return {name: value for name, value in values.items() if value is not None}


def note_tenant(session: Session, tenant: str) -> None:
    """Write a tenant down, unless it is."""
    insert = sqlite.insert if session.get_bind().dialect.name == "sqlite" else postgresql.insert
    values = {"name": tenant, "disabled": False, "created_at": utc_now()}
    session.execute(insert(TenantRow).values(values).on_conflict_do_nothing())


def locked_quotas(session: Session, tenant: str) -> Quotas:
    """Hold the row of a tenant until the session ends, and return what holds for it; the last lock to be taken."""
    query = select(TenantRow).where(TenantRow.name == tenant).with_for_update()
    query = query.execution_options(populate_existing=True)
    row = session.scalars(query).one_or_none()
    if row is None:
        note_tenant(session, tenant)
        row = session.scalars(query).one()
    return effective_quotas(session, tenant, row)


def admit_jobs(session: Session, n_new: int = 1) -> None:
    """Let jobs of the session's tenant that were just written wait for a worker; raise JobQuotaError."""
    tenant = tenant_of(session)
    if tenant is None or not quotas_of(session, tenant).jobs_waiting:
        return
    limit = locked_quotas(session, tenant).jobs_waiting
    n_before = _n_waiting(session, tenant, limit + n_new) - n_new
    if 0 < limit < n_before + n_new:
        raise JobQuotaError(f"{n_before} jobs of tenant {tenant} wait; the limit is {limit}", limit, n_before)


def admit_bytes(session: Session, n_bytes: int) -> None:
    """Let the session's tenant store a file of that size, whose row was just written; raise StorageQuotaError."""
    tenant = tenant_of(session)
    if tenant is None or not quotas_of(session, tenant).stored_bytes:
        return
    limit = locked_quotas(session, tenant).stored_bytes
    used = stored_bytes(session, tenant)
    if 0 < limit < used:
        raise _storage_error(tenant, limit, used - n_bytes, n_bytes)


def check_bytes(session: Session, n_bytes: int) -> None:
    """Raise StorageQuotaError where a file of that size would not be admitted now: before it is sent in vain."""
    tenant = tenant_of(session)
    limit = 0 if tenant is None else quotas_of(session, tenant).stored_bytes
    if tenant is not None and limit and (used := stored_bytes(session, tenant)) + n_bytes > limit:
        raise _storage_error(tenant, limit, used, n_bytes)


def admit_attempt(session: Session, tenant: str) -> None:
    """Let a job of a tenant that was just started run; raise TenantBusyError where more would run than may."""
    if not quotas_of(session, tenant).jobs_at_once:
        return
    limit = locked_quotas(session, tenant).jobs_at_once
    n_before = _count(session, JobRow.tenant == tenant, JobRow.state.in_(_AT_WORK)) - 1
    if 0 < limit <= n_before:
        raise TenantBusyError(f"{n_before} jobs of tenant {tenant} run; the limit is {limit}", limit, n_before)


def check_places(session: Session, tenant: str) -> None:
    """Raise TenantBusyError where no job of a tenant would be admitted now: before more is written in vain."""
    if free_places(session).get(tenant) == 0:
        raise TenantBusyError(f"tenant {tenant} runs as many jobs as it may")


def free_places(session: Session) -> dict[str, int]:
    """Return how many more jobs of each tenant may run, of those whose jobs at once have a limit and that run any."""
    rows = session.execute(select(TenantRow.name, TenantRow.jobs_at_once).where(TenantRow.jobs_at_once.is_not(None)))
    own: dict[str, int] = {row.name: row.jobs_at_once for row in rows}
    default = (session.info.get("quotas") or NO_QUOTAS).jobs_at_once
    if not default and not any(own.values()):
        return {}
    at_work = select(JobRow.tenant, func.count().label("n")).where(JobRow.state.in_(_AT_WORK)).group_by(JobRow.tenant)
    limits = [
        (row, own.get(row.tenant, 0 if row.tenant == DEFAULT_TENANT else default)) for row in session.execute(at_work)
    ]
    return {row.tenant: max(limit - row.n, 0) for row, limit in limits if limit}


def usage_of(session: Session, tenant: str) -> Usage:
    """Count what a tenant has."""
    is_open = (StreamRow.tenant == tenant) & (StreamRow.until > shared_now(session))
    return Usage(
        stored_bytes=stored_bytes(session, tenant),
        jobs_waiting=_count(session, JobRow.tenant == tenant, JobRow.state == JobState.QUEUED.value),
        jobs_at_work=_count(session, JobRow.tenant == tenant, JobRow.state.in_(_AT_WORK)),
        streams=session.scalar(select(func.count()).select_from(StreamRow).where(is_open)) or 0,
    )


def stored_bytes(session: Session, tenant: str) -> int:
    """Add up the bytes of a tenant: meshes, results, models, views, and uploads as large as they are to be."""
    is_open = (UploadRow.state == UploadState.OPEN.value) | (UploadRow.kind == UploadKind.PARTIAL.value)
    return (
        _sum(session, MeshRow.size_bytes, MeshRow.tenant == tenant)
        + _sum(session, JobRow.result_bytes, JobRow.tenant == tenant, JobRow.result_bytes > 0)
        + _sum(session, ModelRow.size_bytes, ModelRow.tenant == tenant)
        + _sum(session, ViewRow.size_bytes, ViewRow.tenant == tenant)
        + _sum(session, UploadRow.size_bytes, UploadRow.tenant == tenant, is_open)
    )


def _sum(session: Session, column: InstrumentedAttribute[int], *conditions: ColumnElement[bool]) -> int:
    return int(session.scalar(select(func.coalesce(func.sum(column), 0)).where(*conditions)) or 0)


def _count(session: Session, *conditions: ColumnElement[bool]) -> int:
    return session.scalar(select(func.count()).select_from(JobRow).where(*conditions)) or 0


def _n_waiting(session: Session, tenant: str, most: int) -> int:
    """Count waiting jobs, but no further than one needs to know."""
    is_waiting = (JobRow.tenant == tenant) & (JobRow.state == JobState.QUEUED.value)
    some = select(JobRow.tenant).where(is_waiting).limit(most).subquery()
    return session.scalar(select(func.count()).select_from(some)) or 0


def _storage_error(tenant: str, limit: int, used: int, n_bytes: int) -> StorageQuotaError:
    message = f"tenant {tenant} stores {used} of {limit} bytes; {n_bytes} more do not fit: delete what is not needed"
    return StorageQuotaError(message, limit, used)
