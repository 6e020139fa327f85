"""Authentication: keys and tokens; without any only requests from this machine and from pages of the same origin."""

import hmac
import ipaddress
from http import HTTPStatus
from pathlib import Path

import anyio.to_thread
from cachetools import TTLCache
from sqlalchemy.engine import make_url
from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from jobkit.access.keys import PREFIX, Holder, Keys, digest_of
from jobkit.database.session import Database
from jobkit.database.tenancy import DEFAULT_TENANT
from jobkit.errors import DatabaseError, DatabaseUnavailableError, JobkitError, SettingsError
from jobkit.settings import Settings
from quadpatch_client.schema import Scope as KeyScope
from service.host_header import Authority, parse_origin, plain_host, requested_authority
from service.problems import ProblemError, problem_response, to_problem_error
from service.rate_limits import RateLimiter
from service.tokens import TokenVerifier, is_token

_DOCUMENTATION = (
    "docs",
    "docs/docs.js",
    "docs/swagger-ui-bundle.js",
    "docs/swagger-ui.css",
    "openapi.json",
    "openapi.yaml",
)
_PAGE = ("", "page/page.js", "page/page.css", "page/icon.svg", "page/licences.txt")
PUBLIC_PATHS = frozenset({"/healthz", "/readyz", *(f"/{path}" for path in (*_DOCUMENTATION, *_PAGE))})
METRICS_PATH = "/metrics"
ALL_SCOPES = frozenset(KeyScope)
# Who asks without a key: from this machine, where none is needed, and for what is public.
LOCAL = Holder("local", "", DEFAULT_TENANT, ALL_SCOPES)
ANONYMOUS = Holder("anonymous", "", DEFAULT_TENANT, ALL_SCOPES)
_KNOWN_FOR_S = 2.0
_MOST_KNOWN = 10_000
_LOCAL_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})
_SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})


def check_exposure(settings: Settings) -> None:
    """Raise SettingsError where the service would listen to others without a key."""
    has_some = settings.key_list or settings.oidc_issuer
    if not has_some and not is_loopback(settings.host) and not _has_keys(settings):
        raise SettingsError(
            f"QUADPATCH_HOST is {settings.host}, which other machines can reach, QUADPATCH_API_KEYS is empty, and no "
            f"key is in {shown_database(settings)}; set keys, make one there (python -m service keys create NAME), or "
            "listen on 127.0.0.1"
        )


def shown_database(settings: Settings) -> str:
    """Name the database for people: its file, or its address without the password."""
    url = make_url(settings.effective_database_url)
    is_file = url.get_backend_name() == "sqlite" and bool(url.database)
    return str(url.database) if is_file else url.render_as_string(hide_password=True)


def _has_keys(settings: Settings) -> bool:
    """Tell whether keys were made; a database that does not answer, or is not there yet, has none."""
    url = make_url(settings.effective_database_url)
    if url.get_backend_name() == "sqlite" and not Path(url.database or "").is_file():
        return False
    database = Database(settings.effective_database_url)
    try:
        return Keys(database).are_there()
    except (DatabaseError, DatabaseUnavailableError):
        return False
    finally:
        database.close()


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
    """The accepted keys: those of the settings, as hashes, and those of the database, which are looked up.

    What was looked up is known for two seconds, so a key that is revoked is taken no longer than that.

    Parameters
    ----------
    keys : list of str
        Of the settings: of the default tenant, for everything.
    """

    def __init__(self, keys: list[str]) -> None:
        self._digests = [digest_of(key) for key in keys]
        # In tuples: what is known may be that there is no holder.
        self._found: TTLCache[str, tuple[Holder | None]] = TTLCache(_MOST_KNOWN, _KNOWN_FOR_S)
        self._are_made: TTLCache[None, tuple[bool]] = TTLCache(1, _KNOWN_FOR_S)

    def of_settings(self, key: str) -> Holder | None:
        """Return the holder of a key of the settings; takes as long for a wrong key."""
        digest = digest_of(key)
        matches = [hmac.compare_digest(digest, known) for known in self._digests]
        return Holder(f"key-{digest[:16]}", "settings", DEFAULT_TENANT, ALL_SCOPES) if any(matches) else None

    async def is_needed(self, keys: Keys) -> bool:
        """Tell whether requests need a key: where one is set, or was ever made."""
        if self._digests:
            return True
        # An entry may expire at any moment, so it is read once.
        known = self._are_made.get(None) or (await anyio.to_thread.run_sync(keys.are_there),)
        self._are_made.setdefault(None, known)
        return known[0]

    async def holder(self, key: str, keys: Keys) -> Holder | None:
        """Return the holder of a key, None for a wrong one."""
        holder = self.of_settings(key)
        if holder is not None or not key.startswith(PREFIX):
            return holder
        digest = digest_of(key)
        known = self._found.get(digest) or (await anyio.to_thread.run_sync(keys.holder, digest),)
        self._found.setdefault(digest, known)
        return known[0]


class AuthMiddleware:
    """Lets a request pass if it carries a key, or, where there are none, if it comes from this machine's user."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self._app = app
        self._keys = KeyRing(settings.key_list)
        self._tokens = TokenVerifier(settings) if settings.oidc_issuer else None
        self._public_paths = public_paths(settings)
        self._own_names = _LOCAL_NAMES | {plain_host(settings.host)}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer it with 401 or 403."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope, receive)
        try:
            request.state.principal = await self._principal(request)
        except (ProblemError, JobkitError) as error:
            problem = error if isinstance(error, ProblemError) else to_problem_error(error)
            if problem.status == HTTPStatus.UNAUTHORIZED:
                problem = await _counted(request, problem)
            await problem_response(request, problem)(scope, receive, send)
            return
        await self._app(scope, receive, send)

    async def _principal(self, request: Request) -> Holder:
        authority, keys = requested_authority(request.scope), Keys(request.app.state.services.database)
        is_public = request.scope["path"] in self._public_paths
        is_needed = await self._is_needed(keys, is_public=is_public)
        if is_needed and is_public:
            return ANONYMOUS
        holder = await self._holder(presented_key(request), keys)
        if holder is None and not is_needed:
            self._refuse_foreign_pages(request, authority)
            return LOCAL
        if holder is None:
            raise ProblemError(
                HTTPStatus.UNAUTHORIZED,
                "unauthorized",
                "send a valid key as 'Authorization: Bearer KEY' or 'X-API-Key: KEY'",
                {"WWW-Authenticate": 'Bearer realm="quadpatch"'},
            )
        return holder

    async def _holder(self, key: str, keys: Keys) -> Holder | None:
        # A key of the settings may have any shape.
        if self._tokens is not None and is_token(key) and self._keys.of_settings(key) is None:
            return await self._tokens.holder(key)
        return await self._keys.holder(key, keys)

    async def _is_needed(self, keys: Keys, *, is_public: bool) -> bool:
        if self._tokens is not None:
            return True
        try:
            return await self._keys.is_needed(keys)
        except (DatabaseUnavailableError, DatabaseError):
            # Signs of life are given in an outage, too.
            if is_public:
                return True
            raise

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


def address_of(request: Request) -> str:
    """Return the address that a request came from."""
    return request.client.host if request.client else "unknown"


async def _counted(request: Request, refusal: ProblemError) -> ProblemError:
    """Count a request without a valid key; return its refusal, a 429 where its address has sent too many."""
    rates: RateLimiter = request.app.state.rates
    try:
        refusal.headers |= await rates.count(rates.address, address_of(request))
    except ProblemError as error:
        return error
    return refusal


def presented_key(request: Request) -> str:
    """Return the key that the request carries, or nothing."""
    scheme, _, token = request.headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer" and token:
        return token.strip()
    return request.headers.get("x-api-key", "")
