"""Requests that wait: `Prefer: wait=N` (RFC 7240), in seconds, at most as long as the service allows."""

import re
import time
from collections.abc import Callable
from typing import Annotated, TypeVar

import anyio
import anyio.to_thread
from fastapi import Header, Response

T = TypeVar("T")
_WAIT = re.compile(r"(?:^|[,;\s])wait\s*=\s*\"?(\d{1,6})\"?(?=$|[,;\s])", re.IGNORECASE)
_SHORTEST_PAUSE_S = 0.05
_LONGEST_PAUSE_S = 0.5

PreferHeader = Annotated[
    str | None,
    Header(
        alias="Prefer",
        description="`wait=N`: let the answer wait up to N seconds for the end (RFC 7240). Other preferences are "
        "ignored.",
        examples=["wait=10"],
    ),
]


def preferred_wait_s(prefer: str | None) -> float:
    """Return the seconds that a Prefer header asks to wait; 0 where it does not."""
    match = _WAIT.search(prefer or "")
    return float(match[1]) if match else 0.0


def note_applied(response: Response, prefer: str | None) -> None:
    """Say in the response that the preference was honoured."""
    match = _WAIT.search(prefer or "")
    if match:
        response.headers["Preference-Applied"] = f"wait={match[1]}"


async def wait_until(look: Callable[[], T], is_done: Callable[[T], bool], wait_s: float) -> T:
    """Look again and again until it is done or the time is over; return the last sight."""
    deadline = time.monotonic() + wait_s
    pause_s = _SHORTEST_PAUSE_S
    seen = await anyio.to_thread.run_sync(look)
    while not is_done(seen) and (left_s := deadline - time.monotonic()) > 0:
        await anyio.sleep(min(pause_s, left_s))
        pause_s = min(pause_s * 1.5, _LONGEST_PAUSE_S)
        seen = await anyio.to_thread.run_sync(look)
    return seen
