"""How long a request that failed is repeated, and after which pauses. It decides alone: it neither sends nor sleeps.

Tested in `tests/quadpatch_client/test_transport.py`.
"""

import random
import time
from collections.abc import Callable
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime

import httpx

from quadpatch_client.errors import UnreachableError

_FIRST_PAUSE_S, _LONGEST_PAUSE_S = 0.25, 5.0
# No connection was made, so that nothing says that a service is there.
_NOT_REACHED = (httpx.ConnectError, httpx.ConnectTimeout, httpx.UnsupportedProtocol)


class TryAgainError(Exception):
    """The service asks to come back later; `final` is what to raise when there is no later."""

    def __init__(self, final: Exception, retry_after_s: float | None) -> None:
        super().__init__(str(final))
        self.final = final
        self.retry_after_s = retry_after_s


class Line:
    """What is known of the line to a service, and how much patience there is with it.

    Attributes
    ----------
    base_url : str
        For messages.
    patience_s : float
        How long a request is repeated before the service is taken for unreachable, in seconds from its first failure.
    first_contact_s : float
        The same as long as no connection has ever been made: a wrong address is likelier then than a dropped line.
    """

    def __init__(self, base_url: str, patience_s: float, first_contact_s: float) -> None:
        self.base_url, self.patience_s, self.first_contact_s = base_url, patience_s, first_contact_s
        self.was_reached = False

    def allowed_s(self) -> float:
        """Return how long a request is repeated."""
        return self.patience_s if self.was_reached else min(self.patience_s, self.first_contact_s)


class Patience:
    """The failures of one request.

    Parameters
    ----------
    line : Line
    clock : callable
        Seconds that only grow.
    """

    def __init__(self, line: Line, clock: Callable[[], float] = time.monotonic) -> None:
        self._line, self._clock = line, clock
        self._most = -1
        self._started = 0.0
        self._n_failures = 0

    def pause_s(self, error: httpx.TransportError | TryAgainError, done: int = 0) -> float:
        """Return the seconds until the next try.

        Parameters
        ----------
        error : Exception
            What the last try has ended with.
        done : int
            How many bytes all tries together have brought; patience begins anew with each failure after more.

        Raises
        ------
        UnreachableError
            If no answer came in time.
        RefusedError, AnswerError
            If the service said to the end that it can't answer now.
        """
        self._line.was_reached = self._line.was_reached or not isinstance(error, _NOT_REACHED)
        # Not from the first try: an upload that breaks after minutes is tried again.
        if done > self._most:
            self._most, self._started, self._n_failures = done, self._clock(), 0
        self._n_failures += 1
        pause_s = _pause_s(error, self._n_failures)
        if self._clock() - self._started + pause_s < self._line.allowed_s():
            return pause_s
        if isinstance(error, TryAgainError):
            raise error.final from error
        within = f"within {self._line.allowed_s():g} s: {error or type(error).__name__}"
        raise UnreachableError(f"no answer from {self._line.base_url} {within}") from error


def retry_after_s(response: httpx.Response) -> float | None:
    """Seconds that the service asks to wait, None where it does not say."""
    text = response.headers.get("Retry-After", "")
    if text.isdecimal():
        return float(text)
    try:
        # A gateway in between may name a moment instead.
        return max((parsedate_to_datetime(text) - datetime.now(UTC)).total_seconds(), 0.0)
    except (ValueError, TypeError):
        return None


def _pause_s(error: Exception, n_failures: int) -> float:
    asked_s: float | None = getattr(error, "retry_after_s", None)
    growing_s = min(_FIRST_PAUSE_S * 2.0 ** min(n_failures - 1, 10), _LONGEST_PAUSE_S)
    return asked_s or growing_s * random.uniform(0.75, 1.25)
