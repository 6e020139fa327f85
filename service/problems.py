"""Errors of HTTP requests, and the translation of every error into an RFC 9457 problem.

Only this module gives the contract's errors an HTTP status.

Tested in `tests/service/test_handlers.py`.
"""

import math
from collections.abc import Mapping, Sequence
from enum import IntEnum
from http import HTTPStatus
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse

from jobkit import errors
from jobkit.models import errors as model_errors
from quadpatch_client.schema import PROBLEM_MEDIA_TYPE, FieldError, Problem, ProblemQuota
from quadpatch_rules.text import printable

# The narrowest class decides; classes that are not here are faults of this service.
STATUS_BY_ERROR: Mapping[type[errors.JobkitError], HTTPStatus] = {
    errors.ResultMissingError: HTTPStatus.GONE,
    errors.ObjectDamagedError: HTTPStatus.GONE,
    errors.NotFoundError: HTTPStatus.NOT_FOUND,
    errors.ConflictError: HTTPStatus.CONFLICT,
    errors.OverLimitError: HTTPStatus.FORBIDDEN,
    errors.AddressRefusedError: HTTPStatus.FORBIDDEN,
    errors.TlsRequiredError: HTTPStatus.FORBIDDEN,
    errors.UploadFinalError: HTTPStatus.FORBIDDEN,
    errors.TooManyUploadsError: HTTPStatus.SERVICE_UNAVAILABLE,
    errors.StoreFullError: HTTPStatus.INSUFFICIENT_STORAGE,
    errors.StorageQuotaError: HTTPStatus.INSUFFICIENT_STORAGE,
    errors.JobQuotaError: HTTPStatus.TOO_MANY_REQUESTS,
    errors.StreamQuotaError: HTTPStatus.TOO_MANY_REQUESTS,
    errors.TooLargeError: HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
    errors.UnusableModelError: HTTPStatus.UNPROCESSABLE_ENTITY,
    errors.OptionsConflictError: HTTPStatus.UNPROCESSABLE_ENTITY,
    errors.QueueUnavailableError: HTTPStatus.SERVICE_UNAVAILABLE,
    errors.DatabaseUnavailableError: HTTPStatus.SERVICE_UNAVAILABLE,
    errors.StoreUnavailableError: HTTPStatus.SERVICE_UNAVAILABLE,
}
_RETRY_LATER = (
    errors.MeshNotReadyError,
    errors.JobNotFinishedError,
    errors.BatchNotFinishedError,
    errors.TooManyUploadsError,
    model_errors.ModelNotProvenError,
    errors.QueueUnavailableError,
    errors.DatabaseUnavailableError,
    errors.StoreUnavailableError,
)
RETRY_AFTER_S = "2"
# A job starts, a stream ends, the sweep makes room: that takes longer than an outage that passes.
_RETRY_AFTER_A_WHILE_S = "10"
_WAITING_HELPS = (errors.JobQuotaError, errors.StreamQuotaError, errors.StoreFullError)

# A body of a megabyte may hold a hundred thousand wrong fields; its sender corrects some and tries again.
MOST_FIELD_ERRORS = 50
_LONGEST_VALUE = 200
# Fields of a spec that hold one of several models, told apart by a tag.
_UNIONS = (("method",), ("restore", "missing"), ("denoise", "region"))


class TusStatus(IntEnum):
    """The status of the protocol tus that HTTP does not know."""

    CHECKSUM_MISMATCH = 460

    @property
    def phrase(self) -> str:
        """The status in words."""
        return self.name.replace("_", " ").title()


class ProblemError(Exception):
    """An error of the request itself, with its status.

    Parameters
    ----------
    status : HTTPStatus or TusStatus
    code : str
        Stable, meant for programs.
    detail : str
        A sentence for people.
    headers : mapping, optional
    field_errors : sequence of FieldError, optional
    """

    def __init__(
        self,
        status: HTTPStatus | TusStatus,
        code: str,
        detail: str,
        headers: Mapping[str, str] | None = None,
        field_errors: Sequence[FieldError] = (),
    ) -> None:
        super().__init__(detail)
        self.status, self.code, self.detail = status, code, printable(detail)
        self.headers, self.field_errors = dict(headers or {}), list(field_errors)
        self.quota: ProblemQuota | None = None


def to_problem_error(error: errors.JobkitError) -> ProblemError:
    """Give an error of the contract its status; one that is no fault of the request becomes a 500 without details."""
    for kind in type(error).__mro__:
        status = STATUS_BY_ERROR.get(kind)
        if status is not None:
            headers = {"Retry-After": RETRY_AFTER_S} if isinstance(error, _RETRY_LATER) else {}
            if isinstance(error, _WAITING_HELPS):
                headers = {"Retry-After": _RETRY_AFTER_A_WHILE_S}
            problem = ProblemError(status, error.code, str(error), headers)
            if isinstance(error, errors.QuotaError):
                problem.quota = ProblemQuota(limit=error.limit, used=error.used)
            return problem
    return internal_error()


def internal_error() -> ProblemError:
    """Return the answer to a fault of this service; what happened stands in the log under the request's id."""
    return ProblemError(HTTPStatus.INTERNAL_SERVER_ERROR, "internal_error", "the service failed; its log says why")


def problem_response(request: Request, error: ProblemError) -> JSONResponse:
    """Write the error as a problem document."""
    problem = Problem(
        type=f"urn:quadpatch:problem:{error.code}",
        title=error.status.phrase,
        status=error.status.value,
        code=error.code,
        detail=error.detail,
        instance=f"urn:quadpatch:request:{getattr(request.state, 'request_id', 'unknown')}",
        retryable="Retry-After" in error.headers,
        errors=error.field_errors,
        quota=error.quota,
    )
    return JSONResponse(
        problem.model_dump(mode="json", exclude_none=True),
        error.status.value,
        headers=error.headers,
        media_type=PROBLEM_MEDIA_TYPE,
    )


def invalid_request(details: Sequence[Mapping[str, Any]], root: str | None = None) -> ProblemError:
    """Turn pydantic's errors into a problem with one entry per field, for the first `MOST_FIELD_ERRORS`.

    Parameters
    ----------
    details : sequence of mapping
        As pydantic and FastAPI list them.
    root : str, optional
        What the locations are relative to; None: they start with `body`, `query`, `path` or `header`.
    """
    fields = [_field_error(detail, root) for detail in details[:MOST_FIELD_ERRORS]]
    places = ", ".join(dict.fromkeys(f"{field.location} {field.pointer}".strip() for field in fields))
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY, "invalid_request", f"the request is not valid: {places}", None, fields
    )


def malformed_json(reason: str) -> ProblemError:
    """Return the answer to a body that is no JSON."""
    return ProblemError(HTTPStatus.BAD_REQUEST, "malformed_json", f"the body is no JSON: {reason}")


def _field_error(detail: Mapping[str, Any], root: str | None) -> FieldError:
    steps = [str(step) for step in detail["loc"]]
    location = root or steps.pop(0)
    is_body = location == "body"
    where = _without_tag(steps)
    pointer = "".join("/" + step.replace("~", "~0").replace("/", "~1") for step in where) if is_body else where[-1]
    message = printable(str(detail["msg"]))
    values = {name: value for name, value in detail.get("ctx", {}).items() if _is_plain(value)}
    return FieldError(
        location=location, pointer=printable(pointer), message=message, code=str(detail["type"]), values=values or None
    )


def _is_plain(value: object) -> bool:
    """Whether a value of pydantic's context may go into an answer: no bytes of the request, and nothing long."""
    if isinstance(value, str):
        return len(value) <= _LONGEST_VALUE and printable(value) == value
    return isinstance(value, int | float) and math.isfinite(value)


def _without_tag(where: list[str]) -> list[str]:
    """Take out of a location the tag of a union, which stands in no document."""
    # A spec is the whole body, a part of it, or one of many.
    start = {"spec": 1, "jobs": 2}.get(where[0] if where else "", 0)
    for union in _UNIONS:
        end = start + len(union)
        if tuple(where[start:end]) == union:
            return [*where[:end], *where[end + 1 :]]
    return where
