"""Authentication: API keys; without keys only requests from this machine and from pages of the same origin."""

import hashlib
import hmac
import ipaddress
from http import HTTPStatus

from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from jobkit.errors import SettingsError
from jobkit.settings import Settings
from service.host_header import Authority, parse_origin, plain_host, requested_authority
from service.problems import ProblemError, problem_response

PUBLIC_PATHS = frozenset({"/", "/healthz", "/readyz", "/openapi.yaml", "/openapi.json"})
METRICS_PATH = "/metrics"
LOCAL_PRINCIPAL = "local"
_LOCAL_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})
_SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})


def check_exposure(settings: Settings) -> None:
    """Raise SettingsError where the service would listen to others without a key."""
    if not settings.key_list and not is_loopback(settings.host):
        raise SettingsError(
            f"QUADPATCH_HOST is {settings.host}, which other machines can reach, and QUADPATCH_API_KEYS is empty; "
            "set keys, or listen on 127.0.0.1"
        )


def is_loopback(host: str) -> bool:
    """Return whether only this machine reaches the address."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def public_paths(settings: Settings) -> frozenset[str]:
    """Return the paths that answer without a key."""
    return PUBLIC_PATHS | {METRICS_PATH} if settings.metrics_open else PUBLIC_PATHS


class KeyRing:
    """The accepted keys, as hashes: a dump of the memory of this process does not show them."""

    def __init__(self, keys: list[str]) -> None:
        self._hashes = [hashlib.sha256(key.encode()).digest() for key in keys]

    def principal(self, key: str) -> str | None:
        """Return a name for the holder of a key, None for a wrong key; takes as long for either."""
        digest = hashlib.sha256(key.encode("utf-8", "surrogateescape")).digest()
        matches = [hmac.compare_digest(digest, known) for known in self._hashes]
        return f"key-{digest.hex()[:16]}" if any(matches) else None


class AuthMiddleware:
    """Lets a request pass if it carries a key, or, where there are none, if it comes from this machine's user."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self._app = app
        self._keys = KeyRing(settings.key_list) if settings.key_list else None
        self._public_paths = public_paths(settings)
        self._own_names = _LOCAL_NAMES | {plain_host(settings.host)}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer it with 401 or 403."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope, receive)
        try:
            request.state.principal = self._principal(request)
        except ProblemError as error:
            await problem_response(request, error)(scope, receive, send)
            return
        await self._app(scope, receive, send)

    def _principal(self, request: Request) -> str:
        authority = requested_authority(request.scope)
        if self._keys is None:
            self._refuse_foreign_pages(request, authority)
            return LOCAL_PRINCIPAL
        if request.scope["path"] in self._public_paths:
            return "anonymous"
        principal = self._keys.principal(presented_key(request))
        if principal is None:
            raise ProblemError(
                HTTPStatus.UNAUTHORIZED,
                "unauthorized",
                "send a valid key as 'Authorization: Bearer KEY' or 'X-API-Key: KEY'",
                {"WWW-Authenticate": 'Bearer realm="quadpatch"'},
            )
        return principal

    def _refuse_foreign_pages(self, request: Request, authority: Authority | None) -> None:
        # A page from elsewhere can make the user's browser call this machine. Its name then stands in Origin, or,
        # when its own name was made to mean 127.0.0.1, in Host.
        if authority is None or authority.host not in self._own_names:
            raise ProblemError(
                HTTPStatus.FORBIDDEN, "foreign_host", "without API keys this service answers to its local names only"
            )
        origin = request.headers.get("origin")
        if request.method not in _SAFE_METHODS and origin is not None and parse_origin(origin) != authority:
            raise ProblemError(
                HTTPStatus.FORBIDDEN, "foreign_origin", "pages of another origin may not change anything here"
            )


def presented_key(request: Request) -> str:
    """Return the key that the request carries, or nothing."""
    scheme, _, token = request.headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer" and token:
        return token.strip()
    return request.headers.get("x-api-key", "")
