"""The table of a batch: the columns of `figures.csv` of the service and of `summary.csv` of the client.

Names say their unit. What is not known is empty.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from quadpatch_client.schema.base import rfc3339
from quadpatch_client.schema.jobs import Job

# A spreadsheet takes a cell that begins so for a formula.
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def figures_of(job: Job, file: str | None) -> dict[str, Any]:
    """Return the row of a job, by column.

    Parameters
    ----------
    job : Job
    file : str or None
        Name that its result has where the table is; None where it has none.
    """
    return {name: value(job, file) for name, value in _COLUMNS.items()}


def spreadsheet_cell(value: object) -> object:
    """Keep a spreadsheet from taking a text of others, such as a file's name, for a formula."""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


def _of_result(name: str) -> Callable[[Job, str | None], Any]:
    return lambda job, _: None if job.result is None else getattr(job.result, name)


def _of_holes(name: str) -> Callable[[Job, str | None], Any]:
    return lambda job, _: None if job.result is None else getattr(job.result.holes, name)


def _of_error(name: str) -> Callable[[Job, str | None], Any]:
    return lambda job, _: None if job.error is None else getattr(job.error, name)


def _model(job: Job, _: str | None) -> str:
    return job.model.kind if job.model.name is None else f"{job.model.name}@{job.model.version}"


def _file_fact(name: str) -> Callable[[Job, str | None], Any]:
    return lambda job, _: getattr(job.result.file("result"), name, None) if job.result else None


def _reason(job: Job, _: str | None) -> str | None:
    if job.error is not None:
        return job.error.message
    return None if job.result is None else "; ".join(job.result.warnings) or None


_COLUMNS: Mapping[str, Callable[[Job, str | None], Any]] = MappingProxyType(
    {
        "job_id": lambda job, _: job.id,
        "mesh_id": lambda job, _: job.mesh_id,
        "mesh_name": lambda job, _: job.mesh_name,
        "label": lambda job, _: job.spec.label,
        "task": lambda job, _: job.spec.task,
        "model": _model,
        "state": lambda job, _: job.state.value,
        "error_code": _of_error("code"),
        "error_message": _of_error("message"),
        "file": lambda _, file: file,
        "file_bytes": _file_fact("size_bytes"),
        "file_sha256": _file_fact("sha256"),
        "holes_found": _of_holes("found"),
        "holes_filled": _of_holes("filled"),
        "holes_filled_smooth": _of_holes("filled_smooth"),
        "holes_skipped": _of_holes("skipped"),
        "holes_refused": _of_holes("refused"),
        "new_vertices": _of_result("new_vertices"),
        "new_triangles": _of_result("new_triangles"),
        "restored_vertices": _of_result("restored_vertices"),
        "moved_vertices": _of_result("moved_vertices"),
        "shift_95_mesh_units": _of_result("shift_95"),
        "max_error_mesh_units": _of_result("max_error"),
        "work_seconds": _of_result("seconds"),
        "peak_memory_mib": _of_result("peak_memory_mb"),
        "warnings": lambda job, _: None if job.result is None else len(job.result.warnings),
        "reason": _reason,
        "cached_from": lambda job, _: job.cached_from,
        "created_at": lambda job, _: rfc3339(job.created_at),
        "finished_at": lambda job, _: None if job.finished_at is None else rfc3339(job.finished_at),
    }
)
FIGURES: tuple[str, ...] = tuple(_COLUMNS)
