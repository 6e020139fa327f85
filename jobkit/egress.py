"""Which addresses messages may be sent to: globally routable ones, and those that a setting allows.

A client that may subscribe chooses where this service sends requests. So it sends none to its own network, where a
metadata service or a database listens, unless the operator allows it. A name is resolved once; all of its addresses are
checked, and the connection goes to one of these, so a name whose addresses change in between gains nothing.
"""

import ipaddress
import socket
from collections.abc import Sequence
from dataclasses import dataclass
from ipaddress import IPv4Address, IPv4Network, IPv6Address, IPv6Network
from urllib.parse import urlsplit

from jobkit.errors import AddressRefusedError, HostUnknownError, TlsRequiredError

Address = IPv4Address | IPv6Address
Networks = tuple[IPv4Network | IPv6Network, ...]

_PORTS = {"http": 80, "https": 443}
# All that is handed out of IPv6 for use between networks lies in here; what lies elsewhere is local or has no receiver.
_GLOBAL_UNICAST = IPv6Network("2000::/3")
# They carry an IPv4 address that a gateway may unpack: that one is checked, too.
_NAT64 = IPv6Network("64:ff9b::/96")
_TUNNELS = (IPv6Network("2002::/16"), IPv6Network("2001::/32"))


@dataclass(frozen=True)
class Destination:
    """A URL in parts: `host` in lower case without brackets, `target` is path and query, as they were written."""

    scheme: str
    host: str
    port: int
    target: str

    @property
    def authority(self) -> str:
        """Host and port as the Host header names them."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return host if self.port == _PORTS[self.scheme] else f"{host}:{self.port}"


def parse_networks(text: str) -> Networks:
    """Read comma-separated networks in CIDR notation; raise ValueError."""
    return tuple(ipaddress.ip_network(part.strip()) for part in text.split(",") if part.strip())


def check_url(url: str, allowed: Networks) -> None:
    """Resolve the name in a URL and refuse it where nothing may be sent to it.

    Raises as `destination_of`, `resolve` and `check_addresses`.
    """
    destination = destination_of(url)
    check_addresses(destination, resolve(destination), allowed)


def destination_of(url: str) -> Destination:
    """Take apart a URL that fits the pattern of `quadpatch_client.schema.webhooks`.

    Raises
    ------
    HostUnknownError
        If there is no address in its brackets.
    """
    try:
        parts = urlsplit(url)
    except ValueError as error:
        raise HostUnknownError(f"{url} names no host") from error
    target = (parts.path or "/") + (f"?{parts.query}" if parts.query else "")
    return Destination(parts.scheme, parts.hostname or "", parts.port or _PORTS[parts.scheme], target)


def resolve(destination: Destination) -> list[Address]:
    """Return all addresses of a host, in the order in which they should be tried.

    Raises
    ------
    HostUnknownError
        If the name has no address.
    """
    try:
        entries = socket.getaddrinfo(destination.host, destination.port, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError) as error:
        raise HostUnknownError(f"{destination.host} has no address") from error
    # Twice the same address where a host's file names it twice; the scope of a link-local one says nothing here.
    texts = dict.fromkeys(str(entry[4][0]).partition("%")[0] for entry in entries)
    return [ipaddress.ip_address(text) for text in texts]


def check_addresses(destination: Destination, addresses: Sequence[Address], allowed: Networks) -> None:
    """Refuse a destination if any of its addresses may not be sent to.

    Raises
    ------
    AddressRefusedError
        If an address is neither globally routable nor in an allowed network.
    TlsRequiredError
        If the URL is plain http, and an address lies outside of the allowed networks.
    """
    for address in map(unwrapped_address, addresses):
        if is_within(address, allowed):
            continue
        if not is_global(address):
            # Without the address: it would tell a client how names resolve in this network.
            raise AddressRefusedError(f"{destination.host} is not an address that the whole internet can reach")
        if destination.scheme != "https":
            raise TlsRequiredError(f"{destination.host} has to be reached by https")


def unwrapped_address(address: Address) -> Address:
    """Return the IPv4 address where an IPv6 one only wraps it, else the address itself."""
    if isinstance(address, IPv4Address):
        return address
    if address.ipv4_mapped is not None:
        return address.ipv4_mapped
    return IPv4Address(int(address) & 0xFFFF_FFFF) if address in _NAT64 else address


def is_within(address: Address, networks: Networks) -> bool:
    """Tell whether the address lies in one of the networks."""
    return any(address.version == network.version and address in network for network in networks)


def is_global(address: Address) -> bool:
    """Tell whether the address is that of one host, the same one wherever in the internet it is called from."""
    if address.is_multicast or not address.is_global:
        return False
    if isinstance(address, IPv4Address):
        return True
    return address in _GLOBAL_UNICAST and not is_within(address, _TUNNELS)
