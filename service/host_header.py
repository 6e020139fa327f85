"""The host that a request names: the raw Host header, parsed by the grammar of RFC 9112.

Starlette's `request.url` falls back to the server's own address where it can't parse the header, and in some versions
takes the path from it. So neither is used here: the path is `scope["path"]`, and a header that does not parse is
refused.

Tested in `tests/attacks/test_b_who_is_asking.py`.
"""

import ipaddress
import re
from dataclasses import dataclass
from http import HTTPStatus
from urllib.parse import urlsplit

from starlette.types import Scope

from service.problems import ProblemError

_NAME = r"[A-Za-z0-9](?:[A-Za-z0-9._-]{0,253}[A-Za-z0-9.])?"
_AUTHORITY = re.compile(rf"(?P<name>{_NAME}|\[[0-9A-Fa-f:.]{{2,45}}\])(?::(?P<port>[0-9]{{1,5}}))?")
_DEFAULT_PORTS = {"http": 80, "https": 443}
_LARGEST_PORT = 65_535


@dataclass(frozen=True)
class Authority:
    """A host and a port; the host in lower case, an IPv6 address in its short form and without brackets."""

    host: str
    port: int


def requested_authority(scope: Scope) -> Authority | None:
    """Return what the Host header names, None where HTTP/1.0 sends none.

    Raises
    ------
    ProblemError
        400 if the header does not parse, comes twice, or is missing although the version asks for it.
    """
    values = [value for name, value in scope["headers"] if name == b"host"]
    if not values and scope.get("http_version") == "1.0":
        return None
    if len(values) != 1:
        raise _refused(f"a request carries one Host header; this one carries {len(values)}")
    authority = parse_authority(values[0].decode("latin-1"), scope.get("scheme", "http"))
    if authority is None:
        raise _refused("the Host header is no host name or address with an optional port")
    return authority


def parse_authority(text: str, scheme: str) -> Authority | None:
    """Return the host and the port that a text names, None where it is neither."""
    match = _AUTHORITY.fullmatch(text)
    host = None if match is None else plain_host(match["name"])
    if match is None or host is None:
        return None
    port = int(match["port"] or _DEFAULT_PORTS.get(scheme, 0))
    return Authority(host, port) if port <= _LARGEST_PORT else None


def parse_origin(origin: str) -> Authority | None:
    """Return the host and the port of an Origin header, None where it names none."""
    try:
        parts = urlsplit(origin)
    except ValueError:
        return None
    if parts.scheme not in _DEFAULT_PORTS or parts.path or parts.query or parts.fragment:
        return None
    return parse_authority(parts.netloc, parts.scheme)


def plain_host(name: str) -> str | None:
    """Return a host in the one form that is compared, None for brackets around what is no address."""
    if not name.startswith("["):
        return _short_address(name) or name.lower()
    return _short_address(name[1:-1])


def _short_address(text: str) -> str | None:
    try:
        return str(ipaddress.ip_address(text))
    except ValueError:
        return None


def _refused(detail: str) -> ProblemError:
    return ProblemError(HTTPStatus.BAD_REQUEST, "invalid_host", detail)
