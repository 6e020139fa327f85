"""Metrics that are read from the tables.

Tested in `tests/service/test_metrics.py`.
"""

from collections.abc import Iterator
from datetime import datetime, timedelta

from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric, SummaryMetricFamily
from sqlalchemy import ColumnElement, func, or_, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from jobkit.database.clock import shared_now
from jobkit.database.session import Database
from jobkit.database.tables import (
    AliasRow,
    AttemptCountRow,
    DamagedRow,
    DeliveryRow,
    JobRow,
    MachineRow,
    MeshRow,
    ModelRow,
    ReservationRow,
    ScrubRow,
    StageRow,
)
from jobkit.jobs.attempts import AT_WORK
from jobkit.jobs.past_jobs import read_past
from jobkit.storage.damage import OBJECT_KINDS
from jobkit.storage.scrub_schedule import oldest_check
from quadpatch_client.schema import TASKS, DeliveryState, JobState, MeshState, ModelState

_MIB = 1 << 20
# They start at 0: the rate of a counter that first appears with 1 is 0.
_EXPECTED_OUTCOMES = (
    (JobState.SUCCEEDED.value, ""),
    (JobState.SUCCEEDED_WITH_WARNINGS.value, ""),
    (JobState.CANCELED.value, ""),
    *((outcome, code) for outcome in ("requeued", "failed") for code in ("worker_lost", "out_of_memory")),
    ("requeued", "worker_drained"),
    ("requeued", "store_unavailable"),
)


def database_figures(database: Database, lease_s: float, scrub_days: float) -> list[Metric]:
    """Read everything in one session.

    Parameters
    ----------
    database : Database
    lease_s : float
        How long leases last, in seconds: the rows hold only when they end.
    scrub_days : float
        Days within which all objects are to be read; 0: never.

    Raises
    ------
    DatabaseUnavailableError
        If it does not answer.
    """
    with database.read() as session:
        now = shared_now(session)
        return [
            *_states(session),
            *_waiting_tasks(session, now),
            *_leases(session, now, lease_s),
            *_totals(session),
            *_models(session),
            *_memory(session, now),
            *_scrub(session, now, scrub_days),
        ]


def _states(session: Session) -> Iterator[Metric]:
    job_states = [state.value for state in JobState]
    mesh_states = [state.value for state in MeshState]
    yield _gauge_by_state("quadpatch_jobs", "Jobs that are kept, by state.", _counts(session, JobRow.state), job_states)
    yield _gauge_by_state(
        "quadpatch_meshes", "Meshes that are kept, by state.", _counts(session, MeshRow.state), mesh_states
    )
    tasks = GaugeMetricFamily("quadpatch_jobs_by_task", "Jobs that are kept, by task.", labels=["task"])
    by_task = _counts(session, JobRow.task)
    for task in TASKS:
        tasks.add_metric([task], by_task.get(task, 0))
    yield tasks
    models, proof_states = _counts(session, ModelRow.state), [state.value for state in ModelState]
    yield _gauge_by_state("quadpatch_models", "Versions of models, by state.", models, proof_states)
    deliveries, states = _counts(session, DeliveryRow.state), [state.value for state in DeliveryState]
    yield _gauge_by_state(
        "quadpatch_webhook_deliveries", "Messages to subscribers that are kept, by state.", deliveries, states
    )


def _waiting_tasks(session: Session, now: datetime) -> Iterator[Metric]:
    is_queued = JobRow.state == JobState.QUEUED.value
    is_free = or_(MeshRow.lease_until.is_(None), MeshRow.lease_until < now)
    is_unstarted = (MeshRow.state == MeshState.ANALYSING.value) & is_free
    n_jobs, first_job = _count_and_first(session, JobRow.queued_at, is_queued)
    n_meshes, first_mesh = _count_and_first(session, MeshRow.updated_at, is_unstarted)
    n_running = session.scalars(select(func.count()).where(JobRow.state.in_(AT_WORK))).one()
    is_analysed = (MeshRow.state == MeshState.ANALYSING.value) & (MeshRow.lease_until >= now)
    n_analysing = session.scalars(select(func.count()).where(is_analysed)).one()
    n_models, first_model = _count_and_first(session, ModelRow.created_at, _is_proving() & ~_is_leased(now))
    n_proving = session.scalars(select(func.count()).where(_is_proving() & _is_leased(now))).one()
    length = GaugeMetricFamily("quadpatch_queue_length", "Tasks that wait for a worker, by kind.", labels=["kind"])
    oldest = GaugeMetricFamily(
        "quadpatch_queue_oldest_age_seconds", "How long the longest of them has waited; 0: none waits.", labels=["kind"]
    )
    at_work = GaugeMetricFamily("quadpatch_tasks_at_work", "Tasks that workers are at, by kind.", labels=["kind"])
    for kind, n_waiting, first, n_working in (
        ("repair", n_jobs, first_job, n_running),
        ("analysis", n_meshes, first_mesh, n_analysing),
        ("proof", n_models, first_model, n_proving),
    ):
        length.add_metric([kind], n_waiting)
        oldest.add_metric([kind], 0 if first is None else max(0.0, (now - first).total_seconds()))
        at_work.add_metric([kind], n_working)
    yield from (length, oldest, at_work)


def _is_proving() -> ColumnElement[bool]:
    return ModelRow.state == ModelState.PROVING.value


def _is_leased(now: datetime) -> ColumnElement[bool]:
    return ModelRow.lease_until.is_not(None) & (ModelRow.lease_until >= now)


def _leases(session: Session, now: datetime, lease_s: float) -> Iterator[Metric]:
    _, first_end = _count_and_first(session, JobRow.lease_until, JobRow.state.in_(AT_WORK))
    age_s = 0.0 if first_end is None else max(0.0, (now - (first_end - timedelta(seconds=lease_s))).total_seconds())
    yield GaugeMetricFamily(
        "quadpatch_lease_oldest_age_seconds",
        "How long the attempt that was silent longest has not renewed its lease; 0: none is at work.",
        value=age_s,
    )


def _totals(session: Session) -> Iterator[Metric]:
    attempts = CounterMetricFamily(
        "quadpatch_attempts", "Attempts at jobs that have ended, by outcome and error code.", labels=["outcome", "code"]
    )
    counts = {(row.outcome, row.code): row.count for row in session.scalars(select(AttemptCountRow))}
    for outcome, code in dict.fromkeys([*_EXPECTED_OUTCOMES, *counts]):
        attempts.add_metric([outcome, code], counts.get((outcome, code), 0))
    stages = SummaryMetricFamily(
        "quadpatch_stage_duration_seconds",
        "Stages of published jobs, by method and task.",
        labels=["stage", "method", "task"],
    )
    for stage in session.scalars(select(StageRow)):
        stages.add_metric([stage.stage, stage.method, stage.task], stage.count, stage.seconds)
    yield from (attempts, stages)


def _models(session: Session) -> Iterator[Metric]:
    models = GaugeMetricFamily(
        "quadpatch_model_info", "Published models; always 1.", labels=["name", "version", "kind", "sha256"]
    )
    for name, version, kind, sha256 in session.execute(
        select(ModelRow.name, ModelRow.version, ModelRow.kind, ModelRow.sha256)
    ):
        models.add_metric([name, str(version), kind, sha256], 1)
    aliases = GaugeMetricFamily(
        "quadpatch_model_alias_info", "What aliases point to; always 1.", labels=["alias", "name", "version"]
    )
    for row in session.scalars(select(AliasRow)):
        aliases.add_metric([row.alias, row.name, str(row.version)], 1)
    yield from (models, aliases)


def _memory(session: Session, now: datetime) -> Iterator[Metric]:
    limit = GaugeMetricFamily("quadpatch_memory_limit_bytes", "What engines of a machine may take.", labels=["machine"])
    free = GaugeMetricFamily(
        "quadpatch_memory_free_bytes", "What was free on a machine when a worker last looked.", labels=["machine"]
    )
    reserved = GaugeMetricFamily(
        "quadpatch_memory_reserved_bytes", "What engines of a machine are expected to need.", labels=["machine"]
    )
    reservations = select(ReservationRow.machine, func.sum(ReservationRow.reserved_mb)).group_by(ReservationRow.machine)
    reserved_mb = {row[0]: row[1] for row in session.execute(reservations.where(ReservationRow.until >= now))}
    for row in session.scalars(select(MachineRow).order_by(MachineRow.name)):
        limit.add_metric([row.name], row.limit_mb * _MIB)
        free.add_metric([row.name], row.free_mb * _MIB)
        reserved.add_metric([row.name], reserved_mb.get(row.name, 0) * _MIB)
    waiting = GaugeMetricFamily(
        "quadpatch_memory_waiting_jobs",
        "Jobs that wait for memory.",
        value=session.scalars(select(func.count()).where(JobRow.memory_wait_since <= now)).one(),
    )
    peaks: dict[str, int] = {}
    for job in read_past(session):
        peaks[job.kind] = max(peaks.get(job.kind, 0), job.peak_memory_mb or 0)
    peak = GaugeMetricFamily(
        "quadpatch_job_peak_memory_bytes",
        "Most memory of an engine in the last 500 jobs that succeeded, by task and kind of model.",
        labels=["kind"],
    )
    for kind, peak_mb in sorted(peaks.items()):
        peak.add_metric([kind], peak_mb * _MIB)
    yield from (limit, free, reserved, waiting, peak)


def _scrub(session: Session, now: datetime, days: float) -> Iterator[Metric]:
    objects = CounterMetricFamily("quadpatch_scrub_objects", "Objects that the scrub has read.", labels=["kind"])
    size = CounterMetricFamily("quadpatch_scrub_bytes", "Bytes that the scrub has read.", labels=["kind"])
    damaged = GaugeMetricFamily("quadpatch_damaged_objects", "Objects known to be damaged, by kind.", labels=["kind"])
    counts = {row.kind: row for row in session.scalars(select(ScrubRow))}
    damaged_counts = _counts(session, DamagedRow.kind)
    for kind in OBJECT_KINDS:
        objects.add_metric([kind], counts[kind].objects if kind in counts else 0)
        size.add_metric([kind], counts[kind].size_bytes if kind in counts else 0)
        damaged.add_metric([kind], damaged_counts.get(kind, 0))
    yield from (objects, size, damaged)
    oldest = oldest_check(session)
    yield GaugeMetricFamily(
        "quadpatch_scrub_oldest_check_age_seconds",
        "How long ago the object was checked, or else stored, that was checked longest ago; 0: there is none.",
        value=0 if oldest is None else max(0.0, (now - oldest).total_seconds()),
    )
    yield GaugeMetricFamily(
        "quadpatch_scrub_period_seconds",
        "Within how long all objects are to be checked; 0: never.",
        value=days * 86_400,
    )


def _counts(session: Session, column: InstrumentedAttribute[str]) -> dict[str, int]:
    rows = session.execute(select(column, func.count()).group_by(column)).all()
    return {str(row[0]): int(row[1]) for row in rows}


def _gauge_by_state(name: str, help_text: str, counts: dict[str, int], states: list[str]) -> Metric:
    """Make a gauge by state; `states` without a count are 0."""
    family = GaugeMetricFamily(name, help_text, labels=["state"])
    for state in dict.fromkeys([*states, *counts]):
        family.add_metric([state], counts.get(state, 0))
    return family


def _count_and_first(
    session: Session,
    moment: InstrumentedAttribute[datetime] | InstrumentedAttribute[datetime | None],
    condition: ColumnElement[bool],
) -> tuple[int, datetime | None]:
    count, first = session.execute(select(func.count(), func.min(moment)).where(condition)).one()
    return count, first
