"""Routes that take requests at their word: no unknown query parameter, no JSON that isn't called JSON."""

from collections.abc import Callable, Coroutine
from http import HTTPStatus
from typing import Any

from fastapi import Request, Response
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute

from jobkit.errors import TooLargeError
from jobkit.strict_json import StrictJsonError, read_json
from service.problems import ProblemError, invalid_request, malformed_json

Handler = Callable[[Request], Coroutine[Any, Any, Response]]


class StrictRoute(APIRoute):
    """A route that refuses query parameters it does not know: a mistyped filter would silently match everything."""

    def get_route_handler(self) -> Handler:
        """Wrap FastAPI's handler."""
        handle = super().get_route_handler()
        known = _query_names(self.dependant)
        has_json_body = self.body_field is not None

        async def handle_strictly(request: Request) -> Response:
            unknown = [name for name in request.query_params if name not in known]
            if unknown:
                message = f"no such parameter; there are: {', '.join(sorted(known)) or 'none'}"
                raise invalid_request([{"loc": ("query", name), "msg": message, "type": "unknown"} for name in unknown])
            if has_json_body:
                request = await _with_json_body(request)
            return await handle(request)

        return handle_strictly


def _query_names(dependant: Dependant) -> set[str]:
    own = {parameter.alias for parameter in dependant.query_params}
    return own.union(*(_query_names(inner) for inner in dependant.dependencies))


class _BoundedRequest(Request):
    """A request whose JSON body is read once, up to a limit, and strictly."""

    async def read_json(self, max_bytes: int) -> None:
        chunks, size = [], 0
        async for chunk in self.stream():
            size += len(chunk)
            if size > max_bytes:
                raise TooLargeError(f"the body has more than {max_bytes} bytes, which is the limit")
            chunks.append(chunk)
        self._body = b"".join(chunks)
        try:
            self._json = read_json(self._body) if self._body else None
        except StrictJsonError as error:
            raise malformed_json(str(error)) from error


async def _with_json_body(request: Request) -> Request:
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
