"""A tenant's STL, from the key to the repaired mesh: on a real stack, by a worker, with default options."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import httpx
import pytest

from quadpatch.formats.reading import read_scan
from quadpatch_client.errors import RefusedError
from quadpatch_client.schema import JobSpec, JobState
from quadpatch_client.sdk import Client
from tests.integration.conftest import RunningStack, punched_relief, stl_bytes
from tests.waiting import GUARD_S

OPERATOR_KEY = "the-key-of-the-operator"


def test_a_station_of_a_tenant_gets_its_stl_repaired_and_another_tenant_sees_none_of_it(
    run_stack: Callable[..., AbstractContextManager[RunningStack]], tmp_path: Path
) -> None:
    source, output = tmp_path / "scan.stl", tmp_path / "repaired.stl"
    source.write_bytes(stl_bytes(*punched_relief(40)))
    with run_stack(QUADPATCH_API_KEYS=OPERATOR_KEY) as stack:
        keys = []
        for tenant in ("plant-north", "plant-south"):
            new = {"name": "station 4", "tenant": tenant}
            made = httpx.post(f"{stack.url}/v1/keys", json=new, headers={"X-API-Key": OPERATOR_KEY}, timeout=GUARD_S)
            keys.append(made.raise_for_status().json()["key"])
        with Client(stack.url, keys[0]) as own, Client(stack.url, keys[1]) as foreign:
            mesh = own.upload(source)
            job = own.wait(own.create_job(JobSpec(mesh_id=mesh.id, priority="interactive")).id, timeout_s=GUARD_S)
            assert job.state == JobState.SUCCEEDED, job.error
            own.download(job, "result", output)
            assert list(foreign.jobs()) == []
            with pytest.raises(RefusedError, match="there is no job"):
                foreign.job(job.id)
            # The same bytes are another mesh there, and are analysed and repaired again.
            again = foreign.upload(source)
            repeated = foreign.wait(foreign.create_job(JobSpec(mesh_id=again.id)).id, timeout_s=GUARD_S)
            assert repeated.state == JobState.SUCCEEDED, repeated.error
            assert [found.id for found in foreign.jobs()] == [repeated.id]
    before, after = read_scan(source), read_scan(output)
    assert len(after.triangles) > len(before.triangles)
