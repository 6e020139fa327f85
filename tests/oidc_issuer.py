"""A small OIDC issuer for tests: metadata and a key set over HTTP, and tokens signed with the keys."""

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import jwt
from cryptography.hazmat.primitives.asymmetric import ec, rsa
from jwt.algorithms import ECAlgorithm, RSAAlgorithm

AUDIENCE = "quadpatch"
PrivateKey = rsa.RSAPrivateKey | ec.EllipticCurvePrivateKey


class Issuer:
    """An issuer on a port of this machine.

    Attributes
    ----------
    url : str
        As its tokens name it.
    keys : dict of private key
        By their ids; what is in it is in the key set.
    is_down : bool
        Whether it answers 503 only.
    n_requests : int
        For the key set, so far.
    metadata : dict
        What replaces entries of its metadata.
    """

    def __init__(self, port: int = 0) -> None:
        self._server = ThreadingHTTPServer(("127.0.0.1", port), self._handler())
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}/realm"
        self.keys: dict[str, PrivateKey] = {}
        self.extra_entries: list[dict[str, Any]] = []
        self.metadata: dict[str, Any] = {}
        self.is_down = False
        self.n_requests = 0
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.05,))
        self._thread.start()

    def add_rsa(self, key_id: str, bits: int = 2048) -> None:
        self.keys[key_id] = rsa.generate_private_key(65_537, bits)

    def add_ec(self, key_id: str) -> None:
        self.keys[key_id] = ec.generate_private_key(ec.SECP256R1())

    def token(self, key_id: str, algorithm: str = "RS256", **claims: Any) -> str:
        """Sign a token; claims that are None are left out."""
        return jwt.encode(self.claims(**claims), self.keys[key_id], algorithm, {"kid": key_id})

    def claims(self, **changes: Any) -> dict[str, Any]:
        now = int(datetime.now(UTC).timestamp())
        usual = {"iss": self.url, "aud": AUDIENCE, "sub": "station-4", "iat": now, "exp": now + 3600}
        usual |= {"tenant": "plant-north", "scope": "openid read upload repair"}
        return {name: value for name, value in (usual | changes).items() if value is not None}

    def stop(self) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def _document(self, path: str) -> dict[str, Any] | None:
        if path == "/realm/.well-known/openid-configuration":
            return {"issuer": self.url, "jwks_uri": f"{self.url}/keys"} | self.metadata
        if path == "/realm/keys":
            self.n_requests += 1
            return {"keys": [*(entry_of(key_id, key) for key_id, key in self.keys.items()), *self.extra_entries]}
        return None

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        issuer = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                document = None if issuer.is_down else issuer._document(self.path)
                self.send_response(200 if document is not None else 503)
                self.end_headers()
                self.wfile.write(json.dumps(document or {}).encode())

            def log_message(self, *_: object) -> None:
                """Say nothing."""

        return Handler


@contextmanager
def running_issuer() -> Iterator[Issuer]:
    """Run an issuer with one RSA key for the length of a `with` block."""
    issuer = Issuer()
    try:
        issuer.add_rsa("first")
        yield issuer
    finally:
        issuer.stop()


def entry_of(key_id: str, key: PrivateKey) -> dict[str, Any]:
    """Write the public part of a key as an entry of a key set."""
    if isinstance(key, rsa.RSAPrivateKey):
        entry = RSAAlgorithm.to_jwk(key.public_key(), as_dict=True)
    else:
        entry = ECAlgorithm.to_jwk(key.public_key(), as_dict=True)
    return {**entry, "kid": key_id, "use": "sig"}
