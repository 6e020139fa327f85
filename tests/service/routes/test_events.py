import json
from collections.abc import Callable

import pytest
from starlette.testclient import TestClient

from jobkit.settings import Settings
from quadpatch_client.schema import Job
from service.app import create_app
from service.routes.events import accepts_stream
from service.services import Services
from tests.service.sse import sent_events

STREAM = {"Accept": "text/event-stream"}


def test_a_stream_holds_the_events_of_the_pages_and_ends_with_the_job(
    client: TestClient, job_id: str, finish: Callable[[str], Job]
) -> None:
    finish(job_id)
    page = client.get(f"/v1/jobs/{job_id}/events").json()["items"]
    answer = client.get(f"/v1/jobs/{job_id}/events", headers=STREAM)
    events = list(sent_events(answer.text.split("\n")))
    assert [json.loads(event.data) for event in events] == page
    assert [(event.id, event.type) for event in events] == [(item["sequence"], item["type"]) for item in page]
    assert events[-1].type == "succeeded"


def test_a_stream_is_neither_kept_nor_held_up_on_its_way(
    client: TestClient, job_id: str, finish: Callable[[str], Job]
) -> None:
    finish(job_id)
    answer = client.get(f"/v1/jobs/{job_id}/events", headers=STREAM)
    assert answer.headers["content-type"].startswith("text/event-stream")
    assert answer.headers["x-accel-buffering"] == "no"
    assert answer.headers["cache-control"] == "no-store"
    assert answer.headers["vary"] == "Accept"
    assert "retry: 1000\n" in answer.text


@pytest.mark.parametrize("known", [1, 2])
def test_a_stream_goes_on_after_the_last_event_that_the_client_has(
    client: TestClient, job_id: str, finish: Callable[[str], Job], known: int
) -> None:
    revision = finish(job_id).revision
    rest = list(range(known + 1, revision + 1))
    by_header = client.get(f"/v1/jobs/{job_id}/events?after=0", headers=STREAM | {"Last-Event-ID": str(known)})
    by_query = client.get(f"/v1/jobs/{job_id}/events?after={known}", headers=STREAM)
    for answer in (by_header, by_query):
        assert [event.id for event in sent_events(answer.text.split("\n"))] == rest


def test_a_browser_that_has_everything_is_told_not_to_come_back(
    client: TestClient, job_id: str, finish: Callable[[str], Job]
) -> None:
    last = str(finish(job_id).revision)
    answer = client.get(f"/v1/jobs/{job_id}/events", headers=STREAM | {"Last-Event-ID": last})
    assert (answer.status_code, answer.content) == (204, b"")


def test_a_stream_of_an_unknown_job_and_a_number_that_is_none_are_refused(client: TestClient, job_id: str) -> None:
    missing = client.get("/v1/jobs/job_" + "0" * 26 + "/events", headers=STREAM)
    assert (missing.status_code, missing.json()["code"]) == (404, "job_not_found")
    for wrong in ("x", "-1", str(2**31)):
        answer = client.get(f"/v1/jobs/{job_id}/events", headers=STREAM | {"Last-Event-ID": wrong})
        assert (answer.status_code, answer.json()["code"]) == (422, "invalid_request")


def test_one_stream_too_many_is_told_to_come_later_and_pages_still_go(settings: Settings) -> None:
    crowded = settings.model_copy(update={"max_streams": 0})
    with TestClient(create_app(crowded), base_url="http://127.0.0.1") as client:
        mesh_id = client.post("/v1/meshes?filename=a.ply", content=b"ply\n").json()["id"]
        job_id = client.post("/v1/jobs", json={"mesh_id": mesh_id, "method": {"method": "smooth"}}).json()["id"]
        answer = client.get(f"/v1/jobs/{job_id}/events", headers=STREAM)
        assert (answer.status_code, answer.json()["code"]) == (503, "too_many_streams")
        assert int(answer.headers["retry-after"]) > 0
        assert client.get(f"/v1/jobs/{job_id}/events").status_code == 200


def test_a_finished_stream_leaves_its_place(
    client: TestClient, services: Services, job_id: str, finish: Callable[[str], Job]
) -> None:
    finish(job_id)
    client.get(f"/v1/jobs/{job_id}/events", headers=STREAM)
    assert len(services.streams) == 0


@pytest.mark.parametrize(
    ("accept", "wanted"),
    [
        ("text/event-stream", True),
        ("application/json, Text/Event-Stream;q=0.5", True),
        ("", False),
        ("*/*", False),
        ("text/*", False),
        ("application/json", False),
        ("text/event-stream;q=0", False),
        ("text/event-stream; q=0.000", False),
        ("text/event-stream;q=0.1", True),
    ],
)
def test_only_who_names_event_streams_gets_one(accept: str, wanted: bool) -> None:
    assert accepts_stream(accept) is wanted
