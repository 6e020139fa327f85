"""Also tests `service.database_metrics`."""

from collections.abc import Callable
from datetime import timedelta
from pathlib import Path

import pytest
from prometheus_client import CollectorRegistry, generate_latest
from prometheus_client.parser import text_string_to_metric_families
from pydantic import SecretStr
from sqlalchemy import update
from starlette.testclient import TestClient

from dispatcher.scrub import Scrub, ScrubLimits
from jobkit.database.clock import utc_now
from jobkit.database.leadership import DISPATCHER, Leadership
from jobkit.database.tables import JobRow
from jobkit.errors import MemoryFullError
from jobkit.jobs.admission import Admission, AdmissionRules
from jobkit.jobs.memory_needs import MemoryNeeds
from jobkit.jobs.past_jobs import kind_of
from jobkit.jobs.reservations import Machine, MachineMemory
from jobkit.jobs.stage_seconds import StageSeconds
from jobkit.settings import Settings
from quadpatch_client.schema import TASKS, HoleCounts, Job, JobError, JobResult, ModelVersion
from service.app import create_app
from service.metrics import CACHE_S, StateCollector
from service.services import Services
from tests.jobkit.fixtures import DAY, age_rows, damage

Sample = tuple[str, frozenset[tuple[str, str]]]


def parsed(text: str) -> dict[Sample, float]:
    families = text_string_to_metric_families(text)
    return {(s.name, frozenset(s.labels.items())): s.value for family in families for s in family.samples}


def figures(services: Services) -> dict[Sample, float]:
    """What a scrape gets of database, queue and disk, without waiting for the second to be over."""
    registry = CollectorRegistry(auto_describe=False)
    registry.register(StateCollector(services))
    return parsed(generate_latest(registry).decode())


def scraped(client: TestClient) -> dict[Sample, float]:
    answer = client.get("/metrics")
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/plain; version=0.0.4")
    return parsed(answer.text)


def sample(name: str, /, **labels: str) -> Sample:
    return f"quadpatch_{name}", frozenset(labels.items())


def age_everything(services: Services, seconds: float) -> None:
    """Let time pass for all jobs."""
    with services.database.write() as session:
        ages = {"queued_at": utc_now() - timedelta(seconds=seconds)}
        session.execute(update(JobRow).values(ages))


def test_a_job_shows_in_its_state_and_in_the_queue(services: Services, job_id: str) -> None:
    age_everything(services, 100)
    found = figures(services)
    assert found[sample("jobs", state="queued")] == 1
    assert found[sample("jobs", state="failed")] == 0
    assert found[sample("queue_length", kind="repair")] == 1
    assert found[sample("queue_length", kind="analysis")] == 1
    assert found[sample("queue_entries")] == 2
    assert 100 <= found[sample("queue_oldest_age_seconds", kind="repair")] < 200
    assert found[sample("tasks_at_work", kind="repair")] == 0


def test_an_attempt_that_falls_silent_shows_in_the_age_of_its_lease(services: Services, job_id: str) -> None:
    assert figures(services)[sample("lease_oldest_age_seconds")] == 0
    services.attempts.start(job_id, "w", services.settings.lease_s)
    with services.database.write() as session:
        session.execute(update(JobRow).values(lease_until=utc_now() + timedelta(seconds=services.settings.lease_s - 9)))
    found = figures(services)
    assert 9 <= found[sample("lease_oldest_age_seconds")] < 60
    assert found[sample("tasks_at_work", kind="repair")] == 1
    assert found[sample("queue_oldest_age_seconds", kind="repair")] == 0


def test_attempts_and_stages_are_added_up(services: Services, job_id: str) -> None:
    lost = JobError(code="worker_lost", message="gone", retryable=True)
    services.attempts.requeue(services.attempts.start(job_id, "w", 30).attempt, lost)
    second = services.attempts.start(job_id, "w", 30).attempt
    result = JobResult(format="ply", holes=HoleCounts(found=1), files=[])
    services.attempts.publish(second, result, StageSeconds("smooth", {"fill": 2.5}))
    found = figures(services)
    assert found[sample("attempts_total", outcome="requeued", code="worker_lost")] == 1
    assert found[sample("attempts_total", outcome="succeeded", code="")] == 1
    assert [found[sample("jobs_by_task", task=task)] for task in TASKS] == [1, 0, 0, 0, 0, 0]
    assert found[sample("stage_duration_seconds_sum", stage="fill", method="smooth", task="fill")] == 2.5
    assert found[sample("stage_duration_seconds_count", stage="fill", method="smooth", task="fill")] == 1


def test_who_leads_and_since_when_is_told(services: Services) -> None:
    found = figures(services)
    assert found[sample("dispatcher_up")] == 0
    assert sample("dispatcher_leader_start_time_seconds") not in found
    before = utc_now().timestamp()
    assert Leadership(services.database, DISPATCHER, "d-1", 30).lead()
    found = figures(services)
    assert found[sample("dispatcher_up")] == 1
    assert found[sample("dispatcher_leader_start_time_seconds")] >= before - 0.001


def test_a_leader_whose_lease_ran_out_leads_no_more(services: Services) -> None:
    assert Leadership(services.database, DISPATCHER, "d-1", -1).lead()
    found = figures(services)
    assert found[sample("dispatcher_up")] == 0
    assert sample("dispatcher_leader_start_time_seconds") not in found


def test_models_and_what_aliases_point_to_are_told(
    client: TestClient,
    services: Services,
    dictionary_bytes: Callable[[int], bytes],
    publish: Callable[..., ModelVersion],
) -> None:
    version = publish("parts", dictionary_bytes(1))
    client.put("/v1/aliases/default", json={"model": "parts@1"})
    found = figures(services)
    labels = {"name": "parts", "version": "1", "kind": "dictionary", "sha256": version.sha256}
    assert found[sample("model_info", **labels)] == 1
    assert found[sample("model_alias_info", alias="default", name="parts", version="1")] == 1


def test_what_the_scrub_read_and_found_is_told(services: Services, mesh_id: str, tmp_path: Path) -> None:
    found = figures(services)
    assert found[sample("scrub_objects_total", kind="mesh")] == 0
    assert found[sample("scrub_period_seconds")] == 30 * 86_400
    damage(services.store, services.meshes.source(mesh_id).key, tmp_path)
    age_rows(services.database, 28 * DAY)
    assert found[sample("scrub_oldest_check_age_seconds")] < 28 * 86_400
    assert figures(services)[sample("scrub_oldest_check_age_seconds")] >= 28 * 86_400
    read = Scrub(services.database, services.store, ScrubLimits(30, 1e9)).round()
    found = figures(services)
    assert found[sample("scrub_objects_total", kind="mesh")] == 1
    assert found[sample("scrub_bytes_total", kind="mesh")] == read.size_bytes
    assert found[sample("damaged_objects", kind="mesh")] == 1
    assert found[sample("damaged_objects", kind="result")] == 0
    assert found[sample("scrub_oldest_check_age_seconds")] < 28 * 86_400


def test_requests_are_counted_by_the_template_of_their_route(client: TestClient) -> None:
    for path in ("/v1/jobs", "/v1/jobs?limit=x", "/v1/meshes/" + "0" * 64, "/nowhere", "/neither"):
        client.get(path)
    client.request("BREW", "/v1/jobs")
    found = scraped(client)
    counts = {
        dict(labels)["route"] + " " + dict(labels)["status"]: value
        for (name, labels), value in found.items()
        if name == "quadpatch_http_request_duration_seconds_count"
    }
    assert counts["/v1/jobs 200"] == 1
    assert counts["/v1/jobs 422"] == 1
    assert counts["/v1/meshes/{mesh_id} 404"] == 1
    assert counts["none 404"] == 2
    methods = {dict(labels).get("method") for name, labels in found if name.endswith("_duration_seconds_count")}
    assert {"GET", "other"} <= methods
    assert "BREW" not in methods


def test_disk_process_and_build_are_told(client: TestClient) -> None:
    found = scraped(client)
    assert 0 < found[sample("disk_free_bytes")] < found[sample("disk_size_bytes")]
    assert any(name == "quadpatch_build_info" and value == 1 for (name, _), value in found.items())
    assert found["process_resident_memory_bytes", frozenset()] > 0


def test_without_its_queue_the_other_figures_are_still_there(settings: Settings) -> None:
    lonely = settings.model_copy(update={"redis_url": SecretStr("redis://127.0.0.1:1/0")})
    with TestClient(create_app(lonely), base_url="http://127.0.0.1") as client:
        found = scraped(client)
    assert found[sample("queue_up")] == 0
    assert sample("queue_entries") not in found
    assert found[sample("jobs", state="queued")] == 0


def test_without_its_database_the_other_figures_are_still_there(
    services: Services, break_database: Callable[[], None]
) -> None:
    services.database.close()
    break_database()
    found = figures(services)
    assert found[sample("database_up")] == 0
    assert sample("jobs", state="queued") not in found
    assert found[sample("queue_up")] == 1


def test_however_many_ask_the_database_is_read_once_a_second(services: Services, job_id: str) -> None:
    moment = 50.0
    collector = StateCollector(services, lambda: moment)

    def queued() -> float:
        return next(s.value for m in collector.collect() if m.name == "quadpatch_jobs" for s in m.samples)

    assert queued() == 1
    services.jobs.request_cancel(job_id)
    moment += 0.9 * CACHE_S
    assert queued() == 1
    moment += 0.1 * CACHE_S
    assert queued() == 0


@pytest.fixture
def keyed(settings: Settings) -> Callable[[bool], TestClient]:
    def make(is_open: bool) -> TestClient:
        changes = {"api_keys": SecretStr("a-key-of-station-1"), "metrics_open": is_open}
        return TestClient(create_app(settings.model_copy(update=changes)), base_url="http://127.0.0.1")

    return make


def test_a_service_with_keys_asks_for_one_unless_its_metrics_are_open(keyed: Callable[[bool], TestClient]) -> None:
    with keyed(False) as client:
        assert client.get("/metrics").status_code == 401
        assert client.get("/metrics", headers={"Authorization": "Bearer a-key-of-station-1"}).status_code == 200
        assert client.app.openapi()["paths"]["/metrics"]["get"].get("security") is None  # type: ignore[attr-defined]
    with keyed(True) as client:
        assert client.get("/metrics").status_code == 200
        assert client.get("/v1/jobs").status_code == 401
        assert client.app.openapi()["paths"]["/metrics"]["get"]["security"] == []  # type: ignore[attr-defined]


def test_memory_of_machines_and_of_past_jobs_is_told(services: Services, job_id: str, mesh_id: str) -> None:
    assert figures(services)[sample("memory_waiting_jobs")] == 0
    machine = Machine("m-1", lambda: MachineMemory(limit_mb=4000, free_mb=3000))
    rules = AdmissionRules(attempt_mb=4096, wait_s=60.0)
    first, second = (
        Admission(services.database, MemoryNeeds(services.database), worker, machine, rules) for worker in ("w1", "w2")
    )
    first.reserve(3900, lease_s=600.0)
    with pytest.raises(MemoryFullError):
        services.attempts.start(job_id, "w2", 600.0, second)
    found = figures(services)
    assert found[sample("memory_limit_bytes", machine="m-1")] == 4000 << 20
    assert found[sample("memory_free_bytes", machine="m-1")] == 3000 << 20
    assert found[sample("memory_reserved_bytes", machine="m-1")] == 3900 << 20
    assert found[sample("memory_waiting_jobs")] == 1
    first.reserve(3900, lease_s=-1.0)
    with services.database.write() as session:
        session.execute(update(JobRow).values(not_before=None))
    attempt = services.attempts.start(job_id, "w2", 600.0, second).attempt
    services.attempts.publish(attempt, JobResult(format="ply", peak_memory_mb=312))
    second.release()
    found = figures(services)
    assert found[sample("memory_reserved_bytes", machine="m-1")] == 0
    assert found[sample("memory_waiting_jobs")] == 0
    kind = kind_of("fill", services.jobs.get(job_id).model.kind)
    assert found[sample("job_peak_memory_bytes", kind=kind)] == 312 << 20


def test_the_hands_of_a_worker_show_in_the_figures(
    services: Services, job_id: str, finish: Callable[[str], Job]
) -> None:
    finish(job_id)
    assert figures(services)[sample("jobs", state="succeeded")] == 1
