"""HTTP with patience: what may be repeated is repeated, with growing pauses, until the time is up."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Self, TypeVar

import httpx
from pydantic import ValidationError

from quadpatch_client.errors import AnswerError, RefusedError
from quadpatch_client.patience import Line, Patience, TryAgainError, retry_after_s
from quadpatch_client.schema import PROBLEM_MEDIA_TYPE, Problem

T = TypeVar("T")

# Statuses that say: not now. A gateway in between may answer these without a problem document.
_TRY_AGAIN = frozenset({429, 502, 503, 504})
# Where nothing has ever taken a connection, a wrong address is likelier than a dropped line.
_FIRST_CONTACT_S = 5.0
_SILENCE_S, _CONNECT_S = 60.0, 5.0
_TIMEOUT = httpx.Timeout(_SILENCE_S, connect=_CONNECT_S)


def service_address(url: str) -> str:
    """Return the address of a service, without the `/v1` that begins the paths of its routes."""
    return url.rstrip("/").removesuffix("/v1").rstrip("/")


def _nothing() -> int:
    return 0


class Transport:
    """One service, reached over a line that may drop.

    Parameters
    ----------
    base_url : str
    api_key : str, optional
    patience_s : float
        How long a request is repeated before the service is taken for unreachable, in seconds from its first failure.
    first_contact_s : float
        The same as long as no connection has ever been made.
    """

    def __init__(
        self,
        base_url: str,
        api_key: str | None = None,
        patience_s: float = 60.0,
        first_contact_s: float = _FIRST_CONTACT_S,
    ) -> None:
        headers = {"Authorization": f"Bearer {api_key}"} if api_key else {}
        self.base_url = service_address(base_url)
        self._client = httpx.Client(base_url=self.base_url, headers=headers, timeout=_TIMEOUT)
        self._line = Line(self.base_url, patience_s, first_contact_s)

    def request(
        self,
        method: str,
        path: str,
        *,
        content: Callable[[], Iterator[bytes]] | None = None,
        **options: Any,
    ) -> httpx.Response:
        """Send a request that may be repeated without harm, and return a successful answer.

        Parameters
        ----------
        method, path : str
        content : callable, optional
            Makes the body anew for every try.
        **options
            As for `httpx.Client.request`.

        Raises
        ------
        UnreachableError
            If no answer came in time.
        RefusedError
            If the service answers with a problem.
        AnswerError
            If it answers with an error that is no problem document.
        """
        return self.patiently(
            lambda: self.send(method, path, content=None if content is None else content(), **options)
        )

    def send(self, method: str, path: str, *, content: Iterator[bytes] | None = None, **options: Any) -> httpx.Response:
        """Send a request once, as for `patiently`, and return a successful answer.

        Raises
        ------
        TryAgainError
            If the service asks to come back later.
        RefusedError, AnswerError
            If it answers with another error.
        """
        response = self._client.request(method, path, content=content, **options)
        _raise_for_problem(response)
        return response

    @contextmanager
    def stream(self, path: str, headers: Mapping[str, str], silence_s: float = _SILENCE_S) -> Iterator[httpx.Response]:
        """Open an answer whose body is read piece by piece; one try only.

        Parameters
        ----------
        path : str
        headers : mapping
        silence_s : float
            How long nothing may come before the line is taken for broken, in seconds.

        Raises
        ------
        TryAgainError
            If the service asks to come back later.
        RefusedError, AnswerError
            If it answers with another error.
        """
        timeout = httpx.Timeout(_SILENCE_S, connect=_CONNECT_S, read=silence_s)
        with self._client.stream("GET", path, headers=dict(headers), timeout=timeout) as response:
            if response.is_error:
                response.read()
                _raise_for_problem(response)
            yield response

    def patiently(self, attempt: Callable[[], T], done: Callable[[], int] = _nothing) -> T:
        """Try until it works, an answer forbids more tries, or the time is up.

        Parameters
        ----------
        attempt : callable
        done : callable, optional
            How many bytes all attempts together have brought; patience begins anew with each failure after more.
        """
        patience = Patience(self._line)
        while True:
            try:
                result = attempt()
            except (httpx.TransportError, TryAgainError) as error:
                time.sleep(patience.pause_s(error, done()))
            else:
                self._line.was_reached = True
                return result

    def close(self) -> None:
        """Close all connections."""
        self._client.close()

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()


def _raise_for_problem(response: httpx.Response) -> None:
    if not response.is_error:
        return
    error = _error_of(response)
    # 507 where the disk is full for now; without a time it is the quota of a tenant, which waiting does not change.
    is_full = response.status_code == httpx.codes.INSUFFICIENT_STORAGE and "Retry-After" in response.headers
    if response.status_code in _TRY_AGAIN or is_full:
        raise TryAgainError(error, retry_after_s(response))
    raise error


def _error_of(response: httpx.Response) -> Exception:
    if response.headers.get("Content-Type", "").startswith(PROBLEM_MEDIA_TYPE):
        try:
            return RefusedError(Problem.model_validate_json(response.content))
        except ValidationError:
            pass  # a problem document, but not one of this service
    status = f"{response.status_code} {response.reason_phrase}".strip()
    return AnswerError(f"{response.request.url} answered {status} without saying why; is it the right address?")
