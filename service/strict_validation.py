"""Routes that refuse whatever they would otherwise ignore.

That is an unknown query parameter, one that is repeated though it names one thing, a body that is not declared as JSON,
and a body or a condition that the route does not read.

Tested in `tests/attacks/test_h_http_as_written.py`.
"""

from collections.abc import Callable, Coroutine
from http import HTTPStatus
from typing import Any, Literal, get_args, get_origin

from fastapi import Request, Response
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute

from jobkit.errors import TooLargeError
from quadpatch_rules.strict_json import StrictJsonError, read_json
from service.body_limit import has_body
from service.content import precondition_failed
from service.digests import CheckedBody, refuse_coding
from service.problems import ProblemError, invalid_request, malformed_json

Handler = Callable[[Request], Coroutine[Any, Any, Response]]


class StrictRoute(APIRoute):
    """A route that refuses query parameters it does not know: a mistyped filter would silently match everything."""

    def get_route_handler(self) -> Handler:
        """Wrap FastAPI's handler."""
        handle = super().get_route_handler()
        known = _names(self.dependant, "query_params")
        lists = _lists(self.dependant)
        knows_if_match = "If-Match" in _names(self.dependant, "header_params")
        takes_upload = "requestBody" in (self.openapi_extra or {})

        async def handle_strictly(request: Request) -> Response:
            _check_query(request, known, known - lists)
            if not knows_if_match:
                _check_if_match(request)
            if self.body_field is not None:
                request = await _with_json_body(request, is_optional=not self.body_field.field_info.is_required())
            elif not takes_upload and has_body(request.scope):
                raise ProblemError(HTTPStatus.BAD_REQUEST, "unexpected_body", "this request takes no body")
            return await handle(request)

        return handle_strictly


def _check_query(request: Request, known: set[str], single: set[str]) -> None:
    names = [name for name, _ in request.query_params.multi_items()]
    unknown = [name for name in dict.fromkeys(names) if name not in known]
    if unknown:
        message = f"no such parameter; there are: {', '.join(sorted(known)) or 'none'}"
        raise invalid_request([{"loc": ("query", name), "msg": message, "type": "unknown"} for name in unknown])
    repeated = [name for name in single if names.count(name) > 1]
    if repeated:
        message = "the parameter comes more than once"
        raise invalid_request([{"loc": ("query", name), "msg": message, "type": "repeated"} for name in repeated])


def _check_if_match(request: Request) -> None:
    header = request.headers.get("if-match")
    if header is not None and header.strip() != "*":
        raise precondition_failed("If-Match can't hold: nothing here has a strong entity tag")


def _names(dependant: Dependant, kind: Literal["query_params", "header_params"]) -> set[str]:
    own = {parameter.alias for parameter in getattr(dependant, kind)}
    return own.union(*(_names(inner, kind) for inner in dependant.dependencies))


def _lists(dependant: Dependant) -> set[str]:
    """Name the query parameters that may be repeated."""
    own = {found.alias for found in dependant.query_params if _is_list(found.field_info.annotation)}
    return own.union(*(_lists(inner) for inner in dependant.dependencies))


def _is_list(annotation: Any) -> bool:
    return get_origin(annotation) is list or any(_is_list(part) for part in get_args(annotation))


class _BoundedRequest(Request):
    """A request whose JSON body is read once, up to a limit, and strictly."""

    async def read_json(self, max_bytes: int) -> None:
        checked, chunks, size = CheckedBody(self), [], 0
        async for chunk in checked.stream():
            size += len(chunk)
            if size > max_bytes:
                raise TooLargeError(f"the body has more than {max_bytes} bytes, which is the limit")
            chunks.append(chunk)
        checked.check()
        self._body = b"".join(chunks)
        try:
            self._json = read_json(self._body) if self._body else None
        except StrictJsonError as error:
            raise malformed_json(str(error)) from error


async def _with_json_body(request: Request, *, is_optional: bool) -> Request:
    if is_optional and not has_body(request.scope):
        return request
    refuse_coding(request.headers)
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json" and not (kind.startswith("application/") and kind.endswith("+json")):
        raise ProblemError(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            "unsupported_media_type",
            f"the body must be application/json; it is {kind or 'of no stated type'}",
        )
    bounded = _BoundedRequest(request.scope, request.receive)
    await bounded.read_json(request.app.state.max_json_bytes)
    return bounded
