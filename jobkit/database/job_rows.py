"""Rows of jobs, found and turned into what clients see.

Tested in `tests/service/routes/test_results.py`.
"""

from sqlalchemy import ColumnElement, or_, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from jobkit.database.expiry import expiry
from jobkit.database.tables import JobRow, MeshRow
from jobkit.database.training_tables import TrainingMeshRow
from jobkit.errors import JobNotFoundError
from quadpatch_client.schema import Job, JobLinks, JobState


def existing_job(session: Session, job_id: str, *, locked: bool = False) -> JobRow:
    """Return the row of a job as it stands now, and until the session ends if `locked`; raise JobNotFoundError."""
    query = select(JobRow).where(JobRow.id == job_id).execution_options(populate_existing=True)
    row = session.scalars(query.with_for_update() if locked else query).one_or_none()
    if row is None:
        raise JobNotFoundError(f"there is no job {job_id}")
    return row


def names_mesh(mesh_id: str | InstrumentedAttribute[str]) -> ColumnElement[bool]:
    """Return the condition on a job that it is about the mesh, or learns from it."""
    trainings = select(TrainingMeshRow.job_id).where(TrainingMeshRow.mesh_id == mesh_id).correlate(MeshRow)
    return or_(JobRow.mesh_id == mesh_id, JobRow.reference_id == mesh_id, JobRow.id.in_(trainings))


def to_job(row: JobRow, retention_days: float = 0) -> Job:
    """Return the row as clients see it; finished jobs are kept for `retention_days`, 0: for ever.

    What depends on other jobs, `queue_position` and `eta_s`, is left to `jobkit.jobs.estimates`.
    """
    names = Job.model_fields.keys() - {"links", "mesh_id", "expires_at", "queue_position", "eta_s", "waits_for"}
    values = {name: getattr(row, name) for name in names} | {"mesh_id": _mesh_id(row)}
    values["waits_for"] = None if row.memory_wait_since is None else "memory"
    expires_at = expiry(row.finished_at, retention_days, row.pinned)
    return Job.model_validate(values | {"links": _links(row), "expires_at": expires_at})


def _mesh_id(row: JobRow) -> str | None:
    """Return the id of the mesh as its owner knows it; None where the row can't be read."""
    return row.spec.get("mesh_id") if isinstance(row.spec, dict) else None


def _links(row: JobRow) -> JobLinks:
    path = f"/v1/jobs/{row.id}"
    state = JobState(row.state)
    roles = {file["role"] for file in (row.result or {}).get("files", [])}
    return JobLinks(
        self=path,
        events=f"{path}/events",
        mesh=f"/v1/meshes/{_mesh_id(row)}",
        rerun=f"{path}/rerun",
        cancel=None if state.is_terminal else f"{path}/cancel",
        result=f"{path}/result" if "result" in roles else None,
        report=f"{path}/report" if "report" in roles else None,
        preview=f"{path}/preview.png" if "preview" in roles else None,
        closeups=f"{path}/closeups.zip" if "closeups" in roles else None,
        html_report=f"{path}/report.html" if "html_report" in roles else None,
        pdf_report=f"{path}/report.pdf" if "pdf_report" in roles else None,
    )
