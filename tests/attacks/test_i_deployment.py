"""Pods start with the environment that a cluster gives them, and reach what they need and nothing else."""

import subprocess
import sys
from ipaddress import ip_address, ip_network

import pytest

from jobkit.errors import SettingsError
from jobkit.settings import refuse_unknown_names
from tests.attacks.manifests import APPLIED, WORKLOADS, pod_environment, policies_of, service_links, ways
from tests.waiting import GUARD_S

OURS = ("quadpatch-api", "quadpatch-dispatcher", "quadpatch-worker")
DATABASE, STORE = ("192.0.2.10/32", 5432), ("198.51.100.0/24", 443)
QUEUE, NAMES = ("valkey", 6379), ("namespace kube-system", 53)
METADATA_SERVICE = ip_address("169.254.169.254")


@pytest.mark.parametrize("workload", OURS)
def test_a_pod_loads_its_settings_from_the_environment_that_kubelet_gives_it(workload: str) -> None:
    code = "from jobkit.settings import load_settings; print(load_settings().port)"
    environment = pod_environment(workload)
    assert "KUBERNETES_SERVICE_HOST" in environment
    loaded = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=GUARD_S, check=False
    )
    assert (loaded.stdout, loaded.returncode) == ("8000\n", 0), loaded.stderr


def test_the_links_of_the_service_would_stop_every_start() -> None:
    (service,) = [m for m in APPLIED if m["kind"] == "Service" and m["metadata"]["name"] == "quadpatch"]
    links = service_links(service)
    assert links["QUADPATCH_PORT"] == "tcp://10.96.0.10:80"
    with pytest.raises(SettingsError):
        refuse_unknown_names(links)


@pytest.mark.parametrize("workload", WORKLOADS)
def test_no_pod_gets_the_links_of_services(workload: str) -> None:
    assert WORKLOADS[workload]["spec"]["template"]["spec"]["enableServiceLinks"] is False


@pytest.mark.parametrize("workload", WORKLOADS)
@pytest.mark.parametrize("direction", ["Ingress", "Egress"])
def test_every_pod_is_cut_off_unless_a_rule_lets_it_through(workload: str, direction: str) -> None:
    assert any(policy["podSelector"] == {} for policy in policies_of(workload, direction))
    for peer, port in ways(workload, direction):
        assert peer != "anywhere"
        assert port != 0


def test_a_worker_reaches_queue_database_store_and_names_alone() -> None:
    assert ways("quadpatch-worker", "Egress") == sorted([DATABASE, STORE, QUEUE, NAMES])
    assert ways("quadpatch-worker", "Ingress") == []


def test_the_other_roles_reach_no_more_than_their_work_needs() -> None:
    inside = {DATABASE, STORE, QUEUE, NAMES}
    assert set(ways("quadpatch-api", "Egress")) == inside
    assert {port for _, port in set(ways("quadpatch-dispatcher", "Egress")) - inside} == {443}
    assert ways("quadpatch-dispatcher", "Ingress") == []
    assert [port for _, port in ways("quadpatch-api", "Ingress")] == [8000, 8000]
    assert ways("valkey", "Egress") == []
    assert ways("valkey", "Ingress") == [(name, 6379) for name in OURS]


def test_webhooks_leave_private_networks_and_metadata_services_alone() -> None:
    blocks = [
        peer["ipBlock"]
        for policy in policies_of("quadpatch-dispatcher", "Egress")
        for rule in policy.get("egress", [])
        for peer in rule["to"]
        if "ipBlock" in peer and "except" in peer["ipBlock"]
    ]
    assert {block["cidr"] for block in blocks} == {"0.0.0.0/0", "::/0"}
    left_out = [ip_network(network) for block in blocks for network in block["except"]]
    for address in (METADATA_SERVICE, ip_address("10.96.0.1"), ip_address("fd00:ec2::254")):
        assert any(address in network for network in left_out)
