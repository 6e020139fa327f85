"""Dashboard, alerts, autoscaler and document, held to the figures that the service really hands out."""

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from prometheus_client.parser import text_string_to_metric_families
from starlette.testclient import TestClient

from jobkit.database.leadership import DISPATCHER, Leadership
from jobkit.jobs.admission import Admission, AdmissionRules
from jobkit.jobs.memory_needs import MemoryNeeds
from jobkit.jobs.reservations import Machine, MachineMemory
from jobkit.jobs.stage_seconds import StageSeconds
from quadpatch_client.schema import HoleCounts, JobResult, ModelVersion
from service.services import Services

ROOT = Path(__file__).parents[2]
DASHBOARD: dict[str, Any] = json.loads((ROOT / "deploy/grafana-dashboard.json").read_text("utf-8"))
ALERTS: dict[str, Any] = yaml.safe_load((ROOT / "deploy/alerts.yaml").read_text("utf-8"))
RULES: list[dict[str, Any]] = [rule for group in ALERTS["groups"] for rule in group["rules"]]
# Added by Prometheus itself.
FOREIGN_LABELS = {"instance", "job"}
_SELECTOR = re.compile(r'\b((?:quadpatch|process)_\w+)(?:\{((?:[^}"]|"[^"]*")*)\})?')
_CONDITION = re.compile(r'(\w+)\s*(?:=~|!~|!=|=)\s*"')
_GROUPING = re.compile(r"\bby \(([^)]*)\)")
_LEGEND = re.compile(r"{{(\w+)}}")

Families = dict[str, set[str]]


@pytest.fixture
def samples(
    client: TestClient,
    services: Services,
    job_id: str,
    dictionary_bytes: Callable[[int], bytes],
    publish: Callable[..., ModelVersion],
) -> Families:
    """Labels of every sample by its name, from a service in which everything has happened once."""
    publish("parts", dictionary_bytes(1))
    client.put("/v1/aliases/default", json={"model": "parts@1"})
    Leadership(services.database, DISPATCHER, "d-1", 60).lead()
    attempt = services.attempts.start(job_id, "w", 30).attempt
    machine = Machine("m-1", lambda: MachineMemory(4000, 3000))
    needs, rules = MemoryNeeds(services.database), AdmissionRules(4096, 60.0)
    Admission(services.database, needs, "w", machine, rules).reserve(300, lease_s=600.0)
    result = JobResult(format="ply", holes=HoleCounts(found=1), files=[], peak_memory_mb=300)
    services.attempts.publish(attempt, result, StageSeconds("smooth", {"fill": 2.5}))
    found: Families = {}
    for family in text_string_to_metric_families(client.get("/metrics").text):
        for sample in family.samples:
            found.setdefault(sample.name, set()).update(sample.labels)
    return found


def queries() -> Iterator[tuple[str, str]]:
    for panel in DASHBOARD["panels"]:
        for target in panel["targets"]:
            yield panel["title"], target["expr"]
    for rule in RULES:
        yield rule["alert"], rule["expr"]
    for document in yaml.safe_load_all((ROOT / "deploy/kubernetes/autoscaling.yaml").read_text("utf-8")):
        for trigger in document["spec"]["triggers"]:
            yield document["kind"], trigger["metadata"]["query"]


def test_queries_ask_only_for_what_there_is(samples: Families) -> None:
    for title, query in queries():
        asked = _SELECTOR.findall(query)
        assert asked, title
        for name, conditions in asked:
            assert name in samples, (title, name)
            assert set(_CONDITION.findall(conditions)) <= samples[name] | FOREIGN_LABELS, (title, name)
        known = set().union(*(samples[name] for name, _ in asked))
        for labels in _GROUPING.findall(query):
            assert set(labels.split(", ")) <= known, title
        assert query.count("(") == query.count(")"), title


def test_legends_name_labels_that_queries_keep(samples: Families) -> None:
    for panel in DASHBOARD["panels"]:
        for target in panel["targets"]:
            grouped = {label for labels in _GROUPING.findall(target["expr"]) for label in labels.split(", ")}
            wanted = set(_LEGEND.findall(target["legendFormat"]))
            assert wanted <= grouped or (wanted <= FOREIGN_LABELS and not grouped), panel["title"]


def test_figures_of_the_database_are_never_added_up_over_processes(samples: Families) -> None:
    """Every API process reads the same ones: a sum over two of them would say twice what is there."""
    of_one_process = ("quadpatch_http_", "quadpatch_disk_", "quadpatch_build_", "process_")
    of_the_database = [
        (title, query, name)
        for title, query in queries()
        for name, _ in _SELECTOR.findall(query)
        if not name.startswith(of_one_process)
    ]
    assert of_the_database
    for title, query, name in of_the_database:
        assert "max" in query or "delta" in query, title
        assert not re.search(rf"(sum|count)( by \([^)]*\))? \(?(rate\()?{name}", query), title


def test_panels_stand_beside_each_other() -> None:
    taken: set[tuple[int, int]] = set()
    for panel in DASHBOARD["panels"]:
        x, y, w, h = (panel["gridPos"][side] for side in "xywh")
        cells = {(column, row) for column in range(x, x + w) for row in range(y, y + h)}
        assert x + w <= 24
        assert not cells & taken, panel["title"]
        taken |= cells
    assert len({panel["id"] for panel in DASHBOARD["panels"]}) == len(DASHBOARD["panels"])


def test_every_alert_says_how_bad_it_is_and_what_to_do() -> None:
    assert len({rule["alert"] for rule in RULES}) == len(RULES)
    for rule in RULES:
        assert rule["labels"]["severity"] in ("critical", "warning")
        assert rule["annotations"].keys() == {"summary", "action"}


def test_the_runbook_has_a_section_for_every_alert() -> None:
    runbook = (ROOT / "docs/operations/runbook.md").read_text("utf-8")
    rows = re.findall(r"^\| (`Quadpatch[^|]+)\|", runbook, re.MULTILINE)
    assert {name for row in rows for name in re.findall(r"`(\w+)`", row)} == {rule["alert"] for rule in RULES}


def test_every_figure_is_explained_under_its_name(samples: Families, client: TestClient) -> None:
    document = (ROOT / "docs/operations/configure.md").read_text("utf-8")
    families = {f.name: f.type for f in text_string_to_metric_families(client.get("/metrics").text)}
    named = {name + ("_total" if kind == "counter" else "") for name, kind in families.items()}
    ours = {name for name in named if name.startswith("quadpatch") and not name.endswith("_created")}
    rows = re.findall(r"^\| (`quadpatch_[^|]+)\|", document, re.MULTILINE)
    assert {name for row in rows for name in re.findall(r"`(\w+)`", row)} == ours


def test_names_say_their_unit(samples: Families) -> None:
    for name in samples:
        assert not re.search(r"_(s|ms|mb|kb|percent)$", name), name
        assert not re.search(r"(age|duration|time|free|size)$", name), name
