"""One signed request to one receiver, by the rules of Standard Webhooks.

The name in the URL is resolved once, all its addresses are checked, and the connection goes to one of them; certificate
and Host header are those of the name. No redirect is followed, no proxy used, no cookie stored, no connection used
twice: two names may share an address, and a check of one is not a check of the other. What a receiver
answers besides its status is read up to a bound and discarded, so an inner service can't be read through this one.
"""

import asyncio
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from datetime import datetime
from functools import cached_property

import httpx
from standardwebhooks import Webhook

from dispatcher.backoff import read_retry_after
from jobkit.database.clock import utc_now
from jobkit.egress import Address, Destination, Networks, check_addresses, destination_of, resolve
from jobkit.errors import JobkitError

CONNECT_S = 5.0
MAX_ANSWER_BYTES = 16_384
_USER_AGENT = "Quadpatch-Webhooks/1"
_MAX_RESOLVERS = 32

LookUp = Callable[[Destination], Sequence[Address]]


@dataclass(frozen=True)
class Outgoing:
    """A message to send: its id for the receiver, its body, and the secrets that each sign it."""

    url: str
    message_id: str
    secrets: tuple[str, ...]
    body: str


@dataclass(frozen=True)
class Answer:
    """What came back: a status, or else an error; both where the status is a refusal."""

    status: int | None
    error: str | None
    retry_after_s: float | None
    milliseconds: int

    @property
    def is_delivered(self) -> bool:
        """Whether the receiver took the message."""
        return self.status is not None and 200 <= self.status < 300

    @property
    def is_gone(self) -> bool:
        """Whether the receiver wants no further messages: 410 Gone."""
        return self.status == httpx.codes.GONE


class Sender:
    """Sends messages.

    Parameters
    ----------
    allowed : networks
        Where messages may go besides the internet.
    timeout_s : float
        Most seconds of one request, from the look-up of the name to the end of the answer.
    look_up : callable
        Gives the addresses of a host; called once for each request.
    """

    def __init__(self, allowed: Networks, timeout_s: float, look_up: LookUp = resolve) -> None:
        self._allowed = allowed
        self._timeout_s = timeout_s
        self._look_up = look_up
        # Separate threads: names without an answer must not block other look-ups, or the database.
        self._resolvers = ThreadPoolExecutor(_MAX_RESOLVERS, "resolver")

    @cached_property
    def _transport(self) -> httpx.AsyncHTTPTransport:
        # The certificates of SSL_CERT_FILE, where it is set, but no proxy: it would resolve the name once more.
        limits = httpx.Limits(max_connections=None, max_keepalive_connections=0)
        return httpx.AsyncHTTPTransport(verify=httpx.create_ssl_context(), trust_env=False, limits=limits)

    async def send(self, outgoing: Outgoing) -> Answer:
        """Send a message; an error of the receiver or of the connection is an answer, too."""
        started, status, retry_after_s, error = time.monotonic(), None, None, None
        try:
            async with asyncio.timeout(self._timeout_s):
                response = await self._post(outgoing)
            status = response.status_code
            retry_after_s = read_retry_after(response.headers.get("retry-after"), utc_now())
            error = _refusal(response)
        except (httpx.HTTPError, httpx.InvalidURL, OSError, JobkitError) as failure:
            error = self._describe(failure)
        return Answer(status, error, retry_after_s, round(1000 * (time.monotonic() - started)))

    def close(self) -> None:
        """End the threads that resolve names."""
        self._resolvers.shutdown(wait=False, cancel_futures=True)

    async def _post(self, outgoing: Outgoing) -> httpx.Response:
        destination = destination_of(outgoing.url)
        addresses = await asyncio.get_running_loop().run_in_executor(self._resolvers, self._look_up, destination)
        check_addresses(destination, addresses, self._allowed)
        headers = signed_headers(outgoing, utc_now()) | {"Host": destination.authority}
        return await self._post_to_one_of(destination, addresses, headers, outgoing.body.encode())

    async def _post_to_one_of(
        self, destination: Destination, addresses: Sequence[Address], headers: dict[str, str], body: bytes
    ) -> httpx.Response:
        *others, last = addresses
        for address in others:
            try:
                return await self._post_to(destination, address, headers, body)
            except (httpx.ConnectError, httpx.ConnectTimeout):
                continue
        return await self._post_to(destination, last, headers, body)

    async def _post_to(
        self, destination: Destination, address: Address, headers: dict[str, str], body: bytes
    ) -> httpx.Response:
        target = destination.target.encode("ascii")
        url = httpx.URL(scheme=destination.scheme, host=str(address), port=destination.port, raw_path=target)
        timeout = httpx.Timeout(self._timeout_s, connect=min(CONNECT_S, self._timeout_s)).as_dict()
        extensions = {"timeout": timeout, "sni_hostname": destination.host}
        request = httpx.Request("POST", url, headers=headers, content=body, extensions=extensions)
        response = await self._transport.handle_async_request(request)
        try:
            await _drain(response)
        finally:
            await response.aclose()
        return response

    def _describe(self, failure: Exception) -> str:
        if isinstance(failure, JobkitError):
            return f"{failure.code}: {failure}"
        if isinstance(failure, httpx.ConnectTimeout):
            return "no connection in time"
        if isinstance(failure, httpx.TimeoutException | TimeoutError):
            return f"no answer within {self._timeout_s:g} s"
        if isinstance(failure, httpx.ConnectError):
            return f"no connection: {failure}"[:500]
        return f"no sound answer ({type(failure).__name__})"


def signed_headers(outgoing: Outgoing, now: datetime) -> dict[str, str]:
    """Return the headers of a message, signed with every secret, the newest first."""
    signatures = [Webhook(secret).sign(outgoing.message_id, now, outgoing.body) for secret in outgoing.secrets]
    return {
        "Content-Type": "application/json",
        "User-Agent": _USER_AGENT,
        "webhook-id": outgoing.message_id,
        "webhook-timestamp": str(int(now.timestamp())),
        "webhook-signature": " ".join(signatures),
    }


def _refusal(response: httpx.Response) -> str | None:
    if response.is_success:
        return None
    return f"answered {response.status_code}" + ("; redirects are not followed" if response.is_redirect else "")


async def _drain(response: httpx.Response) -> None:
    """Read an answer to its end, but not for long: one that never ends is cut off."""
    size = 0
    async for chunk in response.aiter_raw():
        size += len(chunk)
        if size > MAX_ANSWER_BYTES:
            return
