"""Files of a finished job: the repaired mesh, the report, also as a page, the pictures."""

from collections.abc import Mapping
from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import Response

from jobkit.errors import JobHasNoResultError, JobNotFinishedError, ObjectNotFoundError, ResultMissingError
from quadpatch_client.schema import FileRole, Job
from quadpatch_client.schema.reports import Report
from service.batch_files import suffix_of
from service.content import OCTETS, Content, content_response, result_name
from service.routes.common import BINARY, CONDITIONAL, JobIdPath, not_modified, problems
from service.services import Services, ServicesDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["results"], route_class=StrictRoute)

# The page names files and labels of clients. It comes as a file to be saved, and a browser that shows it all the same
# gives it an origin of its own, no script and no network.
_PAGE_POLICY = (
    "sandbox; default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'"
)


def _documented(media_type: str, schema: Mapping[str, Any] = BINARY, **whole: Any) -> dict[int | str, dict[str, Any]]:
    content = {media_type: {"schema": schema}}
    return {
        200: {"description": "The whole file.", **(whole or {"content": content})},
        206: {"description": "The range.", "content": content},
        **not_modified(),
        **problems(404, 409, 410, 412, 416),
    }


@router.get(
    "/v1/jobs/{job_id}/result",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented(OCTETS),
)
def get_result(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
) -> Response:
    """Fetch the repaired mesh, or what else the task of the job makes."""
    return _file_response(request, services, job_id, "result", OCTETS)


@router.get(
    "/v1/jobs/{job_id}/report",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented("application/json", model=Report),
)
def get_report(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
) -> Response:
    """Fetch the report: what was found, filled and left open, hole by hole, and why, or what else the task did."""
    return _file_response(request, services, job_id, "report", "application/json")


@router.get(
    "/v1/jobs/{job_id}/preview.png",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented("image/png"),
)
def get_preview(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
) -> Response:
    """Fetch the picture: before, after, and what was invented."""
    return _file_response(request, services, job_id, "preview", "image/png")


@router.get(
    "/v1/jobs/{job_id}/closeups.zip",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented("application/zip"),
)
def get_closeups(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
) -> Response:
    """Fetch the pictures of the chosen holes: `hole_<id>.png` in a ZIP file, where `output.closeups` asked for them."""
    return _file_response(request, services, job_id, "closeups", "application/zip")


@router.get(
    "/v1/jobs/{job_id}/report.html",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented("text/html", {"type": "string"}),
)
def get_html_report(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
) -> Response:
    """Fetch the report as a page that stands alone, for people and auditors, where the job asked for it.

    `output.html_report` asks for it. It comes as a file to be saved; it runs no script and loads nothing.
    """
    answer = _file_response(request, services, job_id, "html_report", "text/html")
    answer.headers["Content-Security-Policy"] = _PAGE_POLICY
    return answer


@router.get(
    "/v1/jobs/{job_id}/report.pdf",
    response_class=Response,
    dependencies=CONDITIONAL,
    responses=_documented("application/pdf"),
)
def get_pdf_report(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
) -> Response:
    """Fetch the page of the report as a PDF, where the job asked for a page and a renderer is installed.

    `output.html_report` asks for the page; `pdf_reports` of `GET /v1/limits` says whether there is a renderer.
    """
    try:
        return _file_response(request, services, job_id, "pdf_report", "application/pdf")
    except ObjectNotFoundError as error:
        if services.settings.pdf_renderer:
            raise
        detail = f"job {job_id} left no PDF: no renderer is installed here; print report.html with a browser"
        raise ObjectNotFoundError(detail) from error


def _file_response(
    request: Request,
    services: Services,
    job_id: str,
    role: FileRole,
    media_type: str,
) -> Response:
    job, keys = services.jobs.with_files(job_id)
    require_result(job)
    file = job.result.file(role) if job.result else None
    if file is None:
        raise ObjectNotFoundError(f"job {job_id} left no {role}")
    mesh = services.meshes.get(job.mesh_id)
    name = result_name(job.mesh_name or mesh.filename, mesh.id, suffix_of(job, role), job.spec.task)
    try:
        content = Content(keys[file.name], file.sha256, file.size_bytes, name, media_type)
        return content_response(request, services, content)
    except ObjectNotFoundError as error:
        services.jobs.get(job_id)  # raises JobNotFoundError where the job was deleted meanwhile
        raise ResultMissingError(f"the {role} of job {job_id} is gone from the store; run the job again") from error


def require_result(job: Job) -> None:
    """Raise JobNotFinishedError or JobHasNoResultError where a job has no result."""
    if not job.state.is_terminal:
        raise JobNotFinishedError(f"job {job.id} is {job.state.value}; it has no result yet")
    if not job.state.has_result:
        reason = f": {job.error.message}" if job.error else ""
        raise JobHasNoResultError(f"job {job.id} ended as {job.state.value}{reason}")
