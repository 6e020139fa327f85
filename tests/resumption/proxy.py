"""A proxy that cuts connections and calls for accidents, after numbers of bytes that chance has chosen before."""

import contextlib
import random
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_CHUNK_BYTES = 1 << 16


class Proxy:
    """Passes bytes on to a port of this machine; what comes from clients is counted.

    Attributes
    ----------
    n_passed : int
        Bytes that have come from clients.
    url : str

    Parameters
    ----------
    port : int
        Of the server, which may be away at times.
    size : int
        Bytes that clients send at least; all accidents happen before so many have been passed on.
    accidents : list of callable
        Each happens once, in the middle of what a client sends; the connection is cut then.
    chance : Random
    """

    def __init__(self, port: int, size: int, accidents: list[Callable[[], None]], chance: random.Random) -> None:
        self._target = ("127.0.0.1", port)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._lock = threading.Lock()
        self.n_passed = 0
        places = sorted(chance.randrange(size // 50, size - size // 50) for _ in accidents)
        self._due = list(zip(places, chance.sample(accidents, len(accidents)), strict=True))
        self.url = f"http://127.0.0.1:{self._listener.getsockname()[1]}"

    @property
    def n_due(self) -> int:
        """Accidents that are still to come."""
        return len(self._due)

    @contextmanager
    def running(self) -> Iterator["Proxy"]:
        """Take connections for the length of a `with` block."""
        threading.Thread(target=self._accept, daemon=True).start()
        try:
            yield self
        finally:
            self._listener.shutdown(socket.SHUT_RDWR)
            self._listener.close()

    def _accept(self) -> None:
        while True:
            try:
                client = self._listener.accept()[0]
            except OSError:
                return
            threading.Thread(target=self._serve, args=(client,), daemon=True).start()

    def _serve(self, client: socket.socket) -> None:
        try:
            server = socket.create_connection(self._target)
        except OSError:
            client.close()
            return
        threading.Thread(target=self._pump, args=(server, client, False), daemon=True).start()
        self._pump(client, server, True)

    def _pump(self, source: socket.socket, sink: socket.socket, is_counted: bool) -> None:
        try:
            while chunk := source.recv(_CHUNK_BYTES):
                accident = self._next(len(chunk)) if is_counted else None
                if accident is None:
                    sink.sendall(chunk)
                    continue
                # A piece of the chunk goes through, so that the server is in the middle of it.
                sink.sendall(chunk[: len(chunk) // 2])
                accident()
                break
        except OSError:
            pass  # the other side is gone
        for end in (source, sink):
            # Without it the other direction, which waits for bytes, would keep the connection open.
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()

    def _next(self, n_bytes: int) -> Callable[[], None] | None:
        with self._lock:
            self.n_passed += n_bytes
            if self._due and self.n_passed >= self._due[0][0]:
                return self._due.pop(0)[1]
        return None
