"""Every network that ships, from upload to repaired mesh."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.formats.reading import read_scan
from quadpatch.inpainters.model_file import SHIPPED_MODELS
from quadpatch_client.schema import JobSpec, JobState
from quadpatch_client.sdk import Client
from tests.waiting import GUARD_S

NETWORKS = sorted(path.stem for path in SHIPPED_MODELS.glob("*.onnx"))


def run(client: Client, source: Path, method: dict[str, str]) -> Any:
    spec = {"mesh_id": client.upload(source).id, "output": {"preview": False}, "method": method}
    return client.wait(client.create_job(JobSpec.model_validate(spec)).id, timeout_s=GUARD_S)


@pytest.mark.parametrize("name", NETWORKS)
def test_a_shipped_network_repairs_a_scan(
    client: Client, relief_file: Callable[[str], Path], tmp_path: Path, name: str
) -> None:
    source, output = relief_file("float.ply"), tmp_path / "repaired.ply"
    job = run(client, source, {"method": "cnn", "model": name})
    assert job.state in (JobState.SUCCEEDED, JobState.SUCCEEDED_WITH_WARNINGS)
    assert (job.model.kind, f"{job.model.name}@{job.model.version}") == ("autoencoder", name)
    client.download(job, "result", output)
    client.download(job, "report", tmp_path / "report.json")
    before, after = read_scan(source), read_scan(output)
    assert np.array_equal(after.vertices[: len(before.vertices)], before.vertices)
    assert len(after.triangles) > len(before.triangles)
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["counts"]["filled"] + report["counts"]["filled_smooth"] == 4
    # The network was asked, whether or not it was believed afterwards.
    assert "inpaint" in [stage["name"] for stage in report["stages"]]


def test_a_job_that_names_no_network_gets_one_that_ships(client: Client, relief_file: Callable[[str], Path]) -> None:
    job = run(client, relief_file("float.ply"), {"method": "cnn"})
    assert job.model.requested == "default-network"
    assert f"{job.model.name}@{job.model.version}" in NETWORKS
    assert job.state in (JobState.SUCCEEDED, JobState.SUCCEEDED_WITH_WARNINGS)
