"""Jobs that name a rule, against a local stack: what meets it, what does not, and what fails by it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx

from quadpatch_client.sdk import Client
from tests.integration.conftest import RunningStack
from tests.waiting import GUARD_S, wait_until


def test_a_rule_is_met_warned_of_or_failed_by(
    local_stack: RunningStack, client: Client, relief_file: Callable[[str], Path]
) -> None:
    mesh = client.wait_for_mesh(client.upload(relief_file("float.ply")).id, timeout_s=GUARD_S)
    with httpx.Client(base_url=local_stack.url, timeout=GUARD_S) as http:

        def ended(acceptance: dict[str, Any]) -> Any:
            content = {"method": {"method": "smooth"}, "acceptance": acceptance}
            rule = http.put("/v1/rules/reliefs", json=content).raise_for_status().json()
            planned = http.post("/v1/rules/reliefs/dry-run", json={"mesh_id": mesh.id}).raise_for_status().json()
            job = http.post("/v1/jobs", json={"mesh_id": mesh.id, "rule": "reliefs"}).raise_for_status().json()
            assert job["spec"]["rule"] == f"reliefs@{rule['version']}" == planned["rule"]
            chosen = [hole["id"] for hole in planned["plan"]["holes"] if hole["selected"]]
            wait_until(lambda: client.job(job["id"]).state.is_terminal)
            return client.job(job["id"]), chosen

        met, chosen = ended({"max_expected_error": 1e6})
        assert met.state == "succeeded"
        assert (met.result.acceptance.is_met, met.result.acceptance.holes) == (True, len(chosen))
        warned, chosen = ended({"max_expected_error": 1e-9})
        assert warned.state == "succeeded_with_warnings"
        assert [hole.id for hole in warned.result.acceptance.unmet] == sorted(chosen)
        sentence = f"{len(chosen)} of {len(chosen)} chosen holes miss the limits of {warned.spec.rule}: "
        assert any(text.startswith(sentence) for text in warned.result.warnings)
        failed, _ = ended({"max_expected_error": 1e-9, "otherwise": "fail"})
        assert (failed.state, failed.error.code, failed.result) == ("failed", "acceptance_not_met", None)
        assert failed.attempt == 1
