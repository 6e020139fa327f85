"""What the service depends on, and which parts must work for it to take jobs.

To accept a job needs the database, which holds its row, and the store, which holds the mesh. Without the queue or a
dispatcher jobs wait and none is lost: the answer is `degraded`, so that an operator acts, and not a refusal.

Tested in `tests/service/routes/test_health.py`.
"""

import logging
from collections.abc import Callable
from typing import Literal

from pydantic import BaseModel, Field

from jobkit.database.leadership import DISPATCHER, current_leader
from jobkit.errors import JobkitError, QueueUnavailableError
from quadpatch_client.schema import FieldError
from service.services import Services

_logger = logging.getLogger("service")


class Readiness(BaseModel):
    """What the service stands on."""

    status: Literal["ready", "degraded"] = Field(
        description="`degraded`: jobs are taken, and wait until somebody has mended what the warnings name."
    )
    database: Literal["ok"] = Field(default="ok", description="The database answers; else it is a problem.")
    store: Literal["ok"] = Field(default="ok", description="The object store can be written; else it is a problem.")
    queue: Literal["ok", "unavailable"] = Field(description="Whether the queue answers.")
    queue_persistence: Literal["ok", "weak", "unknown"] = Field(
        description="Whether the queue's server logs what it is given and throws nothing out; `unknown` where it does "
        "not say."
    )
    dispatcher: Literal["ok", "absent"] = Field(description="Whether a dispatcher leads.")
    warnings: list[str] = Field(description="What somebody should look at.")


def find_failures(services: Services) -> list[FieldError]:
    """Return what has to work and does not, empty where jobs can be taken."""
    checks: dict[str, Callable[[], None]] = {"database": services.database.ping, "store": services.store.check}
    failures = []
    for name, check in checks.items():
        try:
            check()
        except JobkitError as error:
            _logger.warning("%s is not ready: %r", name, error.__cause__ or error)
            failures.append(FieldError(location="service", pointer=name, message=str(error), code=error.code))
    return failures


def read_readiness(services: Services) -> Readiness:
    """Look at everything else; raise DatabaseUnavailableError."""
    queue, persistence, queue_warnings = _check_queue(services)
    dispatcher, dispatcher_warnings = _check_dispatcher(services)
    is_ready = queue == "ok" and persistence != "weak" and dispatcher == "ok"
    return Readiness(
        status="ready" if is_ready else "degraded",
        queue=queue,
        queue_persistence=persistence,
        dispatcher=dispatcher,
        warnings=[*queue_warnings, *dispatcher_warnings],
    )


def _check_queue(
    services: Services,
) -> tuple[Literal["ok", "unavailable"], Literal["ok", "weak", "unknown"], list[str]]:
    try:
        services.queue.ping()
        weaknesses = services.queue.weaknesses()
    except QueueUnavailableError as error:
        _logger.warning("queue is not ready: %r", error.__cause__ or error)
        return "unavailable", "unknown", ["the queue does not answer; jobs wait until it does"]
    if weaknesses is None:
        return "ok", "unknown", ["the queue's server does not say whether it keeps what it is given"]
    return "ok", "weak" if weaknesses else "ok", [f"the queue may lose entries: {words}" for words in weaknesses]


def _check_dispatcher(services: Services) -> tuple[Literal["ok", "absent"], list[str]]:
    leader = current_leader(services.database, DISPATCHER)
    if leader is not None and leader.left_s > 0:
        return "ok", []
    reason = "no dispatcher leads" if leader is None else f"the dispatcher {leader.holder} fell silent"
    return "absent", [f"{reason}; lost jobs wait until one does"]
