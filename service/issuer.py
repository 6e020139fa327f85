"""Signing keys of an OIDC issuer: found by its metadata, fetched under the rules of `jobkit.egress`, and cached.

Keys are asked for anew every ten minutes, and at once, though not every time, where a token names one that is not
known: so a new key of the issuer works at once, and tokens with invented names can't make this service flood the
issuer. While the issuer does not answer, keys that are known go on for a day.

Tested in `tests/attacks/test_n_tokens.py`.
"""

import asyncio
import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import anyio.to_thread
import httpx
import jwt
from cryptography.hazmat.primitives.asymmetric.ec import EllipticCurvePublicKey
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPublicKey

from jobkit.egress import Address, Destination, Networks, check_addresses, destination_of, resolve
from jobkit.errors import JobkitError

FRESH_S, STALE_S = 600.0, 86_400.0
# Between two requests for a key that is not known, or to an issuer that failed.
PAUSE_S = 10.0
_TIMEOUT_S, _CONNECT_S = 10.0, 5.0
_MOST_BYTES = 1 << 20
_MOST_KEYS = 100
_LEAST_RSA_BITS = 2048
# By the kind of the key, never by what the token says: no `none`, and no HMAC with a public key as its secret.
_RSA = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512")
_CURVES = {"secp256r1": "ES256", "secp384r1": "ES384", "secp521r1": "ES512"}


class IssuerError(Exception):
    """The issuer does not answer, or not as an issuer does."""


@dataclass(frozen=True)
class SigningKey:
    """A public key, and the algorithms whose signatures it verifies."""

    key: Any
    algorithms: tuple[str, ...]


class SigningKeys:
    """The keys of one issuer.

    Parameters
    ----------
    issuer : str
        Its URL, as tokens name it.
    allowed : networks
        Where it may be besides the internet.
    clock : callable
        Monotonic seconds.
    """

    def __init__(self, issuer: str, allowed: Networks, clock: Callable[[], float] = time.monotonic) -> None:
        self._issuer, self._allowed, self._clock = issuer, allowed, clock
        self._keys: dict[str, SigningKey] = {}
        self._fetched_at = self._asked_at = float("-inf")
        self._has_failed = False
        self._asking = asyncio.Lock()

    async def get(self, key_id: str) -> SigningKey | None:
        """Return a key by its id, None where the issuer has none of that id; raise IssuerError."""
        if self._is_due(key_id) and not (self._asking.locked() and self._known(key_id)):
            async with self._asking:
                # Another request may have fetched them meanwhile.
                if self._is_due(key_id):
                    await self._refresh()
        known = self._known(key_id)
        if known is None and (self._has_failed or self._age_s() > STALE_S):
            raise IssuerError(f"{self._issuer} does not answer, and key {key_id!r} is not known")
        return known

    def _known(self, key_id: str) -> SigningKey | None:
        return self._keys.get(key_id) if self._age_s() <= STALE_S else None

    def _age_s(self) -> float:
        return self._clock() - self._fetched_at

    def _is_due(self, key_id: str) -> bool:
        is_wanted = self._age_s() > FRESH_S or key_id not in self._keys
        return is_wanted and self._clock() - self._asked_at >= PAUSE_S

    async def _refresh(self) -> None:
        self._asked_at = self._clock()
        try:
            self._keys = await anyio.to_thread.run_sync(fetch_keys, self._issuer, self._allowed)
        except (httpx.HTTPError, httpx.InvalidURL, OSError, JobkitError, ValueError, LookupError, TypeError):
            self._has_failed = True
        else:
            self._has_failed, self._fetched_at = False, self._clock()


def fetch_keys(issuer: str, allowed: Networks) -> dict[str, SigningKey]:
    """Fetch the keys of an issuer by OpenID Connect Discovery 1.0; keys of other uses and kinds are left out.

    Raises
    ------
    httpx.HTTPError, OSError, JobkitError, ValueError, LookupError, TypeError
        If it can't be reached, must not be, or answers otherwise than an issuer does.
    """
    metadata = fetch_json(f"{issuer.rstrip('/')}/.well-known/openid-configuration", allowed)
    if metadata["issuer"] != issuer:
        raise ValueError("the metadata are those of another issuer")
    found = fetch_json(str(metadata["jwks_uri"]), allowed)["keys"][:_MOST_KEYS]
    keys = {str(entry["kid"]): read_key(entry) for entry in found if entry.get("kid")}
    return {key_id: key for key_id, key in keys.items() if key is not None}


def read_key(entry: dict[str, Any]) -> SigningKey | None:
    """Read an entry of a JSON Web Key Set; None where no signature is to be verified with it."""
    if entry.get("kty") == "oct" or entry.get("use", "sig") != "sig":
        return None
    try:
        key = jwt.PyJWK.from_dict(entry).key
    except jwt.PyJWTError:
        return None
    algorithms: tuple[str, ...] = ()
    if isinstance(key, RSAPublicKey) and key.key_size >= _LEAST_RSA_BITS:
        algorithms = _RSA
    elif isinstance(key, EllipticCurvePublicKey) and key.curve.name in _CURVES:
        algorithms = (_CURVES[key.curve.name],)
    elif isinstance(key, Ed25519PublicKey):
        algorithms = ("EdDSA",)
    stated = entry.get("alg")
    algorithms = tuple(name for name in algorithms if stated in (None, name))
    return SigningKey(key, algorithms) if algorithms else None


def fetch_json(url: str, allowed: Networks) -> dict[str, Any]:
    """Fetch a JSON object: the name is resolved once, its addresses checked, and one of them connected to.

    No redirect is followed, and no proxy used. Raises as `fetch_keys`.
    """
    if not url.startswith(("https://", "http://")):
        raise ValueError("it is no URL of http or https")
    destination = destination_of(url)
    addresses = resolve(destination)
    check_addresses(destination, addresses, allowed)
    *others, last = addresses
    for address in others:
        try:
            return _get(destination, address)
        except (httpx.ConnectError, httpx.ConnectTimeout):
            continue
    return _get(destination, last)


def _get(destination: Destination, address: Address) -> dict[str, Any]:
    target = destination.target.encode("ascii")
    url = httpx.URL(scheme=destination.scheme, host=str(address), port=destination.port, raw_path=target)
    timeout = httpx.Timeout(_CONNECT_S, connect=_CONNECT_S).as_dict()
    extensions = {"timeout": timeout, "sni_hostname": destination.host}
    headers = {"Host": destination.authority, "Accept": "application/json", "Accept-Encoding": "identity"}
    deadline = time.monotonic() + _TIMEOUT_S
    with httpx.HTTPTransport(verify=httpx.create_ssl_context(), trust_env=False) as transport:
        response = transport.handle_request(httpx.Request("GET", url, headers=headers, extensions=extensions))
        try:
            if response.status_code != httpx.codes.OK:
                raise ValueError(f"the issuer answered {response.status_code}")
            body = bytearray()
            for chunk in response.iter_raw():
                body += chunk
                if len(body) > _MOST_BYTES or time.monotonic() > deadline:
                    raise ValueError("the answer of the issuer is too large, or too slow")
        finally:
            response.close()
    found = json.loads(body)
    if not isinstance(found, dict):
        raise TypeError("the answer of the issuer is no JSON object")
    return found
