"""HTTP with patience: what may be repeated is repeated, with growing pauses, until the time is up."""

import random
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Self, TypeVar

import httpx
from pydantic import ValidationError
from tenacity import RetryCallState, Retrying, retry_if_exception_type, stop_before_delay, wait_exponential

from quadpatch_client.errors import AnswerError, RefusedError, UnreachableError
from quadpatch_client.schema import PROBLEM_MEDIA_TYPE, Problem

T = TypeVar("T")

# Statuses that say: not now. A gateway in between may answer these without a problem document.
_TRY_AGAIN = frozenset({429, 502, 503, 504})
_PAUSE_S = wait_exponential(multiplier=0.25, max=5.0)
# Where nothing has ever taken a connection, a wrong address is likelier than a dropped line.
_FIRST_CONTACT_S = 5.0
_SILENCE_S, _CONNECT_S = 60.0, 5.0
_TIMEOUT = httpx.Timeout(_SILENCE_S, connect=_CONNECT_S)
# No connection was made, so that nothing says that a service is there.
_NOT_REACHED = (httpx.ConnectError, httpx.ConnectTimeout, httpx.UnsupportedProtocol)


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
        self.base_url = base_url.rstrip("/")
        self._client = httpx.Client(base_url=self.base_url, headers=headers, timeout=_TIMEOUT)
        self._patience_s = patience_s
        self._first_contact_s = first_contact_s
        self._was_reached = False

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
        most = -1

        def note_failure(state: RetryCallState) -> None:
            nonlocal most
            self._was_reached = self._was_reached or not isinstance(_error(state), _NOT_REACHED)
            # Not from the first try: an upload that breaks after minutes is tried again.
            if done() > most:
                most, state.attempt_number = done(), 1
                state.start_time = state.outcome_timestamp or state.start_time

        retrying = Retrying(
            retry=retry_if_exception_type((httpx.TransportError, TryAgainError)),
            after=note_failure,
            wait=_pause_s,
            stop=self._is_over,
            reraise=True,
        )
        try:
            result = retrying(attempt)
        except TryAgainError as error:
            raise error.final from error
        except httpx.TransportError as error:
            within = f"within {self._allowed_s():g} s: {error or type(error).__name__}"
            raise UnreachableError(f"no answer from {self.base_url} {within}") from error
        self._was_reached = True
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

    def _is_over(self, state: RetryCallState) -> bool:
        return stop_before_delay(self._allowed_s())(state)

    def _allowed_s(self) -> float:
        return self._patience_s if self._was_reached else min(self._patience_s, self._first_contact_s)


class TryAgainError(Exception):
    """The service asks to come back later; `final` is what to raise when there is no later."""

    def __init__(self, final: Exception, retry_after_s: float | None) -> None:
        super().__init__(str(final))
        self.final = final
        self.retry_after_s = retry_after_s


def retry_after_s(response: httpx.Response) -> float | None:
    """Seconds that the service asks to wait, None where it does not say."""
    text = response.headers.get("Retry-After", "")
    return float(text) if text.isdecimal() else None


def _pause_s(state: RetryCallState) -> float:
    asked_s: float | None = getattr(_error(state), "retry_after_s", None)
    return asked_s or _PAUSE_S(state) * random.uniform(0.75, 1.25)


def _error(state: RetryCallState) -> BaseException | None:
    return None if state.outcome is None else state.outcome.exception()


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
