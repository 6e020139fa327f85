"""Look at something again and again, with pauses that grow and that the service may set."""

import time
from collections.abc import Iterator
from typing import TypeVar

import httpx
from pydantic import BaseModel

from quadpatch_client.errors import AnswerError
from quadpatch_client.lenient_json import read_leniently
from quadpatch_client.patience import retry_after_s
from quadpatch_client.transport import Transport

M = TypeVar("M", bound=BaseModel)

# A service that lets requests wait answers at once when something ends, and needs no pauses in between.
_WAIT_S = 1
_FIRST_PAUSE_S = 0.1
_LONGEST_PAUSE_S = 1.0


def parse(model: type[M], response: httpx.Response) -> M:
    """Read an answer as what it should be, maybe of a newer service; raise AnswerError where it is something else."""
    try:
        return read_leniently(model, response.content)
    except ValueError as error:
        raise AnswerError(f"{response.request.url} did not answer with a {model.__name__.lower()}") from error


def poll(transport: Transport, path: str, model: type[M], timeout_s: float | None) -> Iterator[M]:
    """Yield what is seen at every look, the first at once; end when the time is up.

    Parameters
    ----------
    transport : Transport
    path : str
        On the service.
    model : type
        What the answer is read as.
    timeout_s : float, optional
        None: look for ever.
    """
    started, pause_s, headers = time.monotonic(), _FIRST_PAUSE_S, dict[str, str]()
    while True:
        response = transport.request("GET", path, headers=headers)
        yield parse(model, response)
        left_s = float("inf") if timeout_s is None else timeout_s - (time.monotonic() - started)
        if left_s <= 0:
            return
        if "Preference-Applied" not in response.headers and headers:
            time.sleep(min(retry_after_s(response) or pause_s, left_s))
            pause_s = min(1.5 * pause_s, _LONGEST_PAUSE_S)
        headers = {"Prefer": f"wait={_WAIT_S}"}
