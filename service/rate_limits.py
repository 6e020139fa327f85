"""Rate limits: how many requests a tenant, or an address without a key, may send within a minute.

They are counted in Valkey, by the library `limits`, so that all processes of the API count together: in a window that
slides, of two counters. Valkey is no place of truth here: while it does not answer, requests are let pass uncounted.
A limit protects other tenants from one that asks too often, and to answer none of them protects nothing. Each such
outage is a line in the log, and `quadpatch_rate_limit_failures_total` counts.

The fields are those of draft-ietf-httpapi-ratelimit-headers in the form of structured fields (since its revision 08).

Tested in `tests/service/test_rate_limits.py`.
"""

import logging
import math
import time
from dataclasses import dataclass
from http import HTTPStatus

from limits import RateLimitItemPerMinute
from limits.aio.storage import RedisStorage
from limits.aio.strategies import SlidingWindowCounterRateLimiter
from prometheus_client import CollectorRegistry, Counter
from redis.asyncio import BlockingConnectionPool
from redis.exceptions import RedisError

from jobkit.settings import Settings
from service.problems import ProblemError

WINDOW_S = 60
# Requests wait for it: an outage must not be felt.
_TIMEOUT_S = 0.5
_MOST_CONNECTIONS = 32
# After a failure Valkey is not asked for so long.
_PAUSE_S = 1.0

_logger = logging.getLogger("service.rate_limits")


@dataclass(frozen=True)
class Policy:
    """How many requests within a minute; `name` stands in the fields of the answer."""

    name: str
    requests: int


class RateLimiter:
    """Counts requests.

    Parameters
    ----------
    settings : Settings
    registry : CollectorRegistry
        Where its counter of failures lives.
    """

    def __init__(self, settings: Settings, registry: CollectorRegistry) -> None:
        self.address = Policy("address", settings.address_requests_per_minute)
        self.health = Policy("health", settings.health_requests_per_minute)
        self._pool = BlockingConnectionPool.from_url(
            settings.redis_url.get_secret_value(),
            max_connections=_MOST_CONNECTIONS,
            timeout=_TIMEOUT_S,
            socket_timeout=_TIMEOUT_S,
            socket_connect_timeout=_TIMEOUT_S,
        )
        storage = RedisStorage(
            "async+redis://",
            implementation="redispy",
            key_prefix=f"{settings.queue_name}:rates",
            connection_pool=self._pool,  # type: ignore[arg-type]  # it goes to redis.asyncio.Redis, which takes one
        )
        self._limiter = SlidingWindowCounterRateLimiter(storage)
        self._failures = Counter(
            "quadpatch_rate_limit_failures",
            "Requests that were let pass uncounted, since Valkey did not answer.",
            registry=registry,
        )
        self._asks_again_at = 0.0

    async def count(self, policy: Policy, who: str) -> dict[str, str]:
        """Count a request; return the fields of its answer, none where there is no limit or it can't be counted.

        Raises
        ------
        ProblemError
            429 where it is one too many.
        """
        if not policy.requests:
            return {}
        if time.monotonic() < self._asks_again_at:
            self._failures.inc()
            return {}
        item = RateLimitItemPerMinute(policy.requests)
        try:
            is_within = await self._limiter.hit(item, policy.name, who)
            stats = await self._limiter.get_window_stats(item, policy.name, who)
        except (RedisError, OSError) as error:
            self._note_failure(error)
            return {}
        reset_s = min(max(math.ceil(stats.reset_time - time.time()), 1), WINDOW_S)
        fields = rate_fields(policy, stats.remaining if is_within else 0, reset_s)
        if is_within:
            return fields
        raise ProblemError(
            HTTPStatus.TOO_MANY_REQUESTS,
            "rate_limited",
            f"more than {policy.requests} requests within {WINDOW_S} s, which is the limit of policy {policy.name}",
            {**fields, "Retry-After": str(reset_s)},
        )

    async def close(self) -> None:
        """Close all connections."""
        await self._pool.disconnect()

    def _note_failure(self, error: Exception) -> None:
        self._failures.inc()
        self._asks_again_at = time.monotonic() + _PAUSE_S
        # The text of the error may hold the address, and a password with it.
        _logger.warning("requests pass uncounted, Valkey does not answer: %s", type(error).__name__)


def joined_fields(*counts: dict[str, str]) -> dict[str, str]:
    """Join the header fields of several counts: each field is a list of named policies."""
    names = dict.fromkeys(name for fields in counts for name in fields)
    return {name: ", ".join(fields[name] for fields in counts if name in fields) for name in names}


def rate_fields(policy: Policy, remaining: int, reset_s: int) -> dict[str, str]:
    """Write the header fields of a count.

    Parameters
    ----------
    policy : Policy
    remaining : int
        Requests that would still be answered.
    reset_s : int
        Seconds until there are more.
    """
    return {
        "RateLimit-Policy": f'"{policy.name}";q={policy.requests};w={WINDOW_S}',
        "RateLimit": f'"{policy.name}";r={remaining};t={reset_s}',
    }
