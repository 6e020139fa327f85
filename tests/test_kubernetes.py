"""The Kubernetes manifests, held to the code and to each other; no cluster is at hand."""

import importlib.util
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from jobkit.readiness import READY_FILE_VARIABLE
from jobkit.settings import PREFIX, Settings, refuse_unknown_names
from worker.engine.limits import _DATA_SLACK_MB

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "deploy/kubernetes"
Manifest = dict[str, Any]
# Names that others read: S3 clients, numerical libraries.
FOREIGN_NAMES = re.compile(r"AWS_\w+|OMP_NUM_THREADS|OPENBLAS_NUM_THREADS|VALKEY_PASSWORD|READY_FILE")


def manifests(name: str) -> list[Manifest]:
    return [document for document in yaml.safe_load_all((FOLDER / name).read_text("utf-8")) if document]


KUSTOMIZATION = manifests("kustomization.yaml")[0]
ALL = [manifest for name in KUSTOMIZATION["resources"] for manifest in manifests(name)]
SECRETS = {secret["metadata"]["name"]: secret["stringData"] for secret in manifests("secrets.example.yaml")}
SETTINGS: dict[str, str] = next(m["data"] for m in ALL if m["kind"] == "ConfigMap")
WORKLOADS = {m["metadata"]["name"]: m for m in ALL if m["kind"] in ("Deployment", "StatefulSet")}
OURS = ("quadpatch-api", "quadpatch-dispatcher", "quadpatch-worker")


def pod(name: str) -> Manifest:
    spec: Manifest = WORKLOADS[name]["spec"]["template"]["spec"]
    return spec


def container(name: str) -> Manifest:
    (only,) = pod(name)["containers"]
    return dict(only)


def selectors(kind: str) -> Iterator[tuple[str, Manifest]]:
    for manifest in ALL:
        if manifest["kind"] == kind:
            selector = manifest["spec"]["selector"]
            yield manifest["metadata"]["name"], selector.get("matchLabels", selector)


def mebibytes(text: str) -> int:
    number, unit = re.fullmatch(r"(\d+)(Mi|Gi)", text).groups()  # type: ignore[union-attr]
    return int(number) * {"Mi": 1, "Gi": 1024}[unit]


def test_every_file_is_listed_or_is_the_example() -> None:
    listed = {*KUSTOMIZATION["resources"], "kustomization.yaml", "secrets.example.yaml", "addresses.example.yaml"}
    assert {path.name for path in FOLDER.iterdir()} == listed


def test_no_secret_is_applied_with_the_rest() -> None:
    assert all(manifest["kind"] != "Secret" for manifest in ALL)


def test_the_image_is_that_of_this_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert [image["newTag"] for image in KUSTOMIZATION["images"] if image["name"] == "quadpatch"] == [
        project["version"]
    ]
    assert {container(name)["image"] for name in OURS} == {"quadpatch"}


@pytest.mark.parametrize("name", OURS)
def test_containers_run_modules_that_exist(name: str) -> None:
    python, flag, module = container(name)["command"]
    assert (python, flag) == ("python", "-m")
    assert importlib.util.find_spec(f"{module}.__main__") is not None


def test_settings_and_secrets_are_those_of_the_code() -> None:
    secrets = {**SECRETS["quadpatch-secrets"], **SECRETS["quadpatch-api-keys"]}
    together = {**SETTINGS, **secrets}
    refuse_unknown_names(together)
    ours = {name.removeprefix(PREFIX).lower(): value for name, value in together.items() if name.startswith(PREFIX)}
    settings = Settings.model_validate(ours)
    assert len(settings.key_list) == 2
    assert settings.effective_database_url.startswith("postgresql+psycopg://")
    assert settings.effective_object_store_url.startswith("s3://")
    assert all(name.startswith(PREFIX) or FOREIGN_NAMES.fullmatch(name) for name in together)
    assert not set(SETTINGS) & set(secrets)


def test_the_secrets_agree_with_each_other() -> None:
    keys = SECRETS["quadpatch-api-keys"]["QUADPATCH_API_KEYS"].split(",")
    assert SECRETS["quadpatch-metrics"]["key"] in keys
    assert f":{SECRETS['valkey']['password']}@valkey:6379" in SECRETS["quadpatch-secrets"]["QUADPATCH_REDIS_URL"]


@pytest.mark.parametrize("name", WORKLOADS)
def test_what_a_container_reads_exists(name: str) -> None:
    maps = {m["metadata"]["name"] for m in ALL if m["kind"] == "ConfigMap"}
    for source in container(name).get("envFrom", []):
        assert source.get("configMapRef", {"name": "quadpatch-settings"})["name"] in maps
        assert source.get("secretRef", {"name": "quadpatch-secrets"})["name"] in SECRETS
    for variable in container(name).get("env", []):
        assert FOREIGN_NAMES.fullmatch(variable["name"])
        if "valueFrom" in variable:
            reference = variable["valueFrom"]["secretKeyRef"]
            assert reference["key"] in SECRETS[reference["name"]]


@pytest.mark.parametrize("name", WORKLOADS)
def test_pods_are_confined_and_say_how_they_are(name: str) -> None:
    spec, only = pod(name), container(name)
    assert spec["securityContext"]["runAsNonRoot"]
    assert spec["securityContext"]["seccompProfile"] == {"type": "RuntimeDefault"}
    assert spec["automountServiceAccountToken"] is False
    assert spec["enableServiceLinks"] is False
    assert spec["terminationGracePeriodSeconds"] >= 30
    assert only["securityContext"] == {
        "allowPrivilegeEscalation": False,
        "readOnlyRootFilesystem": True,
        "capabilities": {"drop": ["ALL"]},
    }
    assert only["livenessProbe"]
    assert {"cpu", "memory"} <= only["resources"]["requests"].keys()
    assert only["resources"]["limits"]["memory"]
    volumes = {volume["name"] for volume in spec.get("volumes", [])}
    volumes |= {claim["metadata"]["name"] for claim in WORKLOADS[name]["spec"].get("volumeClaimTemplates", [])}
    assert {mount["name"] for mount in only["volumeMounts"]} == volumes


@pytest.mark.parametrize("name", OURS)
def test_our_pods_run_as_the_user_of_the_image_and_write_where_they_may(name: str) -> None:
    dockerfile = (ROOT / "Dockerfile").read_text("utf-8")
    user = pod(name)["securityContext"]["runAsUser"]
    assert f"useradd --uid {user} " in dockerfile
    mounted = {mount["mountPath"] for mount in container(name)["volumeMounts"]}
    assert mounted == {SETTINGS["QUADPATCH_DATA_DIR"], "/tmp"}


@pytest.mark.parametrize("name", ["quadpatch-dispatcher", "quadpatch-worker"])
def test_probes_ask_for_the_ready_file(name: str) -> None:
    variables = {variable["name"]: variable.get("value") for variable in container(name)["env"]}
    for probe in ("startupProbe", "livenessProbe"):
        assert container(name)[probe]["exec"]["command"] == [
            "sh",
            "-c",
            f'kill -0 "$(cat {variables[READY_FILE_VARIABLE]})"',
        ]


def test_the_api_is_asked_for_paths_that_need_no_key_on_its_port() -> None:
    only = container("quadpatch-api")
    assert only["ports"] == [{"name": "http", "containerPort": int(SETTINGS["QUADPATCH_PORT"])}]
    asked = {probe: only[probe]["httpGet"] for probe in ("startupProbe", "livenessProbe", "readinessProbe")}
    assert {get["port"] for get in asked.values()} == {"http"}
    # A database that is away must not restart the API.
    assert [get["path"] for get in asked.values()] == ["/healthz", "/healthz", "/readyz"]


def test_a_worker_has_room_for_the_largest_repair_it_allows() -> None:
    of_its_own = 512
    needed = int(SETTINGS["QUADPATCH_JOB_MEMORY_LIMIT_MB"]) + _DATA_SLACK_MB + of_its_own
    assert mebibytes(container("quadpatch-worker")["resources"]["limits"]["memory"]) >= needed


def test_selectors_find_pods() -> None:
    labels = [m["spec"]["template"]["metadata"]["labels"] for m in WORKLOADS.values()]
    for kind in ("Service", "Deployment", "StatefulSet", "PodDisruptionBudget"):
        found = list(selectors(kind))
        assert found, kind
        for name, selector in found:
            assert any(selector.items() <= label.items() for label in labels), (kind, name)
    services = [m["metadata"]["labels"] for m in ALL if m["kind"] == "Service" and "labels" in m["metadata"]]
    for name, selector in selectors("ServiceMonitor"):
        assert any(selector.items() <= label.items() for label in services), name


def test_no_disruption_takes_everything_of_a_kind() -> None:
    guarded = {next(iter(selector.values())) for _, selector in selectors("PodDisruptionBudget")}
    assert guarded == set(OURS)
    assert WORKLOADS["quadpatch-api"]["spec"]["replicas"] >= 2
    assert WORKLOADS["quadpatch-dispatcher"]["spec"]["replicas"] >= 2


def test_the_autoscaler_alone_decides_how_many_workers_run() -> None:
    (scaled,) = [manifest for manifest in ALL if manifest["kind"] == "ScaledObject"]
    assert scaled["spec"]["scaleTargetRef"]["name"] == "quadpatch-worker"
    assert "replicas" not in WORKLOADS["quadpatch-worker"]["spec"]
    assert 2 <= scaled["spec"]["minReplicaCount"] <= scaled["spec"]["fallback"]["replicas"]
    assert scaled["spec"]["fallback"]["replicas"] <= scaled["spec"]["maxReplicaCount"]


def test_the_queue_is_set_up_as_in_the_compose_file() -> None:
    compose = yaml.safe_load((ROOT / "docker-compose.yml").read_text("utf-8"))["services"]["valkey"]
    ours = container("valkey")
    (image,) = [image for image in KUSTOMIZATION["images"] if image["name"] == ours["image"].split(":")[0]]
    assert f"{image['name']}:{image['newTag']}" == ours["image"]
    assert compose["image"] == f"${{VALKEY_IMAGE:-{ours['image']}}}"
    lines = ours["command"][2].splitlines()
    assert "dir /data" in lines
    assert [line for line in lines if line != "dir /data"] == compose["command"][2].replace("$$", "$").splitlines()


def test_the_metrics_are_scraped_with_a_key() -> None:
    (monitor,) = [manifest for manifest in ALL if manifest["kind"] == "ServiceMonitor"]
    (endpoint,) = monitor["spec"]["endpoints"]
    assert endpoint["path"] == "/metrics"
    credentials = endpoint["authorization"]["credentials"]
    assert credentials["key"] in SECRETS[credentials["name"]]
    service = next(m for m in ALL if m["kind"] == "Service" and m["metadata"]["name"] == "quadpatch")
    assert endpoint["port"] in {port["name"] for port in service["spec"]["ports"]}
