"""What every request of a tenant passes: whether the tenant is disabled, and whether it asks too often.

What holds for a tenant is known for two seconds, so a change takes no longer. In an outage of the database requests
pass here: those that need it are refused where they ask for it.

Tested in `tests/service/test_rate_limits.py`.
"""

from http import HTTPStatus

import anyio.to_thread
from cachetools import TTLCache
from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from jobkit.access.keys import Holder
from jobkit.access.tenants import Tenants
from jobkit.database.session import Database
from jobkit.errors import DatabaseError, DatabaseUnavailableError
from quadpatch_client.schema import Quotas
from service.auth import ANONYMOUS, address_of
from service.problems import ProblemError, problem_response
from service.rate_limits import Policy, RateLimiter, joined_fields

HEALTH_PATHS = frozenset({"/healthz", "/readyz"})
_KNOWN_FOR_S = 2.0
_MOST_KNOWN = 10_000


class TenantStates:
    """Quotas of tenants, and whether they are disabled."""

    def __init__(self) -> None:
        self._known: TTLCache[str, tuple[Quotas, bool]] = TTLCache(_MOST_KNOWN, _KNOWN_FOR_S)

    async def of(self, database: Database, tenant: str) -> tuple[Quotas, bool]:
        """Return what holds for a tenant; in an outage of the database, nothing does."""
        known = self._known.get(tenant)
        if known is None:
            try:
                known = await anyio.to_thread.run_sync(Tenants(database).state, tenant)
            except (DatabaseUnavailableError, DatabaseError):
                return Quotas(), False
            self._known[tenant] = known
        return known


class SharesMiddleware:
    """Refuses requests of disabled tenants, and of those who ask too often; says in each answer what is left."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._states = TenantStates()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer it with 403 or 429."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        try:
            fields = await self._count(request, request.state.principal)
        except ProblemError as error:
            await problem_response(request, error)(scope, receive, send)
            return

        async def send_with_fields(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(fields)
            await send(message)

        await self._app(scope, receive, send_with_fields if fields else send)

    async def _count(self, request: Request, principal: Holder) -> dict[str, str]:
        rates: RateLimiter = request.app.state.rates
        if principal is ANONYMOUS:
            policy = rates.health if request.scope["path"] in HEALTH_PATHS else rates.address
            return await rates.count(policy, address_of(request))
        quotas, is_disabled = await self._states.of(request.app.state.services.database, principal.tenant)
        if is_disabled:
            raise ProblemError(HTTPStatus.FORBIDDEN, "tenant_disabled", f"tenant {principal.tenant} is disabled")
        # Its own limit first: a key that asks too often takes nothing of what its tenant may send.
        of_key = await rates.count(Policy("key", principal.requests_per_minute), principal.key_id)
        of_tenant = await rates.count(Policy("tenant", quotas.requests_per_minute), principal.tenant)
        return joined_fields(of_key, of_tenant)
