"""Where processes run: each in a network namespace with an address of its own, or all of them on loopback.

In namespaces a process can be cut off from all others by taking its link down, which is not possible on loopback.
"""

import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Protocol

from tests.servers import free_port


class Network(Protocol):
    """How processes reach each other."""

    server_host: str
    description: str
    can_cut: bool

    def host(self, name: str) -> str:
        """Return the address that the named process listens on."""
        ...

    def port(self, name: str) -> int:
        """Return the port that the named process listens on."""
        ...

    def command(self, name: str, command: Sequence[str]) -> list[str]:
        """Return the command that runs the named process in its namespace."""
        ...

    def cut(self, name: str) -> None:
        """Take the process's link down."""
        ...

    def restore(self, name: str) -> None:
        """Bring the link up again."""
        ...

    def has_link(self, name: str) -> bool:
        """Tell whether the process's own end of the link sees another end."""
        ...


@dataclass
class Loopback:
    """All processes on 127.0.0.1."""

    server_host: str = "127.0.0.1"
    description: str = "plain processes on loopback, no partitions"
    can_cut: bool = False
    _ports: dict[str, int] = field(default_factory=dict)

    def host(self, name: str) -> str:
        return self.server_host

    def port(self, name: str) -> int:
        return self._ports.setdefault(name, free_port())

    def command(self, name: str, command: Sequence[str]) -> list[str]:
        return list(command)

    def cut(self, name: str) -> None:
        raise NotImplementedError("loopback has no links")

    def restore(self, name: str) -> None:
        raise NotImplementedError("loopback has no links")

    def has_link(self, name: str) -> bool:
        return True


class Namespaces:
    """A bridge for the servers, and a namespace with a link to it for each other process."""

    description = "a network namespace with an address of its own for each process"
    can_cut = True

    def __init__(self) -> None:
        number = os.getpid()
        self._tag = f"qp{number % 100_000}"
        self._subnet = f"10.{200 + number % 50}.{number // 50 % 250}"
        self._names: list[str] = []
        self.server_host = f"{self._subnet}.1"
        _ip("link", "add", f"{self._tag}br", "type", "bridge")
        _ip("addr", "add", f"{self.server_host}/24", "dev", f"{self._tag}br")
        _ip("link", "set", f"{self._tag}br", "up")

    def host(self, name: str) -> str:
        return f"{self._subnet}.{10 + self._index(name)}"

    def port(self, name: str) -> int:
        return 8000

    def command(self, name: str, command: Sequence[str]) -> list[str]:
        index = self._index(name)
        return ["nsenter", f"--net=/run/netns/{self._tag}n{index}", *command]

    def cut(self, name: str) -> None:
        _ip("link", "set", f"{self._tag}h{self._index(name)}", "down")

    def restore(self, name: str) -> None:
        _ip("link", "set", f"{self._tag}h{self._index(name)}", "up")

    def has_link(self, name: str) -> bool:
        index = self._index(name)
        show = ["ip", "-n", f"{self._tag}n{index}", "link", "show", f"{self._tag}p{index}"]
        return "LOWER_UP" in subprocess.run(show, check=True, capture_output=True, text=True).stdout

    def remove(self) -> None:
        """Remove all namespaces and links."""
        for index in range(len(self._names)):
            _ip("netns", "del", f"{self._tag}n{index}")
            # The pair of links goes with its namespace, but only after a while.
            subprocess.run(["ip", "link", "del", f"{self._tag}h{index}"], check=False, capture_output=True)
        _ip("link", "del", f"{self._tag}br")

    def _index(self, name: str) -> int:
        if name not in self._names:
            self._names.append(name)
            self._add(len(self._names) - 1)
        return self._names.index(name)

    def _add(self, index: int) -> None:
        space, here, there = f"{self._tag}n{index}", f"{self._tag}h{index}", f"{self._tag}p{index}"
        _ip("netns", "add", space)
        _ip("link", "add", here, "type", "veth", "peer", "name", there)
        _ip("link", "set", there, "netns", space)
        _ip("link", "set", here, "master", f"{self._tag}br", "up")
        _ip("-n", space, "link", "set", "lo", "up")
        _ip("-n", space, "addr", "add", f"{self._subnet}.{10 + index}/24", "dev", there)
        _ip("-n", space, "link", "set", there, "up")


@contextmanager
def open_network(wants_namespaces: bool = True) -> Iterator[Network]:
    """Give namespaces where this machine allows them, loopback where it does not."""
    if not wants_namespaces or not _can_make_namespaces():
        yield Loopback()
        return
    network = Namespaces()
    try:
        yield network
    finally:
        network.remove()


def _can_make_namespaces() -> bool:
    if os.geteuid() != 0 or shutil.which("ip") is None or shutil.which("nsenter") is None:
        return False
    probe, pair = f"qp{os.getpid()}probe", (f"qp{os.getpid() % 100_000}a", f"qp{os.getpid() % 100_000}b")
    try:
        _ip("netns", "add", probe)
    except subprocess.CalledProcessError:
        return False
    try:
        _ip("link", "add", pair[0], "type", "veth", "peer", "name", pair[1])
        _ip("link", "del", pair[0])
    except subprocess.CalledProcessError:
        return False
    finally:
        _ip("netns", "del", probe)
    return True


def _ip(*arguments: str) -> None:
    subprocess.run(["ip", *arguments], check=True, capture_output=True)
