"""Watch a job by its event stream; where there is none, poll.

The stream only says that there is something new: the job itself is then asked for, so what is seen is always whole. Its
revision is the number of its latest event, and with that number a broken stream is taken up again: nothing that the
job shows already is sent once more.
"""

import math
import time
from collections.abc import Iterator

import httpx

from quadpatch_client.errors import AnswerError, RefusedError
from quadpatch_client.patience import TryAgainError
from quadpatch_client.polling import parse, poll
from quadpatch_client.schema import Job
from quadpatch_client.transport import Transport

_MEDIA_TYPE = "text/event-stream"
# A service shows every 15 s that a stream lives; after three of those it does not.
_SILENCE_S = 45.0
_PAUSE_S = 1.0


class _NoStreamError(Exception):
    """The service has no stream for us: too many are open, or it is an older one."""


def watch(transport: Transport, path: str, timeout_s: float | None) -> Iterator[Job]:
    """Yield a job at once, whenever it has changed, and now and then in between; end when the time is up.

    Parameters
    ----------
    transport : Transport
    path : str
        Of the job on the service.
    timeout_s : float, optional
        None: watch until it has ended.
    """
    started = time.monotonic()

    def left_s() -> float:
        return math.inf if timeout_s is None else timeout_s - (time.monotonic() - started)

    def look() -> Job:
        # This has patience, so it is here that a service which is away is waited for.
        return parse(Job, transport.request("GET", path))

    job = look()
    yield job
    while not job.state.is_terminal and left_s() > 0:
        try:
            for number in _events(transport, job, min(left_s(), _SILENCE_S)):
                if number is None or number > job.revision:
                    job = look()
                    yield job
                if job.state.is_terminal or left_s() <= 0:
                    return
        except _NoStreamError:
            yield from poll(transport, path, Job, None if timeout_s is None else left_s())
            return
        time.sleep(max(min(_PAUSE_S, left_s()), 0.0))
        job = look()
        yield job


def _events(transport: Transport, job: Job, silence_s: float) -> Iterator[int | None]:
    """Yield the number of each event, and None for each sign of life, until the line breaks."""
    headers = {"Accept": _MEDIA_TYPE, "Last-Event-ID": str(job.revision)}
    try:
        with transport.stream(job.links.events, headers, silence_s) as response:
            if response.status_code == httpx.codes.NO_CONTENT:
                return
            if not response.headers.get("Content-Type", "").startswith(_MEDIA_TYPE):
                raise _NoStreamError
            yield from _numbers(response.iter_lines())
    except httpx.TransportError:
        return
    except (TryAgainError, RefusedError, AnswerError) as error:
        raise _NoStreamError from error


def _numbers(lines: Iterator[str]) -> Iterator[int | None]:
    number: int | None = None
    for line in lines:
        name, _, value = line.partition(":")
        if name == "id" and value.strip().isdecimal():
            number = int(value)
        elif line == ": ping":
            yield None
        elif not line and number is not None:
            yield number
            number = None
