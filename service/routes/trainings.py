"""Trainings: start, list, look at, cancel."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.errors import JobNotFoundError
from jobkit.jobs.search import JobSearch
from quadpatch_client.schema import Job, JobState, NewTraining, Training, TrainingPage
from quadpatch_client.schema.base import EXAMPLE_SHA256
from quadpatch_rules.tasks import TRAIN
from service.finding import Limit
from service.idempotency import note_replayed
from service.problems import RETRY_AFTER_S
from service.routes.common import IdempotencyKey, JobIdPath, described_header, json_response, linked, problems
from service.routes.events import RESPONSES, After, LastEventId, PageLimit, events_response
from service.routes.jobs import Cursor, wait_for_end
from service.services import PrincipalDep, Services, ServicesDep
from service.strict_validation import StrictRoute
from service.training_submission import submit_training
from service.waiting import PreferHeader, note_applied

router = APIRouter(tags=["trainings"], route_class=StrictRoute)

_LINKS: dict[str, Any] = {
    operation: linked(operation, "$response.body#/id", "training_id")
    for operation in ("get_training", "cancel_training", "list_training_events")
}
_EXAMPLES: dict[str, Any] = {
    "requestBody": {
        "content": {
            "application/json": {
                "examples": {
                    "filter": {
                        "summary": "From past scans, and the default if it is better",
                        "value": {
                            "model": "castings",
                            "filter": {"filename": "casting-*.ply", "most": 50},
                            "make_default": "if_better",
                        },
                    },
                    "network": {
                        "summary": "A network, fitted to two scans",
                        "value": {
                            "model": "casting-network",
                            "kind": "network",
                            "meshes": [EXAMPLE_SHA256, "4" + EXAMPLE_SHA256[1:]],
                            "network": {"steps": 500},
                        },
                    },
                }
            }
        }
    }
}
States = Annotated[list[JobState] | None, Query(description="Only trainings in this state; may be repeated.")]


@router.post(
    "/v1/trainings",
    status_code=202,
    response_model=None,
    responses={
        202: {
            "model": Training,
            "description": "The training is accepted and will end, exactly once.",
            "headers": {"Location": described_header("Path of the training.")},
            "links": _LINKS,
        },
        **problems(400, 404, 409, 413, 415),
    },
    openapi_extra=_EXAMPLES,
)
def create_training(
    services: ServicesDep, principal: PrincipalDep, new: NewTraining, key: IdempotencyKey = None
) -> Response:
    """Learn a dictionary, or fit a network, from uploaded meshes, and publish it as a version of a model of yours.

    A training is a job of the task `train`: it waits in the same queue, and webhooks tell of it. Meshes that are kept
    from learning are repaired by what was learned and by the plain fill; the verdict says which of them did better.
    """
    job, is_new = submit_training(services, new, principal, key)
    return note_replayed(_answer(services, job, HTTPStatus.ACCEPTED), is_new=is_new)


@router.get("/v1/trainings", response_model=TrainingPage, responses=problems())
def list_trainings(
    services: ServicesDep, state: States = None, limit: Limit = 20, cursor: Cursor = None
) -> TrainingPage:
    """List trainings, newest first. Those that arrive meanwhile don't shift the pages."""
    page = services.jobs.page(limit, cursor, JobSearch(tuple(state or ()), TRAIN))
    services.estimates.refresh()
    return TrainingPage(
        items=[Training.of(services.estimates.complete(job)) for job in page.items], next_cursor=page.next_cursor
    )


@router.get("/v1/trainings/{training_id}", response_model=Training, responses=problems(404))
async def get_training(services: ServicesDep, training_id: JobIdPath, prefer: PreferHeader = None) -> Response:
    """Show where a training stands, and what it has learned once it has succeeded."""
    await run_in_threadpool(_existing, services, training_id)
    has_waited = await wait_for_end(services, training_id, prefer)
    job = await run_in_threadpool(_existing, services, training_id)
    response = await run_in_threadpool(_answer, services, job, HTTPStatus.OK)
    if has_waited:
        note_applied(response, prefer)
    return response


@router.get("/v1/trainings/{training_id}/events", response_model=None, responses=RESPONSES)
async def list_training_events(
    request: Request,
    services: ServicesDep,
    training_id: JobIdPath,
    after: After = 0,
    limit: PageLimit = 200,
    last_event_id: LastEventId = "",
) -> Response:
    """List everything that happened to a training, oldest first, or stream it with `Accept: text/event-stream`."""
    await run_in_threadpool(_existing, services, training_id)
    return await events_response(request, services, training_id, (after, limit, last_event_id))


@router.post(
    "/v1/trainings/{training_id}/cancel",
    status_code=202,
    response_model=None,
    responses={
        202: {"model": Training, "description": "The worker is asked to stop."},
        200: {"model": Training, "description": "The training is canceled."},
        **problems(404, 409),
    },
)
def cancel_training(services: ServicesDep, training_id: JobIdPath) -> Response:
    """Cancel a training; a second time changes nothing. No model comes of it."""
    _existing(services, training_id)
    job = services.jobs.request_cancel(training_id)
    return _answer(services, job, HTTPStatus.OK if job.state.is_terminal else HTTPStatus.ACCEPTED)


def _existing(services: Services, training_id: str) -> Job:
    job = services.jobs.get(training_id)
    if job.spec.task != TRAIN:
        raise JobNotFoundError(f"there is no training {training_id}")
    return job


def _answer(services: Services, job: Job, status: HTTPStatus) -> Response:
    services.estimates.refresh()
    training = Training.of(services.estimates.complete(job))
    headers = {} if job.state.is_terminal else {"Retry_After": RETRY_AFTER_S}
    return json_response(training, status, Location=training.links.self, **headers)
