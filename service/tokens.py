"""OIDC bearer tokens: signed by the issuer of the settings, for the audience of the settings, and of a tenant.

A token is checked as RFC 9068 and RFC 8725 ask: algorithms are pinned by the kind of the key, issuer, audience and
times are compared, and nothing in the header of the token says where its key comes from.

Tested in `tests/attacks/test_n_tokens.py`.
"""

import hashlib
import re
from http import HTTPStatus
from typing import Any

import jwt

from jobkit.access.keys import TOKEN_PREFIX, Holder
from jobkit.settings import Settings
from quadpatch_client.schema import Scope
from quadpatch_rules.ids import TENANT_PATTERN
from quadpatch_rules.text import printable
from service.issuer import IssuerError, SigningKey, SigningKeys
from service.problems import RETRY_AFTER_S, ProblemError

# Clocks of two machines.
LEEWAY_S = 30
_MOST_CHARACTERS = 16_384
_LONGEST_NAME = 64
_REQUIRED = ["exp", "iss", "aud", "sub"]
_SHAPE = re.compile(r"[A-Za-z0-9_-]+\.[A-Za-z0-9_-]+\.[A-Za-z0-9_-]*")
_KNOWN_SCOPES = {scope.value: scope for scope in Scope}


class TokenVerifier:
    """Tells who holds a token.

    Parameters
    ----------
    settings : Settings
        With an issuer.
    keys : SigningKeys, optional
        Of the issuer; None: those that it hands out.
    """

    def __init__(self, settings: Settings, keys: SigningKeys | None = None) -> None:
        self._settings = settings
        self._keys = keys or SigningKeys(settings.oidc_issuer, settings.oidc_networks)

    async def holder(self, token: str) -> Holder:
        """Return who holds a token.

        Raises
        ------
        ProblemError
            401 if it is not valid, 403 if it names no tenant, 503 if the issuer has to be asked and does not answer.
        """
        key = await self._key_of(token)
        try:
            claims: dict[str, Any] = jwt.decode(
                token,
                key.key,
                algorithms=list(key.algorithms),
                audience=self._settings.oidc_audience,
                issuer=self._settings.oidc_issuer,
                leeway=LEEWAY_S,
                options={"require": _REQUIRED},
            )
        except jwt.PyJWTError as error:
            raise invalid_token(_reason(error)) from error
        return self._holder_of(claims)

    async def _key_of(self, token: str) -> SigningKey:
        try:
            header = jwt.get_unverified_header(token)
        except jwt.PyJWTError as error:
            raise invalid_token("it is no token") from error
        key_id = header.get("kid")
        # Extensions that a token marks as critical are none that are known here.
        if len(token) > _MOST_CHARACTERS or not isinstance(key_id, str) or "crit" in header:
            raise invalid_token("its header names no key, or something that is not known here")
        try:
            key = await self._keys.get(key_id)
        except IssuerError as error:
            raise ProblemError(
                HTTPStatus.SERVICE_UNAVAILABLE,
                "issuer_unavailable",
                "the issuer of tokens does not answer; tokens with keys that are known go on",
                {"Retry-After": RETRY_AFTER_S},
            ) from error
        if key is None or header.get("alg") not in key.algorithms:
            raise invalid_token("the issuer has no such key for that algorithm")
        return key

    def _holder_of(self, claims: dict[str, Any]) -> Holder:
        tenant = claims.get(self._settings.oidc_tenant_claim)
        if not isinstance(tenant, str) or re.match(TENANT_PATTERN, tenant) is None:
            detail = f"the claim {self._settings.oidc_tenant_claim} of the token names no tenant"
            raise ProblemError(HTTPStatus.FORBIDDEN, "tenant_missing", detail)
        subject = str(claims["sub"])
        digest = hashlib.sha256(f"{claims['iss']}\n{subject}".encode("utf-8", "surrogatepass")).hexdigest()
        scopes = frozenset(_KNOWN_SCOPES[name] for name in self._scope_names(claims) if name in _KNOWN_SCOPES)
        return Holder(f"{TOKEN_PREFIX}{digest[:32]}", printable(subject)[:_LONGEST_NAME], tenant, scopes)

    def _scope_names(self, claims: dict[str, Any]) -> list[str]:
        value = claims.get(self._settings.oidc_scope_claim)
        names = value.split() if isinstance(value, str) else value
        return [name for name in names if isinstance(name, str)] if isinstance(names, list) else []


def is_token(text: str) -> bool:
    """Tell whether a text has the shape of a token; keys have not."""
    return _SHAPE.fullmatch(text) is not None


def invalid_token(reason: str) -> ProblemError:
    """Return the answer to a token that is not taken."""
    challenge = 'Bearer realm="quadpatch", error="invalid_token"'
    return ProblemError(
        HTTPStatus.UNAUTHORIZED, "invalid_token", f"the token is not valid: {reason}", {"WWW-Authenticate": challenge}
    )


def _reason(error: jwt.PyJWTError) -> str:
    reasons = {
        jwt.ExpiredSignatureError: "it has expired",
        jwt.ImmatureSignatureError: "it is not valid yet",
        jwt.InvalidAudienceError: "it is for another audience",
        jwt.InvalidIssuerError: "it is of another issuer",
        jwt.InvalidSignatureError: "its signature does not fit",
        jwt.MissingRequiredClaimError: f"it lacks one of {', '.join(_REQUIRED)}",
    }
    return next((words for kind, words in reasons.items() if isinstance(error, kind)), "it is not well-formed")
