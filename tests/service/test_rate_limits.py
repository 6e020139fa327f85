"""Rate limits: `service/rate_limits.py`, `service/shares.py`. Valkey is a real one."""

import logging
import re
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from typing import Any

import httpx
import pytest
from pydantic import SecretStr
from starlette.testclient import TestClient

from jobkit.settings import Settings
from onebox.valkey import running_valkey
from service import auth, rate_limits, shares
from service.app import create_app
from tests.servers import free_port
from tests.waiting import GUARD_S

OPERATOR_KEY = "the-key-of-the-operator"
TENANT = "plant-north"


@pytest.fixture
def keyed(settings: Settings) -> Settings:
    changes = {"api_keys": SecretStr(OPERATOR_KEY), "tenant_requests_per_minute": 5, "address_requests_per_minute": 3}
    return settings.model_copy(update={**changes, "health_requests_per_minute": 4})


@pytest.fixture
def open_app() -> Iterator[Callable[[Settings], TestClient]]:
    with ExitStack() as stack:
        yield lambda settings: stack.enter_context(TestClient(create_app(settings), base_url="http://127.0.0.1"))


def key_of(client: TestClient, tenant: str = TENANT) -> dict[str, str]:
    made = client.post("/v1/keys", json={"name": "x", "tenant": tenant}, headers={"X-API-Key": OPERATOR_KEY})
    return {"X-API-Key": made.json()["key"]}


def test_what_is_left_stands_in_every_answer_until_one_is_too_many(
    keyed: Settings, open_app: Callable[[Settings], TestClient]
) -> None:
    client = open_app(keyed)
    key = key_of(client)
    answers = [client.get("/v1/jobs", headers=key) for _ in range(6)]
    assert [answer.status_code for answer in answers] == [200] * 5 + [429]
    for i, answer in enumerate(answers):
        assert answer.headers["ratelimit-policy"] == '"tenant";q=5;w=60'
        assert re.fullmatch(rf'"tenant";r={max(4 - i, 0)};t=[1-9]\d?', answer.headers["ratelimit"])
    refused = answers[-1]
    assert refused.json()["code"] == "rate_limited"
    assert refused.json()["retryable"] is True
    assert 1 <= int(refused.headers["retry-after"]) <= 60
    # Another key of the same tenant gets no more; another tenant and the operator are not held up.
    assert client.get("/v1/jobs", headers=key_of(client)).status_code == 429
    assert client.get("/v1/jobs", headers=key_of(client, "plant-south")).status_code == 200
    operator = client.get("/v1/jobs", headers={"X-API-Key": OPERATOR_KEY})
    assert operator.status_code == 200
    assert "ratelimit" not in operator.headers


def test_a_key_with_a_limit_of_its_own_takes_no_more_of_its_tenant(
    keyed: Settings, open_app: Callable[[Settings], TestClient], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(auth, "_KNOWN_FOR_S", 0.0)
    client, operator = open_app(keyed), {"X-API-Key": OPERATOR_KEY}
    new = {"name": "x", "tenant": TENANT, "requests_per_minute": 2}
    made = client.post("/v1/keys", json=new, headers=operator).json()
    assert made["requests_per_minute"] == 2
    key = {"X-API-Key": made["key"]}
    answers = [client.get("/v1/jobs", headers=key) for _ in range(3)]
    assert [answer.status_code for answer in answers] == [200, 200, 429]
    assert answers[0].headers["ratelimit-policy"] == '"key";q=2;w=60, "tenant";q=5;w=60'
    assert re.fullmatch(r'"key";r=0;t=\d+, "tenant";r=3;t=\d+', answers[1].headers["ratelimit"])
    assert answers[2].headers["ratelimit-policy"] == '"key";q=2;w=60'
    others = [client.get("/v1/jobs", headers=key_of(client)).status_code for _ in range(4)]
    assert others == [200] * 3 + [429], "what the key was refused is not counted for its tenant"
    path = f"/v1/keys/{made['id']}"
    changes: list[tuple[dict[str, Any], int | None]] = [({}, 2), ({"requests_per_minute": None}, None)]
    for change, then in changes:
        assert client.patch(path, json=change, headers=operator).json()["requests_per_minute"] == then
    answer = client.get("/v1/jobs", headers=key)
    assert answer.headers["ratelimit-policy"] == '"tenant";q=5;w=60'


def test_errors_and_unknown_paths_count_as_well(keyed: Settings, open_app: Callable[[Settings], TestClient]) -> None:
    client = open_app(keyed)
    key = key_of(client)
    paths = ("/v1/jobs/x", "/nowhere", "/v1/keys", "/v1/jobs?wrong=1", "/v1/jobs")
    assert [client.get(path, headers=key).status_code for path in paths] == [422, 404, 403, 422, 200]
    assert client.get("/v1/jobs", headers=key).status_code == 429


def test_what_was_set_for_a_tenant_holds_at_once(
    keyed: Settings, open_app: Callable[[Settings], TestClient], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shares, "_KNOWN_FOR_S", 0.0)
    client = open_app(keyed)
    key, operator = key_of(client), {"X-API-Key": OPERATOR_KEY}
    for requests, field in ((100, '"tenant";q=100;w=60'), (0, None)):
        client.patch(f"/v1/tenants/{TENANT}", json={"requests_per_minute": requests}, headers=operator)
        assert client.get("/v1/jobs", headers=key).headers.get("ratelimit-policy") == field
    client.patch("/v1/tenants/default", json={"requests_per_minute": 2}, headers=operator)
    assert client.get("/v1/jobs", headers=operator).headers["ratelimit-policy"] == '"tenant";q=2;w=60'


def test_requests_that_are_too_many_do_not_fill_the_audit_log(
    keyed: Settings, open_app: Callable[[Settings], TestClient]
) -> None:
    client = open_app(keyed)
    key, operator = key_of(client), {"X-API-Key": OPERATOR_KEY}
    statuses = [client.delete("/v1/jobs/job_01jd7z3v5qk8m2x4c6b8n0a9de", headers=key).status_code for _ in range(9)]
    assert statuses == [404] * 5 + [429] * 4
    client.portal.call(client.app.state.services.audit.flush)  # type: ignore[attr-defined, call-arg, union-attr]
    entries = client.get("/v1/audit", headers=operator).json()["items"]
    assert [entry["status"] for entry in entries if entry["tenant"] == TENANT] == [404] * 5


def test_requests_without_a_key_are_counted_by_their_address(
    keyed: Settings, open_app: Callable[[Settings], TestClient]
) -> None:
    client = open_app(keyed)
    wrong = {"X-API-Key": "not-a-key-of-anyone"}
    answers = [client.get("/v1/jobs", headers=wrong), client.get("/v1/jobs"), client.get("/openapi.json")]
    answers += [client.get("/v1/jobs", headers=wrong), client.get("/openapi.json")]
    assert [answer.status_code for answer in answers] == [401, 401, 200, 429, 429]
    assert answers[0].headers["ratelimit-policy"] == '"address";q=3;w=60'
    assert answers[0].headers["www-authenticate"]
    # Signs of life are counted apart, and a valid key is not held up by wrong ones from its address.
    health = [client.get("/healthz").status_code for _ in range(5)]
    assert health == [200, 200, 200, 200, 429]
    assert client.get("/v1/jobs", headers=key_of(client)).status_code == 200


def test_on_this_machine_without_keys_nothing_is_counted(
    settings: Settings, open_app: Callable[[Settings], TestClient]
) -> None:
    changes = {"address_requests_per_minute": 1, "health_requests_per_minute": 1, "tenant_requests_per_minute": 1}
    client = open_app(settings.model_copy(update=changes))
    assert [client.get(path).status_code for path in ("/v1/jobs", "/healthz") * 3] == [200] * 6


def test_while_valkey_is_away_requests_pass_uncounted_and_are_counted_again_after_it(
    keyed: Settings,
    open_app: Callable[[Settings], TestClient],
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    tmp_path: Path,
) -> None:
    monkeypatch.setattr(rate_limits, "_PAUSE_S", 0.0)
    with ExitStack() as stack:
        url = stack.enter_context(running_valkey(tmp_path))
        client = open_app(keyed.model_copy(update={"redis_url": SecretStr(url)}))
        key = key_of(client)
        assert "ratelimit" in client.get("/v1/jobs", headers=key).headers
    with caplog.at_level(logging.WARNING, "service.rate_limits"):
        answers = [client.get("/v1/jobs", headers=key) for _ in range(8)]
    assert [answer.status_code for answer in answers] == [200] * 8
    assert all("ratelimit" not in answer.headers for answer in answers)
    assert "Valkey does not answer" in caplog.text
    assert url not in caplog.text
    figures = client.get("/metrics", headers={"X-API-Key": OPERATOR_KEY}).text
    (count,) = re.findall(r"^quadpatch_rate_limit_failures_total (\S+)$", figures, re.MULTILINE)
    assert float(count) >= 8


def test_an_outage_is_asked_about_once_a_second_and_not_by_every_request(
    keyed: Settings, open_app: Callable[[Settings], TestClient], caplog: pytest.LogCaptureFixture
) -> None:
    client = open_app(keyed.model_copy(update={"redis_url": SecretStr(f"redis://127.0.0.1:{free_port()}")}))
    key = key_of(client)
    client.app.state.rates._asks_again_at = float("inf")  # type: ignore[attr-defined]
    assert client.get("/v1/jobs", headers=key).status_code == 200
    assert "Valkey" not in caplog.text


def test_two_stacks_on_one_valkey_count_apart(keyed: Settings, open_app: Callable[[Settings], TestClient]) -> None:
    first, other = open_app(keyed), open_app(keyed.model_copy(update={"queue_name": f"{keyed.queue_name}-b"}))
    key = key_of(first)
    for client in (first, other):
        assert [client.get("/v1/jobs", headers=key).status_code for _ in range(6)] == [200] * 5 + [429]


def test_two_processes_count_together(keyed: Settings, run_service: Callable[..., AbstractContextManager[Any]]) -> None:
    changes = {"api_keys": OPERATOR_KEY, "tenant_requests_per_minute": 10}
    with ExitStack() as stack:
        urls = [stack.enter_context(run_service(keyed, **changes)).url for _ in range(2)]
        client = stack.enter_context(httpx.Client(timeout=GUARD_S))
        made = client.post(
            f"{urls[0]}/v1/keys", json={"name": "x", "tenant": TENANT}, headers={"X-API-Key": OPERATOR_KEY}
        )
        key = {"X-API-Key": made.json()["key"]}
        statuses = [client.get(f"{urls[i % 2]}/v1/jobs", headers=key).status_code for i in range(14)]
    assert statuses == [200] * 10 + [429] * 4
