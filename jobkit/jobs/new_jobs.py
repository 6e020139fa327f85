"""What a job is created from, and the values of its row.

Tested in `tests/jobkit/jobs/test_jobs.py`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from sqlalchemy.orm import Session

from jobkit.database.clock import utc_now
from jobkit.jobs.fingerprints import fingerprint_of
from jobkit.jobs.turns import rank_of
from jobkit.models.rows import version_row
from quadpatch_client.schema import JobSpec, JobState, ResolvedModel


@dataclass(frozen=True)
class NewJob:
    """What a job is created from; `model` is already resolved, and stays.

    `request_id` and `traceparent` name the request that makes it, for logs and traces, and `asked_by` its key, for the
    report. With `may_reuse` it takes over the result of an equal job, where there is one.
    """

    spec: JobSpec
    model: ResolvedModel
    max_attempts: int
    rerun_of: str | None = None
    request_id: str | None = None
    traceparent: str | None = None
    may_reuse: bool = False
    asked_by: str | None = None


class NamedMesh(Protocol):
    """What the row of a job takes from that of a mesh."""

    @property
    def id(self) -> str:
        """Id of the row."""

    @property
    def filename(self) -> str | None:
        """Name of its file."""


def mesh_ids_of(spec: JobSpec) -> list[str]:
    """Return the ids of the mesh and of the one that the job learns from, as clients know them."""
    return [mesh_id for mesh_id in (spec.mesh_id, spec.reference_id) if mesh_id is not None]


def lock_model(session: Session, model: ResolvedModel) -> None:
    """Keep the version from being deleted until the job is written; raise ModelNotFoundError where it was."""
    if model.name is not None and model.version is not None:
        version_row(session, model.name, model.version, lock={"read": True})


def values_of(new: NewJob, meshes: Mapping[str, NamedMesh]) -> dict[str, Any]:
    """Return the values of a queued job's row, but for its id.

    Parameters
    ----------
    new : NewJob
    meshes : mapping
        The meshes that it names, by the ids that clients know. The name of the file is copied: later the same bytes may
        come under another one.
    """
    now, spec = utc_now(), new.spec
    return {
        "mesh_id": meshes[spec.mesh_id].id,
        "mesh_name": spec.mesh_name or meshes[spec.mesh_id].filename,
        "task": spec.task,
        "priority": rank_of(spec.priority),
        "reference_id": None if spec.reference_id is None else meshes[spec.reference_id].id,
        "state": JobState.QUEUED.value,
        "attempt": 0,
        "max_attempts": new.max_attempts,
        "revision": 1,
        "percent": 0.0,
        "spec": spec.model_dump(mode="json"),
        "model": new.model.model_dump(mode="json"),
        "rerun_of": new.rerun_of,
        "fingerprint": fingerprint_of(spec, new.model, new.asked_by),
        "may_reuse": new.may_reuse,
        "request_id": new.request_id,
        "asked_by": new.asked_by,
        "traceparent": new.traceparent,
        "queued_at": now,
        "created_at": now,
        "updated_at": now,
    }
