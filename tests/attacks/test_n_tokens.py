"""Tokens of an OIDC issuer, and what is no such token: `service/tokens.py`, `service/issuer.py`.

The issuer is a real one, on a port of this machine.
"""

import base64
import hashlib
import hmac
import json
from collections.abc import Iterator
from datetime import UTC, datetime
from typing import Any

import jwt
import pytest
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.database.tables import JobRow
from jobkit.egress import parse_networks
from jobkit.errors import SettingsError
from jobkit.settings import Settings, load_settings
from service import issuer as issuers
from service.app import create_app
from service.services import Services
from tests.oidc_issuer import AUDIENCE, Issuer, entry_of, running_issuer

NOW = int(datetime.now(UTC).timestamp())
KEY = "the-key-of-the-operator"


@pytest.fixture(scope="module")
def shared_issuer() -> Iterator[Issuer]:
    with running_issuer() as issuer:
        issuer.add_ec("curve")
        yield issuer


@pytest.fixture
def issuer() -> Iterator[Issuer]:
    with running_issuer() as issuer:
        yield issuer


def trusting(settings: Settings, issuer: Issuer, **changes: Any) -> Settings:
    usual = {"oidc_issuer": issuer.url, "oidc_audience": AUDIENCE, "oidc_allowed_networks": "127.0.0.0/8"}
    return settings.model_copy(update=usual | {"api_keys": SecretStr(KEY)} | changes)


@pytest.fixture
def client(settings: Settings, shared_issuer: Issuer) -> Iterator[TestClient]:
    with TestClient(create_app(trusting(settings, shared_issuer)), base_url="http://127.0.0.1") as client:
        yield client


def ask(client: TestClient, token: str, path: str = "/v1/jobs", method: str = "GET") -> tuple[int, str]:
    answer = client.request(method, path, headers={"Authorization": f"Bearer {token}"})
    return answer.status_code, answer.json().get("code", "")


def part(value: dict[str, Any]) -> str:
    return base64.urlsafe_b64encode(json.dumps(value).encode()).rstrip(b"=").decode()


def test_a_token_acts_for_its_tenant_with_its_scopes(client: TestClient, shared_issuer: Issuer) -> None:
    token = shared_issuer.token("first")
    limits = client.get("/v1/limits", headers={"Authorization": f"Bearer {token}"})
    assert limits.json()["tenant"] == "plant-north"
    assert ask(client, token) == (200, "")
    assert ask(client, token, "/v1/keys") == (403, "scope_missing")
    assert ask(client, shared_issuer.token("curve", "ES256", scope=["admin"]), "/v1/keys") == (200, "")
    assert ask(client, shared_issuer.token("first", "PS384", aud=["other", AUDIENCE])) == (200, "")
    # Keys are taken as before.
    assert client.get("/v1/jobs", headers={"X-API-Key": KEY}).status_code == 200
    assert client.get("/v1/jobs").status_code == 401


def test_a_job_keeps_the_digest_of_its_token_and_not_the_subject(client: TestClient, shared_issuer: Issuer) -> None:
    token = shared_issuer.token("first", sub="ann@example.org", scope=["read", "upload", "repair"])
    headers, ply = {"Authorization": f"Bearer {token}"}, b"ply\nformat ascii 1.0\nend_header\n"
    mesh_id = client.post("/v1/meshes", content=ply, headers=headers).json()["id"]
    job = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}}, headers=headers).json()
    digest = hashlib.sha256(f"{shared_issuer.url}\nann@example.org".encode()).hexdigest()
    services: Services = client.app.state.services  # type: ignore[attr-defined]
    with services.database.read() as session:
        row = session.get(JobRow, job["id"])
        assert row is not None
        assert row.asked_by == f"oidc-{digest[:32]}"


def test_a_key_of_the_settings_may_look_like_a_token(settings: Settings, shared_issuer: Issuer) -> None:
    odd = "a-key.with-dots.like-a-token"
    app = create_app(trusting(settings, shared_issuer, api_keys=SecretStr(odd)))
    with TestClient(app, base_url="http://127.0.0.1") as client:
        assert ask(client, odd) == (200, "")
        assert ask(client, f"{odd}x") == (401, "invalid_token")


def test_a_token_sees_nothing_of_another_tenant(client: TestClient, shared_issuer: Issuer) -> None:
    own, other = (
        {"Authorization": f"Bearer {shared_issuer.token('first', tenant=name)}"} for name in ("plant-north", "plant-b")
    )
    mesh = client.post("/v1/meshes", content=b"ply\nformat ascii 1.0\nend_header\n", headers=own).json()
    assert client.get(mesh["links"]["self"], headers=own).status_code == 200
    assert client.get(mesh["links"]["self"], headers=other).json()["code"] == "mesh_not_found"


@pytest.mark.parametrize(
    ("claims", "reason"),
    [
        ({"aud": "another-service"}, "it is for another audience"),
        ({"aud": None}, "it lacks one of"),
        ({"iss": "https://another.example"}, "it is of another issuer"),
        ({"iss": None}, "it lacks one of"),
        ({"exp": NOW - 3600}, "it has expired"),
        ({"exp": None}, "it lacks one of"),
        ({"exp": "never"}, "it is not well-formed"),
        ({"nbf": NOW + 3600}, "it is not valid yet"),
        ({"sub": None}, "it lacks one of"),
    ],
)
def test_a_token_with_wrong_claims_is_refused(
    client: TestClient, shared_issuer: Issuer, claims: dict[str, Any], reason: str
) -> None:
    answer = client.get("/v1/jobs", headers={"Authorization": f"Bearer {shared_issuer.token('first', **claims)}"})
    assert (answer.status_code, answer.json()["code"]) == (401, "invalid_token")
    assert reason in answer.json()["detail"]
    assert 'error="invalid_token"' in answer.headers["www-authenticate"]


def test_clocks_may_differ_by_half_a_minute(client: TestClient, shared_issuer: Issuer) -> None:
    now = int(datetime.now(UTC).timestamp())
    soon, just = now + 10, now - 10
    assert ask(client, shared_issuer.token("first", nbf=soon, iat=soon)) == (200, "")
    assert ask(client, shared_issuer.token("first", exp=just)) == (200, "")


def test_a_token_without_a_signature_is_refused(client: TestClient, shared_issuer: Issuer) -> None:
    for algorithm in ("none", "None", "NONE", ""):
        head = {"alg": algorithm, "kid": "first", "typ": "JWT"}
        assert ask(client, f"{part(head)}.{part(shared_issuer.claims())}.") == (401, "invalid_token")


def test_a_token_signed_with_the_public_key_as_a_secret_is_refused(client: TestClient, shared_issuer: Issuer) -> None:
    public = shared_issuer.keys["first"].public_key()
    for form in (PublicFormat.SubjectPublicKeyInfo, PublicFormat.PKCS1):
        secret = public.public_bytes(Encoding.PEM, form)
        for algorithm, digest in (("HS256", hashlib.sha256), ("HS512", hashlib.sha512)):
            signed = f"{part({'alg': algorithm, 'kid': 'first'})}.{part(shared_issuer.claims())}"
            mac = hmac.new(secret, signed.encode(), digest).digest()
            forged = f"{signed}.{base64.urlsafe_b64encode(mac).rstrip(b'=').decode()}"
            assert ask(client, forged) == (401, "invalid_token")


def test_a_token_of_a_key_that_it_brings_itself_is_refused(client: TestClient, shared_issuer: Issuer) -> None:
    with running_issuer() as foreign:
        for head in (
            {"jku": f"{foreign.url}/keys"},
            {"jwk": entry_of("first", foreign.keys["first"])},
            {"x5u": foreign.url},
        ):
            forged = jwt.encode(shared_issuer.claims(), foreign.keys["first"], "RS256", {"kid": "first", **head})
            assert ask(client, forged) == (401, "invalid_token")
        assert foreign.n_requests == 0


def test_a_changed_token_and_one_for_another_kind_of_key_are_refused(client: TestClient, shared_issuer: Issuer) -> None:
    head, claims, signature = shared_issuer.token("first").split(".")
    assert ask(client, f"{head}.{part(shared_issuer.claims(tenant='default'))}.{signature}") == (401, "invalid_token")
    assert ask(client, f"{head}.{claims}.") == (401, "invalid_token")
    assert ask(client, f"{part({'alg': 'ES256', 'kid': 'first'})}.{claims}.{signature}") == (401, "invalid_token")


@pytest.mark.parametrize(
    "head", [{}, {"kid": 7}, {"kid": "unknown"}, {"kid": "first", "crit": ["exp"]}, {"kid": "../first"}]
)
def test_a_token_whose_header_names_no_key_is_refused(
    client: TestClient, shared_issuer: Issuer, head: dict[str, Any]
) -> None:
    signed = f"{part({'alg': 'RS256', **head})}.{part(shared_issuer.claims())}"
    assert ask(client, f"{signed}.AAAA") == (401, "invalid_token")


@pytest.mark.parametrize("tenant", [None, "", "Plant North", 7, ["default"], "a/b"])
def test_a_token_that_names_no_tenant_reaches_none(client: TestClient, shared_issuer: Issuer, tenant: object) -> None:
    assert ask(client, shared_issuer.token("first", tenant=tenant)) == (403, "tenant_missing")


@pytest.mark.parametrize("scope", [None, "", "openid profile", 7, {"read": True}, "READ", [["read"]]])
def test_a_token_without_scopes_may_nothing(client: TestClient, shared_issuer: Issuer, scope: object) -> None:
    assert ask(client, shared_issuer.token("first", scope=scope)) == (403, "scope_missing")


@pytest.mark.parametrize("text", ["a.b.c", "....", "é.é.é", "a.b", "A" * 40_000, f"{'A' * 20_000}.A.A"])
def test_what_is_no_token_is_refused(client: TestClient, text: str) -> None:
    answer = client.get("/v1/jobs", headers={b"Authorization": b"Bearer " + text.encode("latin-1")})
    assert answer.status_code == 401


def test_a_key_that_is_new_at_the_issuer_works_at_once_and_one_that_it_took_back_ends(
    settings: Settings, issuer: Issuer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(issuers, "PAUSE_S", 0.0)
    with TestClient(create_app(trusting(settings, issuer)), base_url="http://127.0.0.1") as client:
        old = issuer.token("first")
        assert ask(client, old) == (200, "")
        issuer.add_rsa("second")
        assert ask(client, issuer.token("second")) == (200, "")
        del issuer.keys["first"]
        assert ask(client, old) == (200, "")
        monkeypatch.setattr(issuers, "FRESH_S", 0.0)
        assert ask(client, old) == (401, "invalid_token")


def test_invented_keys_do_not_make_the_service_flood_the_issuer(settings: Settings, issuer: Issuer) -> None:
    with TestClient(create_app(trusting(settings, issuer)), base_url="http://127.0.0.1") as client:
        for i in range(20):
            head = part({"alg": "RS256", "kid": f"invented-{i}"})
            assert ask(client, f"{head}.{part(issuer.claims())}.AAAA") == (401, "invalid_token")
    assert issuer.n_requests == 1


def test_while_the_issuer_does_not_answer_keys_that_are_known_go_on(
    settings: Settings, issuer: Issuer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(issuers, "PAUSE_S", 0.0)
    with TestClient(create_app(trusting(settings, issuer)), base_url="http://127.0.0.1") as client:
        issuer.is_down = True
        refused = client.get("/v1/jobs", headers={"Authorization": f"Bearer {issuer.token('first')}"})
        assert (refused.status_code, refused.json()["code"]) == (503, "issuer_unavailable")
        assert refused.headers["retry-after"]
        assert refused.json()["retryable"] is True
        issuer.is_down = False
        assert ask(client, issuer.token("first")) == (200, "")
        issuer.is_down = True
        monkeypatch.setattr(issuers, "FRESH_S", 0.0)
        assert ask(client, issuer.token("first")) == (200, "")
        issuer.add_rsa("second")
        assert ask(client, issuer.token("second")) == (503, "issuer_unavailable")
        # Not for ever: an issuer may have taken a key back.
        monkeypatch.setattr(issuers, "STALE_S", 0.0)
        assert ask(client, issuer.token("first")) == (503, "issuer_unavailable")
        assert client.get("/v1/jobs", headers={"X-API-Key": KEY}).status_code == 200


@pytest.mark.parametrize(
    "metadata",
    [
        {"issuer": "https://another.example"},
        {"jwks_uri": "file:///etc/passwd"},
        {"jwks_uri": "http://10.0.0.1/keys"},
        {"jwks_uri": 7},
    ],
)
def test_an_issuer_that_leads_elsewhere_is_not_followed(
    settings: Settings, issuer: Issuer, metadata: dict[str, Any]
) -> None:
    issuer.metadata = metadata
    with TestClient(create_app(trusting(settings, issuer)), base_url="http://127.0.0.1") as client:
        assert ask(client, issuer.token("first")) == (503, "issuer_unavailable")


def test_an_issuer_outside_of_the_allowed_networks_is_not_asked(settings: Settings, issuer: Issuer) -> None:
    guarded = trusting(settings, issuer, oidc_allowed_networks="")
    with TestClient(create_app(guarded), base_url="http://127.0.0.1") as client:
        assert ask(client, issuer.token("first")) == (503, "issuer_unavailable")
    assert issuer.n_requests == 0


def test_keys_that_verify_nothing_are_left_out(issuer: Issuer) -> None:
    issuer.add_rsa("short", bits=1024)
    issuer.extra_entries = [
        {"kty": "oct", "kid": "secret", "k": "AAAA"},
        {"kty": "XX", "kid": "odd"},
        {**entry_of("encryption", issuer.keys["first"]), "use": "enc"},
    ]
    found = issuers.fetch_keys(issuer.url, parse_networks("127.0.0.0/8"))
    assert set(found) == {"first"}
    assert not [name for key in found.values() for name in key.algorithms if name.startswith("HS") or name == "none"]


def test_an_issuer_needs_an_audience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("QUADPATCH_OIDC_ISSUER", "https://issuer.example")
    with pytest.raises(SettingsError, match="QUADPATCH_OIDC_AUDIENCE"):
        load_settings()
    monkeypatch.setenv("QUADPATCH_OIDC_AUDIENCE", AUDIENCE)
    assert load_settings().oidc_audience == AUDIENCE
