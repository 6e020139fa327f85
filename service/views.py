"""Views: answered where they are made, put into the queue where they are not.

Tested in `tests/service/routes/test_views.py`.
"""

import logging
from dataclasses import dataclass
from http import HTTPStatus

from fastapi import Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from jobkit.errors import ObjectNotFoundError, QueueUnavailableError, ViewFailedError
from jobkit.views import FAILED, View, ViewOrder
from quadpatch_client.schema.views import ViewState
from service.content import Content, content_response
from service.problems import RETRY_AFTER_S
from service.routes.common import json_response
from service.services import Services
from service.waiting import note_applied, preferred_wait_s

# A view changes where the service is upgraded, and goes with its mesh: it may be shown again for a while unasked.
_CACHE_CONTROL = "private, max-age=3600"

_logger = logging.getLogger("service")


@dataclass(frozen=True)
class WantedView:
    """What a request asks to see, and how its file is to be called."""

    order: ViewOrder
    media_type: str
    filename: str


async def view_response(request: Request, services: Services, wanted: WantedView, prefer: str | None) -> Response:
    """Send a view; while it is being made, and longer than the request waits, 202.

    Raises
    ------
    MeshNotFoundError, JobNotFoundError, ModelNotFoundError
        If what it shows is not there.
    ViewFailedError
        If it can't be made.
    """
    view = await run_in_threadpool(_ordered, services, wanted.order)
    wait_s = min(preferred_wait_s(prefer), services.settings.max_wait_s)
    has_waited = True
    if view.stored is None and view.state != FAILED and wait_s > 0:
        has_waited = await services.view_waiters.wait(view.id, wait_s)
        view = await run_in_threadpool(_ordered, services, wanted.order)
    response = await run_in_threadpool(_answer, request, services, wanted, view)
    if has_waited:
        note_applied(response, prefer)
    return response


def _ordered(services: Services, order: ViewOrder) -> View:
    """Return a view; one that is due goes into the queue."""
    view = services.views.order(order)
    if view.is_due:
        try:
            services.views.submit(services.queue, view)
        except QueueUnavailableError as error:
            _logger.warning("view %s waits for the queue: %s", view.id, error)
    return view


def _answer(request: Request, services: Services, wanted: WantedView, view: View) -> Response:
    if view.state == FAILED:
        raise ViewFailedError(f"there is no such view: {view.problem}")
    if view.stored is not None:
        stored = view.stored
        try:
            content = Content(stored.key, stored.sha256, stored.size_bytes, wanted.filename, wanted.media_type)
            response = content_response(request, services, content)
        except ObjectNotFoundError:
            services.views.remake(view)
            _ordered(services, wanted.order)
        else:
            response.headers["Cache-Control"] = _CACHE_CONTROL
            return response
    return json_response(ViewState(state="making"), HTTPStatus.ACCEPTED, Retry_After=RETRY_AFTER_S)
