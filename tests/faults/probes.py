"""Single requests without retries: they show that the service refuses while something is broken."""

import itertools
import time
from collections.abc import Mapping

import httpx

from tests.faults.cluster import API_KEY
from tests.waiting import GUARD_S

_PAUSE_S = 0.2


class Probe:
    """Sends requests to the APIs.

    Parameters
    ----------
    urls : mapping
        Address of each API.
    """

    def __init__(self, urls: Mapping[str, str]) -> None:
        self._urls = dict(urls)
        self._numbers = itertools.count()

    def wait_for_refusal(self) -> str:
        """Upload new bytes again and again until an upload is refused; return the answer."""
        deadline = time.monotonic() + GUARD_S
        for url in itertools.cycle(self._urls.values()):
            body = f"solid {time.time_ns()} {next(self._numbers)}".encode() + b" " * (1 << 16)
            try:
                answer = httpx.post(
                    f"{url}/v1/meshes?filename=probe.stl",
                    content=body,
                    headers={"Authorization": f"Bearer {API_KEY}"},
                    timeout=60,
                    trust_env=False,
                    verify=False,
                )
            except httpx.TransportError:
                continue
            if answer.status_code in (httpx.codes.SERVICE_UNAVAILABLE, httpx.codes.INSUFFICIENT_STORAGE):
                return f"{answer.status_code} {answer.json()['code']}"
            assert time.monotonic() < deadline, f"uploads are still accepted: {answer.status_code} {answer.text}"
            time.sleep(_PAUSE_S)
        raise AssertionError("there is no API")

    def reaches(self, name: str) -> bool:
        """Tell whether an API answers at all."""
        try:
            return httpx.get(f"{self._urls[name]}/healthz", timeout=2, trust_env=False, verify=False).is_success
        except httpx.TransportError:
            return False
