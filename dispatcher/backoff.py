"""When a delivery that failed is tried again: soon at first, then ever more rarely, for about a day."""

from datetime import datetime
from email.utils import parsedate_to_datetime

# Pauses after the first, second, … failed try; after one more the delivery is given up.
DELAYS_S = (5.0, 30.0, 120.0, 600.0, 3_600.0, 10_800.0, 21_600.0, 43_200.0)
# A pause is longer by up to this share, so that deliveries that failed together are not all retried together.
JITTER = 0.2


def next_delay_s(n_tries: int, chance: float, retry_after_s: float | None = None) -> float | None:
    """Return the seconds until the next try, None where there is none left.

    Parameters
    ----------
    n_tries : int
        Tries so far, 1 or more.
    chance : float
        A random number in [0, 1).
    retry_after_s : float, optional
        Seconds that the receiver asked for; used up to the longest pause.
    """
    if n_tries > len(DELAYS_S):
        return None
    delay = DELAYS_S[n_tries - 1]
    if retry_after_s is not None:
        delay = max(delay, min(retry_after_s, DELAYS_S[-1]))
    return delay * (1.0 + JITTER * chance)


def read_retry_after(value: str | None, now: datetime) -> float | None:
    """Return the seconds that a Retry-After header asks for, None where it says nothing that can be read.

    Parameters
    ----------
    value : str, optional
        Whole seconds, or a date as in RFC 9110.
    now : datetime
    """
    if value is None:
        return None
    text = value.strip()
    if text.isascii() and text.isdigit():
        return float(text[:9])
    try:
        moment = parsedate_to_datetime(text)
        return max(0.0, (moment - now).total_seconds())
    except (ValueError, TypeError, OverflowError):
        return None
