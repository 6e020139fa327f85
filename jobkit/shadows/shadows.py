"""Shadows as operators set and read them.

Tested in `tests/service/routes/test_shadows.py`.
"""

from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.database.readable_rows import readable
from jobkit.database.session import Database
from jobkit.database.shadow_tables import ShadowRow, ShadowRunRow
from jobkit.database.tenancy import own_name, shown_name
from jobkit.errors import ModelNotFoundError, ShadowNotFoundError
from jobkit.models.proofs import reference_of
from jobkit.models.registry import Registry
from jobkit.models.resolution import learned_for
from jobkit.models.rows import version_row
from jobkit.shadows.choice import AUTO, pinned_beside
from jobkit.shadows.figures import Measured, figures_of
from jobkit.shadows.runs import MOST_RUNS
from quadpatch_client.schema import (
    AutoMethod,
    CnnMethod,
    DictionaryMethod,
    Method,
    NewShadow,
    Shadow,
    ShadowFigures,
    ShadowLinks,
    ShadowList,
    ShadowRun,
    ShadowRunPage,
)
from quadpatch_client.schema.shadows import ShadowState


class Shadows:
    """All shadows of a tenant.

    Parameters
    ----------
    database : Database
        As the tenant sees it.
    registry : Registry
        Likewise.
    """

    def __init__(self, database: Database, registry: Registry) -> None:
        self._database = database
        self._registry = registry

    def put(self, name: str, new: NewShadow) -> Shadow:
        """Let a candidate run beside what jobs ask for by a name; another candidate begins anew.

        Raises
        ------
        ModelNotFoundError
            If the name, or the candidate, means nothing.
        ModelKindError
            If the candidate can't take the place of what the name means.
        ModelNotProvenError, ModelRefusedError
            If the candidate is not to be used.
        """
        candidate = self._registry.usable(new.candidate)
        reference = reference_of(candidate.name, candidate.version)
        pinned_beside(self._registry, self._method_of(name), reference)
        own = own_name(self._database.tenant, name)
        with self._database.write() as session:
            row = session.get(ShadowRow, own, with_for_update=True)
            if row is not None and reference_of(row.candidate, row.version) != reference:
                session.delete(row)
                session.flush()
                row = None
            row = row or ShadowRow(name=own, candidate=candidate.name, version=candidate.version, created_at=utc_now())
            row.share = new.share
            session.add(row)
            session.flush()
            return _show(session, row)

    def get(self, name: str) -> Shadow:
        """Return a shadow; raise ShadowNotFoundError."""
        with self._database.read() as session:
            return _show(session, self._row(session, name))

    def list_all(self) -> ShadowList:
        """Return all shadows, by name."""
        with self._database.read() as session:
            rows = list(session.scalars(select(ShadowRow).order_by(ShadowRow.name)))
            return ShadowList(items=list(readable(rows, lambda row: _show(session, row))))

    def clear(self, name: str) -> None:
        """Let the candidate run no more, and forget its runs; raise ShadowNotFoundError."""
        with self._database.write() as session:
            row = self._row(session, name)
            session.execute(delete(ShadowRunRow).where(ShadowRunRow.shadow == row.name))
            session.delete(row)

    def runs(self, name: str, limit: int, cursor: str | None = None) -> ShadowRunPage:
        """Return runs, those of the newest jobs first; raise ShadowNotFoundError."""
        with self._database.read() as session:
            row = self._row(session, name)
            query = select(ShadowRunRow).where(ShadowRunRow.shadow == row.name)
            if cursor is not None:
                query = query.where(ShadowRunRow.job_id < cursor)
            rows = list(session.scalars(query.order_by(ShadowRunRow.job_id.desc()).limit(limit + 1)))
            items = list(readable(rows[:limit], _show_run))
        return ShadowRunPage(items=items, next_cursor=rows[limit - 1].job_id if len(rows) > limit else None)

    def _row(self, session: Session, name: str) -> ShadowRow:
        row = session.get(ShadowRow, own_name(self._database.tenant, name))
        if row is None:
            raise ShadowNotFoundError(f"no candidate runs beside {name}")
        return row

    def _method_of(self, name: str) -> Method:
        """Return the method of a job that asks for a name."""
        if name == AUTO:
            return AutoMethod(method="auto")
        meant = self._registry.resolve(name)
        recipe = learned_for(meant)
        if meant.kind == "dictionary":
            return DictionaryMethod(method="dictionary", model=name, recipe=recipe)
        return CnnMethod(method="cnn", model=name, recipe=recipe)


def _show(session: Session, row: ShadowRow) -> Shadow:
    name = shown_name(row.name)
    path = f"/v1/shadows/{name}"
    counts = _counts(session, row)
    return Shadow(
        name=name,
        candidate=reference_of(row.candidate, row.version),
        share=row.share,
        state=_state(session, row, counts.get("measured", 0)),
        waiting=counts.get("waiting", 0) + counts.get("running", 0),
        failed=counts.get("failed", 0),
        dropped=counts.get("dropped", 0),
        figures=_figures(session, row),
        created_at=row.created_at,
        links=ShadowLinks(self=path, runs=f"{path}/runs"),
    )


def _state(session: Session, row: ShadowRow, n_measured: int) -> ShadowState:
    try:
        version_row(session, row.candidate, row.version)
    except ModelNotFoundError:
        return "candidate_missing"
    return "complete" if n_measured >= MOST_RUNS else "running"


def _counts(session: Session, row: ShadowRow) -> dict[str, int]:
    query = select(ShadowRunRow.state, func.count()).where(ShadowRunRow.shadow == row.name)
    return {row[0]: row[1] for row in session.execute(query.group_by(ShadowRunRow.state))}


def _figures(session: Session, row: ShadowRow) -> ShadowFigures:
    """Sum up the runs that are compared with what the latest one is compared with."""
    is_measured = (ShadowRunRow.shadow == row.name) & (ShadowRunRow.state == "measured")
    latest = select(ShadowRunRow.baseline).where(is_measured).order_by(ShadowRunRow.job_id.desc()).limit(1)
    baseline = session.scalars(latest).first()
    query = select(ShadowRunRow.holes, ShadowRunRow.ratio).where(is_measured, ShadowRunRow.baseline == baseline)
    rows = session.execute(query.order_by(ShadowRunRow.job_id)).all()
    return figures_of(baseline, [Measured(row.holes or 0, row.ratio or 1.0) for row in rows])


def _show_run(row: ShadowRunRow) -> ShadowRun:
    return ShadowRun.model_validate({name: getattr(row, name) for name in ShadowRun.model_fields})
