"""The Kubernetes manifests as a cluster reads them: the environment of a pod, and whom its policies let it reach."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

FOLDER = Path(__file__).resolve().parents[2] / "deploy/kubernetes"
Manifest = dict[str, Any]
NAME = "app.kubernetes.io/name"


def documents(*names: str) -> Iterator[Manifest]:
    for name in names:
        yield from (document for document in yaml.safe_load_all((FOLDER / name).read_text("utf-8")) if document)


KUSTOMIZATION = next(documents("kustomization.yaml"))
# As an operator applies them: the examples are filled in and applied beside the rest.
APPLIED = [*documents(*KUSTOMIZATION["resources"], "secrets.example.yaml", "addresses.example.yaml")]
WORKLOADS = {m["metadata"]["name"]: m for m in APPLIED if m["kind"] in ("Deployment", "StatefulSet")}


def named(kind: str, name: str) -> Manifest:
    return next(m for m in APPLIED if m["kind"] == kind and m["metadata"]["name"] == name)


def pod_environment(workload: str) -> dict[str, str]:
    """The environment that kubelet gives the container of a pod."""
    spec = WORKLOADS[workload]["spec"]["template"]["spec"]
    (container,) = spec["containers"]
    api_server = {"metadata": {"name": "kubernetes"}, "spec": {"ports": [{"name": "https", "port": 443}]}}
    services = [api_server]
    if spec.get("enableServiceLinks", True):
        services += [m for m in APPLIED if m["kind"] == "Service"]
    found: dict[str, str] = {}
    for service in services:
        found |= service_links(service)
    for source in container.get("envFrom", []):
        if "configMapRef" in source:
            found |= named("ConfigMap", source["configMapRef"]["name"])["data"]
        else:
            found |= named("Secret", source["secretRef"]["name"])["stringData"]
    for variable in container.get("env", []):
        if "value" in variable:
            found[variable["name"]] = variable["value"]
        else:
            reference = variable["valueFrom"]["secretKeyRef"]
            found[variable["name"]] = named("Secret", reference["name"])["stringData"][reference["key"]]
    return found


def service_links(service: Manifest) -> dict[str, str]:
    """The variables of one Service; one without an address of its own has none."""
    if service["spec"].get("clusterIP") == "None":
        return {}
    prefix = service["metadata"]["name"].upper().replace("-", "_")
    address, ports = "10.96.0.10", service["spec"]["ports"]
    found = {f"{prefix}_SERVICE_HOST": address, f"{prefix}_SERVICE_PORT": str(ports[0]["port"])}
    found[f"{prefix}_PORT"] = f"tcp://{address}:{ports[0]['port']}"
    for port in ports:
        number = port["port"]
        of_port = f"{prefix}_PORT_{number}_TCP"
        found |= {of_port: f"tcp://{address}:{number}", f"{of_port}_PROTO": "tcp"}
        found |= {f"{of_port}_PORT": str(number), f"{of_port}_ADDR": address}
        if "name" in port:
            found[f"{prefix}_SERVICE_PORT_{port['name'].upper().replace('-', '_')}"] = str(number)
    return found


def policies_of(workload: str, direction: str) -> list[Manifest]:
    """The network policies that bear on the pods of a workload in a direction, `Ingress` or `Egress`."""
    labels = WORKLOADS[workload]["spec"]["template"]["metadata"]["labels"]
    policies = [m["spec"] for m in APPLIED if m["kind"] == "NetworkPolicy"]
    return [p for p in policies if direction in p["policyTypes"] and selects(p["podSelector"], labels)]


def selects(selector: Manifest, labels: dict[str, str]) -> bool:
    """Tell whether a label selector fits; one without conditions fits everything."""
    of_lists = [
        e["operator"] == "In" and labels.get(e["key"]) in e["values"] for e in selector.get("matchExpressions", [])
    ]
    return selector.get("matchLabels", {}).items() <= labels.items() and all(of_lists)


def ways(workload: str, direction: str) -> list[tuple[str, int]]:
    """What a pod may reach, or be reached from: peers and ports as text, `anywhere` for a rule without peers."""
    side = {"Ingress": "from", "Egress": "to"}[direction]
    found = []
    for policy in policies_of(workload, direction):
        for rule in policy.get(direction.lower(), []):
            peers = [peer for entry in rule.get(side, []) for peer in peer_names(entry)] or ["anywhere"]
            ports = [port["port"] for port in rule.get("ports", [])] or [0]
            found += [(peer, port) for peer in peers for port in ports]
    return sorted(set(found))


def peer_names(peer: Manifest) -> list[str]:
    if "ipBlock" in peer:
        return [peer["ipBlock"]["cidr"]]
    if "namespaceSelector" in peer:
        return [f"namespace {name}" for name in _values(peer["namespaceSelector"], "kubernetes.io/metadata.name")]
    return _values(peer["podSelector"], NAME)


def _values(selector: Manifest, key: str) -> list[str]:
    chosen = [e["values"] for e in selector.get("matchExpressions", []) if e["key"] == key]
    label = selector.get("matchLabels", {}).get(key)
    return [*(chosen[0] if chosen else []), *([label] if label else [])] or ["anywhere"]
