"""Letter F: each role gets the secrets that its code reads and no others, however it is deployed."""

import ast
import inspect
import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from pydantic import SecretStr

from jobkit import settings as settings_module
from jobkit.settings import PREFIX, Settings
from onebox.local_stack import LocalStack, programs
from tests.attacks.manifests import APPLIED, WORKLOADS, Manifest

ROOT = Path(__file__).resolve().parents[2]
# Role by the folder of its code, and its name in the manifests and in a local stack.
ROLES = {"service": "quadpatch-api", "dispatcher": "quadpatch-dispatcher", "worker": "quadpatch-worker"}
COMPOSE: dict[str, Any] = yaml.safe_load((ROOT / "docker-compose.yml").read_text("utf-8"))["services"]
IN_COMPOSE = {"service": "api", "dispatcher": "dispatcher", "worker": "worker"}
SECRETS: dict[str, Manifest] = {m["metadata"]["name"]: m["stringData"] for m in APPLIED if m["kind"] == "Secret"}
# A value that has to be filled in, and has no default.
FILLED_IN = re.compile(r"\$\{\w+:\?")


def attributes_of_settings(tree: ast.AST, owner: str) -> set[str]:
    """Names that are read from something called `owner`, also where it is an attribute itself."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            of = node.value
            name = of.id if isinstance(of, ast.Name) else of.attr if isinstance(of, ast.Attribute) else ""
            found |= {node.attr} if name.endswith(owner) else set()
    return found


def fields_behind(attribute: str) -> set[str]:
    """The settings that an attribute of them stands for: itself, or what a property reads."""
    if attribute in Settings.model_fields:
        return {attribute}
    tree = ast.parse(inspect.getsource(settings_module))
    bodies = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name == attribute]
    return {name for body in bodies for read in attributes_of_settings(body, "self") for name in fields_behind(read)}


def read_by(role: str) -> tuple[set[str], set[str]]:
    """Variables of the settings that the code of a role reads, and the functions that it calls by name."""
    trees = [ast.parse(path.read_text("utf-8")) for path in (ROOT / role).rglob("*.py")]
    attributes = {name for tree in trees for name in attributes_of_settings(tree, "settings")}
    fields = {field for attribute in attributes for field in fields_behind(attribute)}
    nodes = (node for tree in trees for node in ast.walk(tree))
    calls = {node.func.id for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    return {PREFIX + field.upper() for field in fields}, calls


def needed(role: str, secrets: set[str]) -> set[str]:
    """Those of the secrets that the code of a role has a use for."""
    variables, calls = read_by(role)
    # The S3 client reads these itself.
    of_store = {name for name in secrets if name.startswith("AWS_") and "open_store" in calls}
    return secrets & variables | of_store


def handed_over(workload: str) -> set[str]:
    """Names of the secrets in the environment of a pod."""
    (container,) = WORKLOADS[workload]["spec"]["template"]["spec"]["containers"]
    sources = [source["secretRef"]["name"] for source in container.get("envFrom", []) if "secretRef" in source]
    single = {v["name"] for v in container.get("env", []) if "secretKeyRef" in v.get("valueFrom", {})}
    return single | {name for source in sources for name in SECRETS[source]}


SECRET_SETTINGS = {
    PREFIX + name.upper() for name, field in Settings.model_fields.items() if field.annotation is SecretStr
}


def test_the_code_that_is_read_uses_what_it_is_known_to_use() -> None:
    assert SECRET_SETTINGS - read_by("service")[0] == set()
    for role in ("dispatcher", "worker"):
        assert SECRET_SETTINGS - read_by(role)[0] == {"QUADPATCH_API_KEYS"}


@pytest.mark.parametrize("role", ROLES)
def test_a_pod_gets_the_secrets_that_its_code_reads_and_no_others(role: str) -> None:
    everything = {name for data in SECRETS.values() for name in data}
    assert handed_over(ROLES[role]) == needed(role, everything)
    assert SECRET_SETTINGS & everything == SECRET_SETTINGS


def test_the_queue_gets_its_password_alone() -> None:
    assert handed_over("valkey") == {"VALKEY_PASSWORD"}
    assert [name for name, value in COMPOSE["valkey"]["environment"].items() if FILLED_IN.search(value)] == [
        "VALKEY_PASSWORD"
    ]


def test_no_pod_has_secrets_in_files_or_a_token_of_the_cluster() -> None:
    for workload in WORKLOADS.values():
        spec = workload["spec"]["template"]["spec"]
        assert spec["automountServiceAccountToken"] is False
        assert all("secret" not in volume and "projected" not in volume for volume in spec.get("volumes", []))


@pytest.mark.parametrize("role", ROLES)
def test_a_container_of_compose_gets_the_secrets_that_its_code_reads_and_no_others(role: str) -> None:
    by_service = {
        name: {variable for variable, value in service["environment"].items() if FILLED_IN.search(str(value))}
        for name, service in COMPOSE.items()
    }
    everything = {variable for name in IN_COMPOSE.values() for variable in by_service[name]}
    assert {"QUADPATCH_API_KEYS", "QUADPATCH_REDIS_URL"} <= everything
    assert by_service[IN_COMPOSE[role]] == needed(role, everything)
    assert all("env_file" not in service and "secrets" not in service for service in COMPOSE.values())


@pytest.mark.parametrize(
    ("role", "program"), [("dispatcher", "dispatcher"), ("worker", "worker-1"), ("service", "api")]
)
def test_a_process_of_a_local_stack_gets_no_secret_that_its_code_does_not_read(
    tmp_path: Path, role: str, program: str
) -> None:
    (found,) = (p for p in programs(LocalStack(tmp_path, "127.0.0.1", 8000, 1)) if p.name == program)
    passed = {name for name in SECRET_SETTINGS if not name.startswith(found.withheld or ("-",))}
    assert passed == needed(role, SECRET_SETTINGS)
