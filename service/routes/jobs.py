"""Jobs: start, plan, list, look at, cancel, repeat."""

from dataclasses import dataclass
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Query, Request
from pydantic import ValidationError
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.access.keys import Holder
from quadpatch_client.schema import Job, JobPage, JobSpec, Plan, RepairSpec
from quadpatch_rules.ids import JOB_ID_PATTERN
from service.caching import CACHE_STATUS, CacheControl, asks_anew, note_cache
from service.finding import JobSearchDep, Limit
from service.idempotency import note_replayed
from service.problems import invalid_request
from service.routes.common import (
    IdempotencyKey,
    IfNoneMatch,
    JobIdPath,
    described_header,
    etag_of,
    is_unchanged,
    job_response,
    json_response,
    linked,
    not_modified,
    problems,
)
from service.services import PrincipalDep, Services, ServicesDep
from service.strict_validation import StrictRoute
from service.submission import Submission, plan, submit
from service.waiting import PreferHeader, note_applied, preferred_wait_s

router = APIRouter(tags=["jobs"], route_class=StrictRoute)

_OPERATIONS = ("get_job", "cancel_job", "rerun_job", "list_events")
_DOWNLOADS = ("get_result", "get_report", "get_preview", "get_closeups", "get_html_report", "get_pdf_report")
JOB_LINKS: dict[str, Any] = {
    operation: linked(operation, "$response.body#/id", "job_id") for operation in (*_OPERATIONS, *_DOWNLOADS)
}
ACCEPTED: dict[int | str, dict[str, Any]] = {
    202: {
        "model": Job,
        "description": "The job is accepted and will end, exactly once.",
        "headers": {"Location": described_header("Path of the job."), **CACHE_STATUS},
        "links": JOB_LINKS,
    }
}
_ENDED: dict[int | str, dict[str, Any]] = {
    200: {"model": Job, "description": "The job has ended.", "headers": CACHE_STATUS}
}


@dataclass(frozen=True)
class Asked:
    """Who asks for a job, and what the headers of the request say."""

    principal: Holder
    key: str | None
    prefer: str | None
    cache_control: str | None

    def submission(self, spec: JobSpec, rerun_of: str | None = None, *, runs_anyway: bool = False) -> Submission:
        """Return what is submitted; with `runs_anyway` no result is taken over."""
        reason = "request" if asks_anew(self.cache_control) else "bypass" if runs_anyway else None
        holder = self.principal
        return Submission(spec, holder.key_id, self.key, rerun_of, reason, holder.public_name)


async def _get_asked(
    principal: PrincipalDep,
    key: IdempotencyKey = None,
    prefer: PreferHeader = None,
    cache_control: CacheControl = None,
) -> Asked:
    return Asked(principal, key, prefer, cache_control)


AskedDep = Annotated[Asked, Depends(_get_asked)]
DryRun = Annotated[bool, Query(description="Only say what the job would do.")]
Cursor = Annotated[str | None, Query(pattern=JOB_ID_PATTERN, description="`next_cursor` of the page before this one.")]


@router.post(
    "/v1/jobs",
    status_code=202,
    response_model=None,
    responses={
        **ACCEPTED,
        200: {
            "model": Plan | Job,
            "description": "The plan of a dry run, or the job if it has ended already.",
            "headers": CACHE_STATUS,
        },
        **problems(400, 404, 409, 413, 415, 507),
    },
)
async def create_job(services: ServicesDep, asked: AskedDep, spec: JobSpec, dry_run: DryRun = False) -> Response:
    """Start a job. `{"mesh_id": …}` alone is enough: it fills the holes of the mesh.

    Where an equal job has left a result (the same mesh, options and model, by the same version of the software), the
    new one has it at once.
    """
    if dry_run:
        return json_response(await run_in_threadpool(plan, services, spec))
    return await answer_submission(services, asked.submission(spec), asked.prefer)


@router.get("/v1/jobs", response_model=JobPage, responses=problems())
def list_jobs(services: ServicesDep, search: JobSearchDep, limit: Limit = 20, cursor: Cursor = None) -> JobPage:
    """List jobs, newest first. Those that arrive meanwhile don't shift the pages."""
    page = services.jobs.page(limit, cursor, search)
    services.estimates.refresh()
    return page.model_copy(update={"items": [services.estimates.complete(job) for job in page.items]})


@router.get("/v1/jobs/{job_id}", response_model=Job, responses={**not_modified(), **problems(404)})
async def get_job(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
    prefer: PreferHeader = None,
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Show where a job stands. Its entity tag covers all but `eta_s`, which ages by itself."""
    has_waited = await wait_for_end(services, job_id, prefer)
    if if_none_match is not None:
        view = await services.job_cache.status(job_id)
        tag = etag_of(view.status.revision, view.queue_position, view.status.is_pinned)
        if is_unchanged(request, tag):
            return Response(status_code=304, headers={"ETag": tag})
    response = job_response(await services.job_cache.job(job_id))
    response.status_code = 200
    if has_waited:
        note_applied(response, prefer)
    return response


@router.post(
    "/v1/jobs/{job_id}/cancel",
    status_code=202,
    response_model=None,
    responses={
        202: {"model": Job, "description": "The worker is asked to stop."},
        200: {"model": Job, "description": "The job is canceled."},
        **problems(404, 409),
    },
)
def cancel_job(services: ServicesDep, job_id: JobIdPath) -> Response:
    """Cancel a job; a second time changes nothing."""
    canceled = services.jobs.request_cancel(job_id)
    services.estimates.refresh()
    return job_response(services.estimates.complete(canceled))


@router.post(
    "/v1/jobs/{job_id}/rerun",
    status_code=202,
    response_model=None,
    responses={**ACCEPTED, **_ENDED, **problems(400, 404, 409, 413, 415, 507)},
)
async def rerun_job(
    services: ServicesDep, asked: AskedDep, job_id: JobIdPath, changes: RepairSpec | None = None
) -> Response:
    """Run the spec of a job again, as a new job pinned to what its model reference means now.

    What the body names replaces what the spec says, each field as a whole; `{}` or no body changes nothing. With
    nothing changed the job runs in any case.
    """
    job = await run_in_threadpool(services.jobs.get, job_id)
    spec = _changed_spec(job.spec, changes or RepairSpec())
    submission = asked.submission(spec, rerun_of=job_id, runs_anyway=spec == job.spec)
    return await answer_submission(services, submission, asked.prefer)


def _changed_spec(spec: JobSpec, changes: RepairSpec) -> JobSpec:
    """Return the spec with the fields that the changes name, checked as a whole."""
    replaced_fields = {name: getattr(changes, name) for name in changes.model_fields_set}
    try:
        return JobSpec.model_validate({name: getattr(spec, name) for name in JobSpec.model_fields} | replaced_fields)
    except ValidationError as error:
        details = error.errors(include_input=False, include_url=False)
        raise invalid_request([{**detail, "loc": ("body", *detail["loc"])} for detail in details]) from error


async def answer_submission(services: Services, submission: Submission, prefer: str | None) -> Response:
    """Submit a job, wait as long as the client prefers to, and say how it stands."""
    job, is_new = await run_in_threadpool(submit, services, submission)
    has_waited = await wait_for_end(services, job.id, prefer)
    response = job_response(await services.job_cache.job(job.id))
    if has_waited:
        note_applied(response, prefer)
    if is_new:
        note_cache(response, job, reason=submission.runs_because or "miss")
    return note_replayed(response, is_new=is_new)


async def wait_for_end(services: Services, job_id: str, prefer: str | None) -> bool:
    """Wait as the client prefers; return whether that was possible, so that it can be told."""
    wait_s = min(preferred_wait_s(prefer), services.settings.max_wait_s)
    if wait_s <= 0 or (await services.job_cache.status(job_id)).status.state.is_terminal:
        return True
    return await services.job_waiters.wait(job_id, wait_s)
