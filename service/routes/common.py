"""What routes share: parameters, documented problems, JSON responses with entity tags.

Tested in `tests/service/routes/test_jobs.py`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import Depends, Header, Path, Request
from pydantic import BaseModel
from starlette.responses import Response

from jobkit.access.keys import Holder
from jobkit.database.idempotency import Idempotency
from quadpatch_client.schema import Job, Problem
from quadpatch_client.schema.base import EXAMPLE_BATCH_ID, EXAMPLE_JOB_ID, EXAMPLE_SHA256, NAME_PATTERN
from quadpatch_client.schema.webhooks import EXAMPLE_WEBHOOK_ID
from quadpatch_rules.ids import BATCH_ID_PATTERN, JOB_ID_PATTERN, SHA256_PATTERN, WEBHOOK_ID_PATTERN
from service.content import etag_matches
from service.idempotency import idempotency_of
from service.problems import RETRY_AFTER_S
from service.services import PrincipalDep

JobIdPath = Annotated[str, Path(pattern=JOB_ID_PATTERN, description="Id of a job.", examples=[EXAMPLE_JOB_ID])]
BatchIdPath = Annotated[str, Path(pattern=BATCH_ID_PATTERN, description="Id of a batch.", examples=[EXAMPLE_BATCH_ID])]
MeshIdPath = Annotated[
    str,
    Path(
        pattern=SHA256_PATTERN, description="Id of a mesh: the sha256 of its bytes, in hex.", examples=[EXAMPLE_SHA256]
    ),
]
WebhookIdPath = Annotated[
    str, Path(pattern=WEBHOOK_ID_PATTERN, description="Id of a subscription.", examples=[EXAMPLE_WEBHOOK_ID])
]
ModelNamePath = Annotated[
    str, Path(pattern=NAME_PATTERN, description="Name of a model.", examples=["general-dictionary"])
]
AliasPath = Annotated[str, Path(pattern=NAME_PATTERN, description="An alias.", examples=["candidate"])]
VersionPath = Annotated[int, Path(ge=1, le=2**31 - 1, description="Number of a version.", examples=[1])]
IdempotencyKey = Annotated[
    str | None,
    Header(
        alias="Idempotency-Key",
        pattern=r"^[!-~]{1,255}$",
        description="Any string of your own. A repeated request with the same key makes nothing twice: it gets "
        "what the first one made. Keys of jobs expire with their job, others after seven days.",
        examples=["order-17-part-3"],
    ),
]


@dataclass(frozen=True)
class Caller:
    """Who sends a request, and under which idempotency key."""

    principal: Holder
    key: str | None

    def idempotency(self, *request: str) -> Idempotency | None:
        """Return the key for what the request asks for: its operation, and everything that it says."""
        return idempotency_of(self.principal.key_id, self.key, *request)


async def _get_caller(principal: PrincipalDep, key: IdempotencyKey = None) -> Caller:
    return Caller(principal, key)


CallerDep = Annotated[Caller, Depends(_get_caller)]
IfNoneMatch = Annotated[
    str | None,
    Header(alias="If-None-Match", description="Entity tags; the answer is 304 where one still holds."),
]


def _conditional_headers(
    byte_range: Annotated[
        str | None,
        Header(alias="Range", description="One range of bytes, `bytes=0-1023`; anything else gets the whole."),
    ] = None,
    if_range: Annotated[
        str | None, Header(alias="If-Range", description="Entity tag that the range is meant for.")
    ] = None,
    if_match: Annotated[
        str | None, Header(alias="If-Match", description="Entity tags; the answer is 412 where none of them holds.")
    ] = None,
    if_none_match: IfNoneMatch = None,
) -> None:
    """Document the headers that `service.content` reads."""


CONDITIONAL = [Depends(_conditional_headers)]

BINARY: Mapping[str, Any] = {"type": "string", "format": "binary"}
FILE: Mapping[str, Any] = {**BINARY, "minLength": 1}
_ALWAYS = (401, 403, 422, 429, 500, 503)
MEANINGS = {
    304: "What the entity tag names has not changed.",
    400: "The body can't be read.",
    401: "No valid key.",
    403: "Not allowed, or over what the service grants.",
    404: "There is no such thing.",
    409: "Not possible in the present state.",
    410: "It was there, and the store has lost it.",
    412: "If-Match names other bytes, or the version of the protocol is another one.",
    413: "The body is over the limit.",
    415: "The body is of a type that is not read here.",
    416: "The range lies outside.",
    422: "The request is not valid.",
    429: "Too many requests, jobs or event streams of the tenant, or too many requests from the address.",
    460: "The checksum is not that of the bytes.",
    500: "A fault of the service.",
    503: "Database, store or queue do not answer.",
    507: "The disk has no room for it, or the tenant stores what it may.",
}


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Document the problems of a route; those that every route may answer with are added."""
    return {status: {"model": Problem, "description": MEANINGS[status]} for status in sorted({*statuses, *_ALWAYS})}


def not_modified() -> dict[int | str, dict[str, Any]]:
    """Document a 304."""
    return {304: {"description": MEANINGS[304]}}


def described_header(description: str) -> dict[str, Any]:
    """Document a response header that is always sent."""
    return {"description": description, "required": True, "schema": {"type": "string"}}


def deprecation_described() -> dict[str, Any]:
    """Document the header of a version that should be used no more."""
    text = "Since when the model version is deprecated (RFC 9745); only where it is."
    return {"Deprecation": {"description": text, "schema": {"type": "string"}}}


def linked(operation: str, expression: str, parameter: str) -> dict[str, Any]:
    """Document which operation follows from a response, and where its parameter stands."""
    return {"operationId": operation, "parameters": {parameter: expression}}


def json_response(model: BaseModel, status: HTTPStatus = HTTPStatus.OK, **headers: str) -> Response:
    """Write a wire model; underscores in header names stand for dashes."""
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    return Response(model.model_dump_json(), status, named, "application/json")


def job_response(job: Job, status: HTTPStatus | None = None, **headers: str) -> Response:
    """Write a job: 200 once it has ended, 202 before, with what a poller needs."""
    if not job.state.is_terminal:
        headers["Retry_After"] = RETRY_AFTER_S
    if job.model.deprecated_at is not None:
        headers |= deprecation_header(job.model.deprecated_at)
    usual = HTTPStatus.OK if job.state.is_terminal else HTTPStatus.ACCEPTED
    return json_response(job, status or usual, ETag=job_etag(job), Location=job.links.self, **headers)


def job_etag(job: Job) -> str:
    """Return the entity tag of a job."""
    return etag_of(job.revision, job.queue_position, job.pinned)


def deprecation_header(since: datetime) -> dict[str, str]:
    """Return the header of a deprecation (RFC 9745)."""
    return {"Deprecation": f"@{int(since.timestamp())}"}


def etag_of(revision: int, queue_position: int | None, is_pinned: bool) -> str:
    """Return the entity tag of a job that stands like this.

    Each change of its own raises its revision; its place in the queue and its pin change without. The estimate of the
    time that is left changes with the clock; that it is left out makes the tag a weak one.
    """
    place = "" if queue_position is None else f"-{queue_position}"
    return f'W/"{revision}{place}{"-pinned" if is_pinned else ""}"'


def is_unchanged(request: Request, etag: str) -> bool:
    """Return whether the client already has what the tag names."""
    return etag_matches(request.headers.get("if-none-match"), etag)
