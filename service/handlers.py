"""Exception handlers: every error is answered with a problem document."""

from collections.abc import Sequence
from http import HTTPStatus

from fastapi import FastAPI
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Route

from jobkit.errors import JobkitError
from service.problems import ProblemError, invalid_request, malformed_json, problem_response, to_problem_error

_CODES = {
    HTTPStatus.BAD_REQUEST: "malformed_body",
    HTTPStatus.NOT_FOUND: "route_not_found",
    HTTPStatus.METHOD_NOT_ALLOWED: "method_not_allowed",
}


def install_handlers(app: FastAPI, routes: Sequence[BaseRoute]) -> None:
    """Make the app answer every error with a problem document; `routes` are those that it knows."""

    @app.exception_handler(ProblemError)
    async def on_problem(request: Request, error: ProblemError) -> Response:
        return problem_response(request, error)

    @app.exception_handler(JobkitError)
    async def on_jobkit_error(request: Request, error: JobkitError) -> Response:
        return problem_response(request, to_problem_error(error))

    @app.exception_handler(RequestValidationError)
    async def on_invalid_request(request: Request, error: RequestValidationError) -> Response:
        details = error.errors()
        if any(detail["type"] == "json_invalid" for detail in details):
            return problem_response(request, malformed_json(str(details[0].get("ctx", {}).get("error", ""))))
        return problem_response(request, invalid_request(details))

    @app.exception_handler(ClientDisconnect)
    async def on_disconnect(request: Request, error: ClientDisconnect) -> Response:
        # The client has disconnected; the status only shows in the access log.
        return Response(status_code=HTTPStatus.BAD_REQUEST)

    @app.exception_handler(HTTPException)
    async def on_http_error(request: Request, error: HTTPException) -> Response:
        status, path = HTTPStatus(error.status_code), request.scope["path"]
        headers = dict(error.headers or {})
        if status == HTTPStatus.METHOD_NOT_ALLOWED:
            headers["Allow"] = ", ".join(allowed_methods(routes, path))
        details = {
            HTTPStatus.NOT_FOUND: f"there is nothing at {path}",
            HTTPStatus.METHOD_NOT_ALLOWED: f"{request.method} is not possible at {path}",
        }
        detail = details.get(status, str(error.detail))
        return problem_response(request, ProblemError(status, _CODES.get(status, "http_error"), detail, headers))


def allowed_methods(routes: Sequence[BaseRoute], path: str) -> list[str]:
    """Return all methods at a path. The router itself only knows those of the first route that fits."""
    fitting = [route for route in routes if isinstance(route, Route) and route.path_regex.match(path)]
    methods = set().union(*(route.methods or () for route in fitting)) or {"GET"}
    return sorted(methods | {"HEAD"} if "GET" in methods else methods)
