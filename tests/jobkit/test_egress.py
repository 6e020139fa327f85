from ipaddress import IPv4Address, IPv4Network, IPv6Address, ip_address

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from jobkit.egress import (
    Address,
    Destination,
    check_addresses,
    check_url,
    destination_of,
    is_global,
    parse_networks,
    resolve,
    unwrapped_address,
)
from jobkit.errors import AddressRefusedError, HostUnknownError, TlsRequiredError

HTTPS = destination_of("https://receiver.example/hook")
HTTP = destination_of("http://receiver.example/hook")
HIDDEN = parse_networks(
    "0.0.0.0/8, 10.0.0.0/8, 100.64.0.0/10, 127.0.0.0/8, 169.254.0.0/16, 172.16.0.0/12, 192.0.2.0/24, 192.168.0.0/16,"
    "198.18.0.0/15, 198.51.100.0/24, 203.0.113.0/24, 224.0.0.0/4, 240.0.0.0/4"
)
hidden_v4 = st.sampled_from(HIDDEN).flatmap(
    lambda network: st.integers(0, network.num_addresses - 1).map(lambda i: IPv4Address(int(network[0]) + i))
)
v4 = st.integers(0, 2**32 - 1).map(IPv4Address)
v6 = st.integers(0, 2**128 - 1).map(IPv6Address)


def is_refused(address: Address, destination: Destination = HTTPS, allowed: str = "") -> bool:
    try:
        check_addresses(destination, [address], parse_networks(allowed))
    except AddressRefusedError:
        return True
    return False


@pytest.mark.parametrize(
    "address",
    [
        "127.0.0.1",
        "0.0.0.0",
        "10.1.2.3",
        "169.254.169.254",
        "100.100.100.200",
        "192.168.1.1",
        "224.0.0.1",
        "255.255.255.255",
        "::",
        "::1",
        "::127.0.0.1",
        "::ffff:127.0.0.1",
        "::ffff:169.254.169.254",
        "::ffff:0:127.0.0.1",
        "64:ff9b::127.0.0.1",
        "64:ff9b::a9fe:a9fe",
        "64:ff9b:1::8.8.8.8",
        "2002:7f00:1::",
        "2002:808:808::",
        "2001:0:808:808::1",
        "fe80::1",
        "fc00::1",
        "fd00:ec2::254",
        "fec0::1",
        "ff02::1",
        "ff0e::1",
        "2001:db8::1",
        "100::1",
    ],
)
def test_what_only_some_can_reach_is_refused(address: str) -> None:
    assert is_refused(ip_address(address))


@pytest.mark.parametrize("address", ["8.8.8.8", "2606:4700:4700::1111", "::ffff:8.8.8.8", "64:ff9b::8.8.8.8"])
def test_what_the_whole_internet_can_reach_is_allowed_by_https_only(address: str) -> None:
    check_addresses(HTTPS, [ip_address(address)], ())
    with pytest.raises(TlsRequiredError, match="https"):
        check_addresses(HTTP, [ip_address(address)], ())


@given(address=hidden_v4)
def test_no_disguise_lets_a_hidden_address_pass(address: IPv4Address) -> None:
    number = int(address)
    wrappings: list[IPv4Address | IPv6Address] = [
        address,
        IPv6Address((0xFFFF << 32) | number),
        IPv6Address(number),
        IPv6Address((int(IPv6Address("64:ff9b::"))) | number),
        IPv6Address((0x2002 << 112) | (number << 80) | 1),
        IPv6Address((0x2001_0000 << 96) | (~number & 0xFFFF_FFFF)),
    ]
    assert all(is_refused(wrapped) for wrapped in wrappings)


@given(address=v4)
def test_an_ipv4_address_is_judged_the_same_when_it_is_mapped(address: IPv4Address) -> None:
    mapped = IPv6Address((0xFFFF << 32) | int(address))
    assert is_refused(address) == is_refused(mapped) == (not is_global(address))
    assert is_refused(address, allowed=f"{address}/32") is is_refused(mapped, allowed=f"{address}/32") is False


@given(address=v6)
@example(address=IPv6Address("2606:4700:4700::1111"))
@example(address=IPv6Address("::ffff:8.8.8.8"))
@example(address=IPv6Address("64:ff9b::8.8.8.8"))
def test_an_ipv6_address_that_is_allowed_is_global_unicast_or_nat64_of_a_global_one(address: IPv6Address) -> None:
    if not is_refused(address):
        assert unwrapped_address(address).is_global
        assert int(address) >> 125 == 1 or int(address) >> 32 in {0xFFFF, int(IPv6Address("64:ff9b::")) >> 32}


@given(address=v4, length=st.integers(0, 32), plain=st.booleans())
def test_an_allowed_network_lets_all_its_addresses_pass_by_http_too(
    address: IPv4Address, length: int, plain: bool
) -> None:
    network = IPv4Network((address, length), strict=False)
    check_addresses(HTTP if plain else HTTPS, [address], (network,))
    with pytest.raises((AddressRefusedError, TlsRequiredError)):
        check_addresses(HTTP, [address], ())


@given(good=st.lists(st.just(ip_address("8.8.8.8")), max_size=3), bad=hidden_v4, at=st.integers(0, 3))
def test_one_refused_address_refuses_the_name(good: list[Address], bad: IPv4Address, at: int) -> None:
    addresses = [*good[:at], bad, *good[at:]]
    with pytest.raises(AddressRefusedError, match=r"receiver\.example"):
        check_addresses(HTTPS, addresses, ())


def test_a_url_is_taken_apart() -> None:
    destination = destination_of("HTTPS://MES.Example.com/a%20b?c=/d")
    assert destination == Destination("https", "mes.example.com", 443, "/a%20b?c=/d")
    assert destination.authority == "mes.example.com"
    assert destination_of("http://h:8080").authority == "h:8080"
    assert destination_of("http://h").target == "/"
    assert destination_of("https://[::1]:8443/x").authority == "[::1]:8443"
    assert destination_of("https://[::1]:8443/x").host == "::1"


@pytest.mark.parametrize("host", ["localhost", "2130706433", "0x7f.1", "127.1", "[::1]", "[::ffff:7f00:1]"])
def test_every_way_to_write_this_machine_is_refused(host: str) -> None:
    with pytest.raises(AddressRefusedError):
        check_url(f"https://{host}:8000/", ())
    check_url(f"http://{host}:8000/", parse_networks("127.0.0.0/8, ::1/128"))


@pytest.mark.parametrize(
    "url", ["https://no-such-host.invalid/", "https://[:::]/", "https://[12345::]/", f"https://{'a.' * 150}b"]
)
def test_a_host_without_an_address_is_unknown(url: str) -> None:
    with pytest.raises(HostUnknownError):
        check_url(url, ())


def test_a_name_is_resolved_to_each_address_once() -> None:
    addresses = resolve(destination_of("https://localhost/"))
    assert addresses
    assert len(set(addresses)) == len(addresses)
    assert all(address.is_loopback for address in addresses)


@pytest.mark.parametrize("text", ["10.0.0.1/8", "10.0.0.0/33", "hall-3", "10.0.0.0/8;::1"])
def test_networks_that_are_none_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r".+"):
        parse_networks(text)
