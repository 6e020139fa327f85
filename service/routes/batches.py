"""Batches: start, list, look at, follow, cancel, delete, run again."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from fastapi.sse import EventSourceResponse
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.batches.progress import delete_batch as delete_batch_rows
from quadpatch_client.schema import Batch, BatchEventPage, BatchPage, JobState, NewBatch
from quadpatch_rules.ids import BATCH_ID_PATTERN
from service.batches import BatchRequest, submit_batch
from service.batches import rerun_batch as run_failed_again
from service.caching import CacheControl, asks_anew
from service.finding import Limit
from service.idempotency import note_replayed
from service.routes.common import BatchIdPath, CallerDep, described_header, json_response, linked, problems
from service.routes.events import After, LastEventId, PageLimit, accepts_stream
from service.services import Services, ServicesDep, get_principal
from service.strict_validation import StrictRoute

router = APIRouter(tags=["batches"], route_class=StrictRoute)

_OPERATIONS = ("get_batch", "list_batch_events", "cancel_batch", "rerun_batch", "delete_batch")
_DOWNLOADS = ("get_batch_figures", "get_batch_results")
_ACCEPTED: dict[int | str, dict[str, Any]] = {
    202: {
        "model": Batch,
        "description": "All of its jobs are accepted, and each will end, exactly once.",
        "headers": {"Location": described_header("Path of the batch.")},
        "links": {name: linked(name, "$response.body#/id", "batch_id") for name in (*_OPERATIONS, *_DOWNLOADS)},
    }
}
_EVENTS: dict[int | str, dict[str, Any]] = {
    200: {
        "model": BatchEventPage,
        "description": "A page; or, with `Accept: text/event-stream`, every event as it comes: `id` is its sequence, "
        "`event` its type, `data` the event as JSON. The stream ends after the last event.",
        "content": {EventSourceResponse.media_type: {"schema": {"type": "string"}}},
    },
    204: {"description": "Of a stream: the batch has ended, and no event is left."},
    **problems(404),
}
_OPEN = (JobState.QUEUED, JobState.RUNNING, JobState.CANCELING)
Cursor = Annotated[
    str | None, Query(pattern=BATCH_ID_PATTERN, description="`next_cursor` of the page before this one.")
]
Canceled = Annotated[bool, Query(description="Also those that were canceled.")]


@router.post(
    "/v1/batches",
    status_code=202,
    response_model=None,
    responses={**_ACCEPTED, **problems(400, 404, 409, 413, 415, 507)},
)
def create_batch(
    services: ServicesDep, caller: CallerDep, new: NewBatch, cache_control: CacheControl = None
) -> Response:
    """Start a job on each of many meshes: all of them, or none where one can't be started."""
    idempotency = caller.idempotency("create_batch", new.model_dump_json())
    request = BatchRequest(idempotency, not asks_anew(cache_control), caller.principal.public_name)
    return _accepted(submit_batch(services, new, request))


@router.get("/v1/batches", response_model=BatchPage, responses=problems())
def list_batches(services: ServicesDep, limit: Limit = 20, cursor: Cursor = None) -> BatchPage:
    """List batches, newest first, with counts that may be a second old."""
    page = services.batches.page(limit, cursor)
    return page.model_copy(update={"items": [_estimated(services, batch) for batch in page.items]})


@router.get("/v1/batches/{batch_id}", response_model=Batch, responses=problems(404))
def get_batch(services: ServicesDep, batch_id: BatchIdPath) -> Batch:
    """Show where a batch stands."""
    return _estimated(services, services.batches.get(batch_id))


@router.get("/v1/batches/{batch_id}/events", response_model=None, responses=_EVENTS)
async def list_batch_events(
    request: Request,
    services: ServicesDep,
    batch_id: BatchIdPath,
    after: After = 0,
    limit: PageLimit = 200,
    last_event_id: LastEventId = "",
) -> Response:
    """List what happened to a batch, oldest first, or stream it with `Accept: text/event-stream`."""
    if not accepts_stream(request.headers.get("accept", "")):
        page = await run_in_threadpool(services.batches.events, batch_id, after, limit)
        return json_response(page, Vary="Accept")
    known = int(last_event_id or after)
    batch = await run_in_threadpool(services.batches.get, batch_id)
    if batch.finished_at is not None and known >= batch.revision:
        return Response(status_code=HTTPStatus.NO_CONTENT, headers={"Vary": "Accept"})
    return await services.streams.respond_to((await get_principal(request)).tenant, batch_id, known)


@router.post(
    "/v1/batches/{batch_id}/cancel",
    status_code=202,
    response_model=None,
    responses={202: {"model": Batch, "description": "Its jobs are being canceled."}, **problems(404, 409)},
)
def cancel_batch(services: ServicesDep, batch_id: BatchIdPath) -> Response:
    """Cancel all jobs of a batch that have not ended; a second time changes nothing."""
    return json_response(services.batches.request_cancel(batch_id), HTTPStatus.ACCEPTED)


@router.delete("/v1/batches/{batch_id}", status_code=204, response_class=Response, responses=problems(404, 409))
def delete_batch(services: ServicesDep, batch_id: BatchIdPath) -> Response:
    """Delete a batch that has ended, with all of its jobs and results. There is no way back."""
    delete_batch_rows(services.database, services.store, batch_id)
    return Response(status_code=HTTPStatus.NO_CONTENT)


@router.post(
    "/v1/batches/{batch_id}/rerun",
    status_code=202,
    response_model=None,
    responses={**_ACCEPTED, **problems(404, 409)},
)
def rerun_batch(
    services: ServicesDep,
    caller: CallerDep,
    batch_id: BatchIdPath,
    canceled: Canceled = False,
    cache_control: CacheControl = None,
) -> Response:
    """Run again what failed of a batch so far, as a new batch that names the old one."""
    states = [JobState.FAILED, *([JobState.CANCELED] if canceled else [])]
    idempotency = caller.idempotency("rerun_batch", batch_id, *states)
    request = BatchRequest(idempotency, not asks_anew(cache_control), caller.principal.public_name)
    return _accepted(run_failed_again(services, batch_id, states, request))


def _accepted(made: tuple[Batch, bool]) -> Response:
    batch, is_new = made
    response = json_response(batch, HTTPStatus.ACCEPTED, Location=batch.links.self)
    return note_replayed(response, is_new=is_new)


def _estimated(services: Services, batch: Batch) -> Batch:
    if batch.finished_at is not None:
        return batch
    services.estimates.refresh()
    eta_s = services.estimates.remaining_s(services.batches.job_ids(batch.id, _OPEN))
    return batch.model_copy(update={"eta_s": eta_s})
