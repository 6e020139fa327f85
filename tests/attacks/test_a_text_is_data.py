"""Letter A: text that comes from a file or a client is data; one bad row takes nothing else with it."""

import io
import json
import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import text
from starlette.testclient import TestClient

from dispatcher.webhooks import deliver_webhooks
from jobkit.database.session import Database, read_json_column, write_json
from jobkit.errors import JobkitError
from jobkit.logs import JsonFormatter, TextFormatter
from jobkit.models.network_header import read_network_card
from jobkit.settings import Settings
from jobkit.webhooks.deliveries import Deliveries
from jobkit.webhooks.subscriptions import Webhooks
from quadpatch_client.schema import DeliveryState, ModelVersion, NewWebhook
from quadpatch_rules.strict_json import MOST_LEVELS, StrictJsonError, read_json
from quadpatch_rules.text import LONGEST_MESSAGE, has_surrogate, printable
from service.content import content_disposition
from service.formats import clean_filename
from service.problems import MOST_FIELD_ERRORS
from service.services import Services
from tests.service.sse import sent_events
from worker.failures import Failure

HOSTILE = "\ud800\n2026-01-01 ERROR forged\x1b[2J\x9b1m\u202e" + "x" * 300_000
CASES = Path("../shared/cases")
SAFE = st.text(st.characters(codec="utf-8"))
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**60), 2**60) | st.floats(allow_nan=False, allow_infinity=False) | SAFE,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(SAFE, inner, max_size=3),
    max_leaves=8,
)
JSON = {"Content-Type": "application/json"}
REFUSED = [
    '{"a": "\\ud800"}',
    '{"\\udfff": 1}',
    '[["\\udc00\\ud800"]]',
    '{"a": NaN}',
    '{"a": -Infinity}',
    '{"a": 1e999}',
    '{"a": 1, "a": 2}',
    "[" * (MOST_LEVELS + 1) + "]" * (MOST_LEVELS + 1),
    '{"a":' * (MOST_LEVELS + 1) + "1" + "}" * (MOST_LEVELS + 1),
    "[" * 200_000,
    "9" * 5000,
    b'{"a": "\xed\xa0\x80"}',
    b'{"\xff": 1}',
    "",
]


@given(VALUES)
def test_json_that_can_be_written_again_is_read_as_it_is(value: Any) -> None:
    assert read_json(json.dumps(value)) == value
    assert read_json(json.dumps(value, ensure_ascii=False).encode()) == value


@pytest.mark.parametrize("data", REFUSED)
def test_json_that_could_not_be_written_again_is_refused(data: str | bytes) -> None:
    with pytest.raises(StrictJsonError) as caught:
        read_json(data)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) <= LONGEST_MESSAGE


@pytest.mark.parametrize("data", REFUSED[:-1])
def test_every_way_in_refuses_such_json(client: TestClient, data: str | bytes) -> None:
    body = data.encode() if isinstance(data, str) else data
    answers = [
        client.request(method, path, content=body, headers=JSON)
        for method, path in (("POST", "/v1/jobs"), ("POST", "/v1/webhooks"), ("PUT", "/v1/aliases/candidate"))
    ]
    answers += [
        client.post("/v1/repairs", files={"mesh": b"ply", "spec": body}),
        client.post("/v1/models/hostile/versions", files={"artifact": b"\x08\x07", "card": body}),
    ]
    for answer in answers:
        assert answer.status_code in (400, 422), answer.text[:500]
        assert answer.json()["code"] in ("malformed_json", "invalid_request")
    assert client.get("/v1/models").status_code == 200


@given(st.text())
def test_any_text_becomes_one_short_printable_line(words: str) -> None:
    for line in (printable(words), str(JobkitError(words)), Failure("code", words).message):
        assert line.isprintable()
        assert len(line) <= LONGEST_MESSAGE


@given(st.text(max_size=400))
def test_any_file_name_is_fit_for_a_header_and_a_row(name: str) -> None:
    cleaned = clean_filename(name)
    assert cleaned is None or (cleaned.isprintable() and len(cleaned) <= 255)
    content_disposition(cleaned or "x").encode("latin-1")


@given(
    st.recursive(st.text(), lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3))
)
def test_what_is_read_from_a_row_has_an_encoding(value: Any) -> None:
    for stored in (write_json(value), json.dumps(value)):
        read = read_json_column(stored)
        json.dumps(read, ensure_ascii=False).encode()
        assert read == value or has_surrogate(json.dumps(value, ensure_ascii=False))


@pytest.mark.parametrize("formatter", [TextFormatter(), JsonFormatter()])
def test_no_text_forges_a_line_of_the_log(formatter: logging.Formatter) -> None:
    stream = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    handler = logging.StreamHandler(stream)
    handler.setFormatter(formatter)
    try:
        raise ValueError(HOSTILE)
    except ValueError as error:
        record = logging.LogRecord("n", logging.ERROR, "p", 1, "%s", (HOSTILE,), (ValueError, error, None))
    handler.emit(record)
    stream.flush()
    written = stream.buffer.getvalue().decode()
    first, *others = written.splitlines()
    assert "forged" in first
    assert all(line.startswith("    ") for line in others)
    assert all(line.isprintable() for line in (first, *others))
    assert len(written) < 30_000


def test_a_wrong_request_is_answered_shortly_whatever_it_holds(client: TestClient, mesh_id: str) -> None:
    many = {f"unknown-{i}" + "x" * 1000: 1 for i in range(500)}
    problem = client.post("/v1/jobs", json={"mesh_id": mesh_id, **many}).json()
    assert len(problem["errors"]) == MOST_FIELD_ERRORS
    assert len(problem["detail"]) <= LONGEST_MESSAGE
    assert all(len(error["pointer"]) <= LONGEST_MESSAGE for error in problem["errors"])
    for path in ("/a%0ab%1b[2J", "/v1/jobs?" + "x" * 4000 + "=1", "/v1/%ff%fe"):
        answer = client.get(path)
        assert answer.status_code in (404, 422)
        assert answer.json()["detail"].isprintable()


@pytest.fixture
def spoil(services: Services) -> Callable[..., None]:
    """Write into a JSON column what an earlier version wrote, or what none ever did."""

    def act(table: str, column: str, value: str, where: str) -> None:
        with services.database.engine.connect() as connection:
            connection.execute(text(f"UPDATE {table} SET {column} = :value WHERE {where}"), {"value": value})
            connection.commit()

    return act


LONE = json.dumps({"code": "unreadable_mesh", "message": "its type is \ud800", "retryable": False})
BROKEN = json.dumps({"neither": "code", "nor": ["message"]})


@pytest.fixture
def two_jobs(client: TestClient, mesh_id: str) -> tuple[str, str]:
    """A job whose row a test spoils, and one that has nothing to do with it."""
    spec = {"mesh_id": mesh_id, "method": {"method": "smooth"}}
    ids = [client.post("/v1/jobs", json=spec).json()["id"] for _ in range(2)]
    client.post(f"/v1/jobs/{ids[0]}/cancel")
    client.post(f"/v1/jobs/{ids[1]}/cancel")
    return ids[0], ids[1]


def test_what_has_no_encoding_in_a_row_is_replaced(
    client: TestClient, two_jobs: tuple[str, str], spoil: Callable[..., None]
) -> None:
    bad, _ = two_jobs
    spoil("jobs", "error", LONE, f"id = '{bad}'")
    spoil("events", "data", json.dumps({"error": json.loads(LONE)}), f"job_id = '{bad}'")
    assert client.get(f"/v1/jobs/{bad}").json()["error"]["message"] == "its type is \ufffd"
    assert len(client.get("/v1/jobs").json()["items"]) == 2
    assert len(client.get(f"/v1/jobs/{bad}/events").json()["items"]) == 2


@pytest.mark.parametrize("column", ["error", "spec", "model", "state"])
def test_a_list_goes_on_without_a_row_that_cannot_be_read(
    client: TestClient, two_jobs: tuple[str, str], spoil: Callable[..., None], column: str
) -> None:
    bad, good = two_jobs
    spoil("jobs", column, "nowhere" if column == "state" else BROKEN, f"id = '{bad}'")
    page = client.get("/v1/jobs")
    assert [job["id"] for job in page.json()["items"]] == [good]
    assert client.get(f"/v1/jobs/{good}").status_code == 200
    assert client.get(f"/v1/jobs/{bad}").status_code in (404, 500)


def test_streams_go_on_past_an_event_that_cannot_be_read(
    client: TestClient, two_jobs: tuple[str, str], spoil: Callable[..., None]
) -> None:
    bad, good = two_jobs
    spoil("events", "data", '["no", "object"]', f"job_id = '{bad}'")
    for job_id in (bad, good, bad):
        answer = client.get(f"/v1/jobs/{job_id}/events", headers={"Accept": "text/event-stream"})
        assert [event.type for event in sent_events(answer.text.splitlines())] == ["queued", "canceled"]


def test_the_poller_of_all_streams_outlives_a_look_that_fails(
    client: TestClient, services: Services, two_jobs: tuple[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[object] = []
    read = services.streams._read

    def fail_once(watched: Any) -> Any:
        looks.append(watched)
        if len(looks) == 1:
            raise RuntimeError("a fault of any kind")
        return read(watched)

    monkeypatch.setattr(services.streams, "_read", fail_once)
    answer = client.get(f"/v1/jobs/{two_jobs[0]}/events", headers={"Accept": "text/event-stream"})
    assert [event.type for event in sent_events(answer.text.splitlines())] == ["queued", "canceled"]
    assert len(looks) >= 2


def test_lists_of_models_and_webhooks_go_on_too(
    client: TestClient,
    spoil: Callable[..., None],
    dictionary_bytes: Callable[[int], bytes],
    publish: Callable[..., ModelVersion],
) -> None:
    for seed in (1, 2):
        publish("mine", dictionary_bytes(seed))
    spoil("models", "card", json.dumps({"description": ["none"]}), "name = 'mine' AND version = 1")
    spoil("models", "card", json.dumps({"description": "\ud800"}), "name = 'mine' AND version = 2")
    (mine,) = [model for model in client.get("/v1/models").json()["models"] if model["name"] == "mine"]
    assert [version["card"]["description"] for version in mine["versions"]] == ["\ufffd"]


def test_a_message_that_cannot_be_sent_is_given_up_like_any_other(
    settings: Settings, services: Services, database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    webhook = Webhooks(database, lambda url: None).create(NewWebhook(url="https://127.0.0.1:1/", events=["job.failed"]))
    delivery = services.deliveries.send_test(webhook.id)

    async def fail(*_: object) -> None:
        raise UnicodeEncodeError("utf-8", "\ud800", 0, 1, "surrogates not allowed")

    monkeypatch.setattr("dispatcher.sending.Sender.send", fail)
    assert "failed" in deliver_webhooks(database, settings, lambda: False)
    seen = Deliveries(database).get(webhook.id, delivery.id)
    assert seen.state is DeliveryState.PENDING
    assert [(entry.number, entry.error) for entry in seen.log] == [(1, "it can't be sent (UnicodeEncodeError)")]


@pytest.mark.parametrize("card", [b'{"a": "\\ud800"}', b'{"a": NaN}', b'{"a":' * 40 + b"1" + b"}" * 40])
def test_a_card_inside_a_network_is_read_as_strictly(tmp_path: Path, card: bytes) -> None:
    entry = b"\x0a\x04card\x12" + bytes([len(card) % 128 | (0x80 if len(card) > 127 else 0)])
    entry += (bytes([len(card) // 128]) if len(card) > 127 else b"") + card
    size = bytes([len(entry) % 128 | 0x80, len(entry) // 128]) if len(entry) > 127 else bytes([len(entry)])
    path = tmp_path / "network.onnx"
    path.write_bytes(b"\x08\x07" + b"\x72" + size + entry)
    assert read_network_card(path) is None
    path.write_bytes(path.read_bytes().replace(card, b"{}" + b" " * (len(card) - 2)))
    assert read_network_card(path) == {}


@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases is not here")
@pytest.mark.parametrize("name", ["lone_surrogate.gltf", "line_breaks_in_name.gltf"])
def test_the_files_that_began_it_leave_plain_messages(name: str) -> None:
    from quadpatch.errors import QuadpatchError  # noqa: PLC0415 - only where the files are
    from quadpatch.repair import inspect_file  # noqa: PLC0415

    try:
        found = json.dumps(inspect_file(CASES / name), ensure_ascii=False)
    except QuadpatchError as error:
        found = str(error)
    assert found.isprintable()
    found.encode()
