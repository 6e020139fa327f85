"""A network that is fitted to the uploaded mesh, from upload to repaired mesh."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from typer.testing import CliRunner

from quadpatch.formats.reading import read_scan
from quadpatch.model_choice import BASE_NETWORK
from quadpatch_client.cli import app
from quadpatch_client.errors import RefusedError
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.schema import Job, JobSpec, JobState
from quadpatch_client.sdk import Client
from tests.quadpatch.shapes import punched, relief, write_ply
from tests.waiting import GUARD_S

FITTED = {"method": "cnn", "model": "self", "fitting": {"steps": 12, "seconds": 500.0}, "patches": {"overlap": 0}}


def spec(mesh_id: str, method: dict[str, Any]) -> JobSpec:
    return JobSpec.model_validate({"mesh_id": mesh_id, "output": {"preview": False}, "method": method})


def percents(url: str, job: Job) -> list[float]:
    """Return every percentage in the log of a job, oldest first."""
    log = httpx.get(f"{url}/v1/jobs/{job.id}/events?limit=1000", timeout=GUARD_S).raise_for_status().json()
    return [event["data"]["percent"] for event in log["items"] if event["type"] == "progress"]


@pytest.mark.slow
def test_the_client_says_how_long_to_fit_a_network_to_the_mesh_and_the_job_how_far_it_is(
    local_stack: Any, tmp_path: Path
) -> None:
    # Nothing is fitted where the scan has no room for calibration holes.
    scan = punched(relief(128, 3.6, 0.04, 14), (-0.6, -0.65, 0), (0.35, 0.4, 0), radius=0.13)
    source, output, told = write_ply(tmp_path / "scan.ply", scan), tmp_path / "repaired.ply", tmp_path / "report.json"
    flags = ["--method", "cnn", "--model", "self", "--fit-steps", "12", "--fit-seconds", "500", "--overlap", "0"]
    arguments = ["repair", str(source), "-o", str(output), "--report", str(told), "--json", "--quiet", *flags]
    done = CliRunner().invoke(app, arguments, env={"QUADPATCH_CLIENT_URL": local_stack.url})
    assert done.exit_code == ExitCode.OK, done.stderr
    job = Job.model_validate_json(done.stdout)
    assert json.loads(done.stdout)["spec"]["method"]["fitting"] == FITTED["fitting"]
    assert job.state == JobState.SUCCEEDED, job.error
    assert (job.model.requested, job.model.kind) == ("self", "self_network")
    # How many there are depends on the machine's speed: the worker writes twice a second at most.
    told_percents = percents(local_stack.url, job)
    assert told_percents
    assert told_percents == sorted(told_percents)

    before, after = read_scan(source), read_scan(output)
    assert np.array_equal(after.vertices[: len(before.vertices)], before.vertices)
    assert np.array_equal(after.triangles[: len(before.triangles)], before.triangles)
    report = json.loads(told.read_text())
    assert report["counts"]["filled"] + report["counts"]["filled_smooth"] == 2
    assert report["model"]["name"] == "self-network"
    assert report["model"]["fitted_from"].startswith(BASE_NETWORK)
    assert report["options"]["network"] == FITTED["fitting"]
    assert report["model"]["fitting"]["steps_asked"] == 12
    assert report["model"]["fitting"]["steps"] > 0


def test_a_job_that_may_take_no_time_to_fit_ends_all_the_same(
    client: Client, relief_file: Callable[[str], Path]
) -> None:
    hurried = {**FITTED, "fitting": {"steps": 100_000, "seconds": 0.01}}
    job = client.create_job(spec(client.upload(relief_file("float.ply")).id, hurried))
    assert client.wait(job.id, timeout_s=GUARD_S).state == JobState.SUCCEEDED


def test_a_network_that_is_taken_as_it_is_can_not_be_told_how_long_to_be_fitted(
    client: Client, relief_file: Callable[[str], Path]
) -> None:
    method = {"method": "cnn", "model": BASE_NETWORK, "fitting": {"steps": 12}}
    with pytest.raises(RefusedError, match="is taken as it is; fitting goes with the model self only") as caught:
        client.create_job(spec(client.upload(relief_file("float.ply")).id, method))
    assert caught.value.problem.code == "model_kind_mismatch"
