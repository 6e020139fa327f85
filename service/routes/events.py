"""The event log of a job: a page of it, or a stream that replays it and goes on to the end."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Header, Query, Request
from fastapi.sse import EventSourceResponse
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from quadpatch_client.schema import EventPage
from service.routes.common import JobIdPath, json_response, problems
from service.services import Services, ServicesDep, get_principal
from service.strict_validation import StrictRoute

router = APIRouter(tags=["jobs"], route_class=StrictRoute)

_LARGEST = 2**31 - 1
_STREAM = EventSourceResponse.media_type
RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {
        "model": EventPage,
        "description": "A page; or, with `Accept: text/event-stream`, every event as it comes: `id` is its sequence, "
        "`event` its type, `data` the event as JSON. The stream ends after the job's last event.",
        "content": {_STREAM: {"schema": {"type": "string"}}},
    },
    204: {"description": "Of a stream: the job has ended, and no event is left. A browser does not come back then."},
    **problems(404),
}
After = Annotated[int, Query(ge=0, le=_LARGEST, description="Only events with a higher number.")]
PageLimit = Annotated[int, Query(ge=1, le=1000, description="Most events on the page; a stream has no limit.")]
LastEventId = Annotated[
    str,
    Header(
        alias="Last-Event-ID",
        pattern="^[0-9]{0,9}$",
        description="Of a stream: only events with a higher number, whatever `after` says. Browsers send it when they "
        "take up a broken stream.",
    ),
]


@router.get("/v1/jobs/{job_id}/events", response_model=None, responses=RESPONSES)
async def list_events(
    request: Request,
    services: ServicesDep,
    job_id: JobIdPath,
    after: After = 0,
    limit: PageLimit = 200,
    last_event_id: LastEventId = "",
) -> Response:
    """List everything that happened to a job, oldest first, or stream it with `Accept: text/event-stream`."""
    return await events_response(request, services, job_id, (after, limit, last_event_id))


async def events_response(request: Request, services: Services, job_id: str, part: tuple[int, int, str]) -> Response:
    """Answer with a page of a job's events, or stream them; `part` is `after`, `limit` and `Last-Event-ID`."""
    after, limit, last_event_id = part
    if not accepts_stream(request.headers.get("accept", "")):
        page = await run_in_threadpool(services.jobs.events, job_id, after, limit)
        return json_response(page, Vary="Accept")
    known = int(last_event_id or after)
    job = await run_in_threadpool(services.jobs.status, job_id)
    if job.state.is_terminal and known >= job.revision:
        return Response(status_code=HTTPStatus.NO_CONTENT, headers={"Vary": "Accept"})
    return await services.streams.respond_to((await get_principal(request)).tenant, job_id, known)


def accepts_stream(accept: str) -> bool:
    """Return whether an Accept header names event streams; one that takes anything gets the page."""
    for item in accept.split(","):
        media_type, *parameters = [part.strip().lower() for part in item.split(";")]
        if media_type == _STREAM:
            return not any(_is_refusal(parameter) for parameter in parameters)
    return False


def _is_refusal(parameter: str) -> bool:
    name, _, value = parameter.partition("=")
    return name.strip() == "q" and value.strip().rstrip("0") in ("", "0.", "0")
