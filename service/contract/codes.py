"""The codes that a problem document of this service may have.

Tested in `tests/test_documents.py`.
"""

from collections.abc import Iterator, Mapping

from jobkit.errors import ConflictError, JobkitError, NotFoundError, QuotaError
from service.problems import STATUS_BY_ERROR

# Those that the service gives by itself; the others belong to errors of the contract.
OWN_CODES = (
    "checksum_mismatch",
    "digest_mismatch",
    "empty_file",
    "foreign_host",
    "foreign_origin",
    "foreign_tenant",
    "header_too_large",
    "http_error",
    "internal_error",
    "invalid_host",
    "invalid_request",
    "invalid_token",
    "issuer_unavailable",
    "malformed_body",
    "malformed_digest",
    "malformed_encoding",
    "malformed_json",
    "malformed_multipart",
    "malformed_request",
    "method_not_allowed",
    "not_ready",
    "precondition_failed",
    "range_not_satisfiable",
    "rate_limited",
    "request_timeout",
    "route_not_found",
    "scope_missing",
    "tenant_disabled",
    "tenant_missing",
    "too_many_bodies",
    "too_many_connections",
    "too_many_streams",
    "unauthorized",
    "unexpected_body",
    "unsupported_checksum",
    "unsupported_encoding",
    "unsupported_media_type",
    "unsupported_tus_version",
    "upload_damaged",
)
# What examples of errors show, by status.
EXAMPLE_CODES: Mapping[int, str] = {
    400: "malformed_json",
    401: "unauthorized",
    403: "scope_missing",
    404: "mesh_not_found",
    409: "idempotency_conflict",
    410: "result_missing",
    412: "precondition_failed",
    413: "body_too_large",
    415: "unsupported_media_type",
    416: "range_not_satisfiable",
    422: "invalid_request",
    429: "rate_limited",
    460: "checksum_mismatch",
    500: "internal_error",
    503: "database_unavailable",
    507: "store_full",
}
_BASES = (JobkitError, NotFoundError, ConflictError, QuotaError)


def problem_codes() -> list[str]:
    """Return all codes, sorted."""
    answered = {kind.code for kind in _all_errors(JobkitError) if kind not in _BASES and _has_status(kind)}
    return sorted({*OWN_CODES, *answered})


def _all_errors(base: type[JobkitError]) -> Iterator[type[JobkitError]]:
    yield base
    for child in base.__subclasses__():
        yield from _all_errors(child)


def _has_status(kind: type[JobkitError]) -> bool:
    return any(base in STATUS_BY_ERROR for base in kind.__mro__)
