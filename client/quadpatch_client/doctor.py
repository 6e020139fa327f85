"""What stands between this machine and repaired scans: looked at step by step, each with what to do about it.

Tested in `tests/quadpatch_client/test_doctor.py`.
"""

import platform
import shutil
import socket
import ssl
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from importlib.metadata import version
from pathlib import Path
from typing import Literal
from urllib.parse import SplitResult, urlsplit

import httpx

from quadpatch_client.lenient_json import read_leniently
from quadpatch_client.schema import CallerLimits, Version
from quadpatch_client.transport import service_address

_LOCAL = ("localhost", "127.0.0.1", "::1")
_TIMEOUT_S = 10.0
_MOST_SKEW_S = 60.0
_LEAST_FREE_BYTES = 2 << 30
_LEAST_DAYS = 14.0
_REFUSALS = (httpx.codes.UNAUTHORIZED, httpx.codes.FORBIDDEN)


@dataclass(frozen=True)
class Finding:
    """What one look has found.

    Attributes
    ----------
    subject : str
    verdict : str
        `ok`, `warning` or `error`.
    text : str
        What was found.
    advice : str
        What to do about it; empty where all is well.
    """

    subject: str
    verdict: Literal["ok", "warning", "error"]
    text: str
    advice: str = ""


def examine(url: str, api_key: str | None, folder: Path) -> Iterator[Finding]:
    """Yield what is found, until something is in the way of all that follows.

    Parameters
    ----------
    url : str
        Of the service.
    api_key : str, optional
    folder : Path
        Where results are to lie.
    """
    yield Finding(
        "this machine",
        "ok",
        f"quadpatch-client {version('quadpatch-client')}, Python {platform.python_version()}, {platform.platform()}",
    )
    yield from _disks(folder)
    address = service_address(url)
    parts = urlsplit(address)
    found = _address(parts)
    yield found
    if found.verdict == "error":
        return
    if parts.scheme == "https":
        yield (certificate := _certificate(parts))
        if certificate.verdict == "error":
            return
    headers = {"Authorization": f"Bearer {api_key}"} if api_key else {}
    with httpx.Client(base_url=address, headers=headers, timeout=_TIMEOUT_S) as client:
        for look in (_service, _ready, _key):
            finding, goes_on = look(client)
            yield from finding
            if not goes_on:
                return


def _disks(folder: Path) -> Iterator[Finding]:
    for place, words in ((folder, "results"), (Path(tempfile.gettempdir()), "files on their way")):
        free = shutil.disk_usage(place).free
        text = f"{free / 1e9:.1f} GB free for {words} in {place}"
        if free < _LEAST_FREE_BYTES:
            yield Finding("disk", "warning", text, "free some space, or work in another folder (TMPDIR for the latter)")
        else:
            yield Finding("disk", "ok", text)


def _address(parts: SplitResult) -> Finding:
    """Resolve the name, and open a connection."""
    if parts.scheme not in ("http", "https") or not parts.hostname:
        return Finding("address", "error", f"{parts.geturl()!r} is no address", "say --url http://HOST:PORT")
    port = parts.port or (443 if parts.scheme == "https" else 80)
    try:
        with socket.create_connection((parts.hostname, port), _TIMEOUT_S):
            pass
    except socket.gaierror:
        return Finding("address", "error", f"the name {parts.hostname} is not known", "check --url, and the DNS server")
    except ConnectionRefusedError:
        advice = "start the service, or check the port in --url"
        return Finding("address", "error", f"nothing listens at {parts.hostname}, port {port}", advice)
    except OSError as error:
        advice = "check the network, the VPN and firewalls"
        return Finding("address", "error", f"{parts.hostname}, port {port}: {error}", advice)
    if parts.scheme == "http" and parts.hostname not in _LOCAL:
        advice = "use https where others share the network: key and scans can be read on the way"
        return Finding("address", "warning", f"{parts.hostname}, port {port} answers, without encryption", advice)
    return Finding("address", "ok", f"{parts.hostname}, port {port} answers")


def _certificate(parts: SplitResult) -> Finding:
    """Look at the certificate of the service."""
    host, port = str(parts.hostname), parts.port or 443
    try:
        with (
            socket.create_connection((host, port), _TIMEOUT_S) as line,
            ssl.create_default_context().wrap_socket(line, server_hostname=host) as tls,
        ):
            until = ssl.cert_time_to_seconds(str((tls.getpeercert() or {})["notAfter"]))
            protocol = tls.version()
    except ssl.SSLCertVerificationError as error:
        advice = "name the certificate of your own authority by SSL_CERT_FILE, or have the operator renew it"
        return Finding("TLS", "error", f"the certificate is not trusted: {error.verify_message}", advice)
    except (OSError, KeyError) as error:
        return Finding("TLS", "error", f"no encrypted connection: {error}", "say http:// if the service has no TLS")
    days = (until - time.time()) / 86_400
    text = f"{protocol}; the certificate is valid for {days:.0f} more days"
    if days < _LEAST_DAYS:
        return Finding("TLS", "warning", text, "tell the operator to renew it")
    return Finding("TLS", "ok", text)


def _service(client: httpx.Client) -> tuple[list[Finding], bool]:
    """Ask for the version, and compare clocks by the answer."""
    try:
        answer = client.get("/v1/version")
        if answer.status_code in _REFUSALS:
            return [_refused_key(client, answer)], False
        if not answer.is_success:
            raise ValueError(f"status {answer.status_code} {answer.reason_phrase}".strip())
        there = read_leniently(Version, answer.content)
    except (httpx.HTTPError, ValueError) as error:
        advice = "check --url: another program may listen there, or a proxy stands in between"
        return [Finding("service", "error", f"no answer of a Quadpatch service: {error}", advice)], False
    return [_versions(there), *_clock(answer)], True


def _versions(there: Version) -> Finding:
    here = version("quadpatch-client")
    text = f"version {there.version}, contract {there.api}"
    if there.version.split(".")[:2] != here.split(".")[:2]:
        return Finding("service", "warning", f"{text}; the client is {here}", "install the client of that version")
    return Finding("service", "ok", text)


def _clock(answer: httpx.Response) -> Iterator[Finding]:
    try:
        there = parsedate_to_datetime(answer.headers["Date"])
    except (KeyError, ValueError):
        return
    skew_s = (datetime.now(UTC) - there.astimezone(UTC)).total_seconds()
    if abs(skew_s) > _MOST_SKEW_S:
        text = f"this machine is {abs(skew_s):.0f} s {'ahead of' if skew_s > 0 else 'behind'} the service"
        yield Finding("clock", "warning", text, "set it by NTP: times in reports and of certificates go by it")
    else:
        yield Finding("clock", "ok", "agrees with the service's")


def _ready(client: httpx.Client) -> tuple[list[Finding], bool]:
    try:
        answer = client.get("/readyz")
    except httpx.HTTPError as error:
        return [Finding("readiness", "error", str(error), "try again; tell the operator if it stays so")], False
    if answer.is_success:
        return [Finding("readiness", "ok", "takes jobs")], True
    advice = "wait: jobs that were accepted are kept; tell the operator if it stays so"
    return [Finding("readiness", "error", f"not ready: {answer.text[:200]}", advice)], True


def _key(client: httpx.Client) -> tuple[list[Finding], bool]:
    """Ask what limits the caller, which needs a key where keys are needed."""
    try:
        answer = client.get("/v1/limits")
    except httpx.HTTPError as error:
        return [Finding("key", "error", str(error), "try again")], False
    if answer.status_code in _REFUSALS:
        return [_refused_key(client, answer)], False
    try:
        limits = read_leniently(CallerLimits, answer.raise_for_status().content)
    except (httpx.HTTPError, ValueError):
        return [Finding("limits", "warning", "the service does not say what its limits are", "")], False
    return [Finding("key", "ok", f"of tenant {limits.tenant}"), *_limits(limits)], False


def _refused_key(client: httpx.Client, answer: httpx.Response) -> Finding:
    if "Authorization" not in client.headers:
        text = "the service asks for a key"
    elif answer.status_code == httpx.codes.FORBIDDEN:
        text = "the service knows this key, which may not read: the scope `read` is missing"
    else:
        text = "the service does not know this key"
    return Finding("key", "error", text, "set QUADPATCH_CLIENT_API_KEY or say --api-key; the operator makes a key")


def _limits(limits: CallerLimits) -> Iterator[Finding]:
    size, time_s = limits.bodies.mesh / 1e6, limits.jobs.time_s
    yield Finding("limits", "ok", f"meshes up to {size:,.0f} MB, jobs up to {time_s:,.0f} s")
    quotas: tuple[tuple[str, int, int, Callable[[int], str]], ...] = (
        ("stored", limits.use.stored_bytes, limits.quotas.stored_bytes, lambda n: f"{n / 1e9:.1f} GB"),
        ("jobs that wait", limits.use.jobs_waiting, limits.quotas.jobs_waiting, str),
    )
    for words, used, most, shown in quotas:
        if most and used >= 0.9 * most:
            text = f"{words}: {shown(used)} of {shown(most)}"
            yield Finding("limits", "warning", text, "delete jobs and meshes, or ask the operator for more")


def exit_is_clean(findings: list[Finding]) -> bool:
    """Tell whether nothing is in the way of a repair."""
    return all(finding.verdict != "error" for finding in findings)
