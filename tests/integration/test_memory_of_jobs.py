"""Two workers on a machine that has memory for one large job, or for a large one and a small one."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families

from quadpatch_client.errors import JobFailedError
from quadpatch_client.schema import Job, JobSpec, JobState
from quadpatch_client.sdk import Client
from tests.integration.conftest import ply_bytes, punched_relief
from tests.waiting import GUARD_S, wait_until

MACHINE_MB = 500
# An engine takes 296 MiB to encode the large relief and 131 MiB to fill a small one, and 285 and 141 are expected.
LARGE = {"task": "encode", "encode": {"max_error": 0.002}, "output": {"preview": False}}
SMALL = {"method": {"method": "smooth"}, "output": {"preview": False}}


@pytest.fixture(scope="module")
def small_machine(run_stack: Callable[..., AbstractContextManager[Any]]) -> Iterator[Any]:
    with run_stack(QUADPATCH_MACHINE_MEMORY_MB=str(MACHINE_MB)) as stack:
        yield stack


@pytest.fixture
def machine_client(small_machine: Any) -> Iterator[Client]:
    with Client(small_machine.url) as client:
        yield client


@pytest.fixture
def small_relief(tmp_path: Path) -> Path:
    path = tmp_path / "small.ply"
    path.write_bytes(ply_bytes(*punched_relief(40)))
    return path


def make(client: Client, path: Path, options: dict[str, Any]) -> Job:
    mesh = client.wait_for_mesh(client.upload(path).id, timeout_s=GUARD_S)
    return client.create_job(JobSpec.model_validate({"mesh_id": mesh.id, **options}))


def state(client: Client, job: Job) -> JobState:
    return client.job(job.id).state


def start_and_suspend(client: Client, stack: Any, path: Path) -> Job:
    """Start a large job and stop its engine, so that it runs for as long as the test wants."""
    job = make(client, path, LARGE)
    wait_until(lambda: state(client, job) is JobState.RUNNING and stack.engines())
    (engine,) = stack.engines()
    engine.suspend()
    return job


def cancel(client: Client, stack: Any, *jobs: Job) -> None:
    for job in jobs:
        client.cancel(job.id)
    wait_until(lambda: all(state(client, job).is_terminal for job in jobs) and not stack.engines())


def figures(stack: Any) -> dict[str, float]:
    text = httpx.get(f"{stack.url}/metrics", timeout=GUARD_S).text
    return {sample.name: sample.value for f in text_string_to_metric_families(text) for sample in f.samples}


def test_jobs_that_do_not_fit_together_run_one_after_the_other_and_a_small_one_meanwhile(
    machine_client: Client, small_machine: Any, large_relief: Path, small_relief: Path
) -> None:
    first = start_and_suspend(machine_client, small_machine, large_relief)
    second = make(machine_client, large_relief, LARGE)
    wait_until(lambda: machine_client.job(second.id).waits_for == "memory")
    found = figures(small_machine)
    assert found["quadpatch_memory_limit_bytes"] == MACHINE_MB << 20
    assert found["quadpatch_memory_limit_bytes"] / 2 < found["quadpatch_memory_reserved_bytes"] < MACHINE_MB << 20
    assert found["quadpatch_memory_waiting_jobs"] == 1
    small = machine_client.wait(make(machine_client, small_relief, SMALL).id, timeout_s=GUARD_S)
    assert small.result is not None
    assert small.result.peak_memory_mb is not None
    assert 50 < small.result.peak_memory_mb < MACHINE_MB
    assert (state(machine_client, first), state(machine_client, second)) == (JobState.RUNNING, JobState.QUEUED)
    machine_client.cancel(first.id)
    wait_until(lambda: state(machine_client, second) is JobState.RUNNING)
    assert machine_client.job(second.id).attempt == 1
    cancel(machine_client, small_machine, second)


def test_the_memory_of_a_killed_worker_is_given_back(
    machine_client: Client, small_machine: Any, large_relief: Path
) -> None:
    first = start_and_suspend(machine_client, small_machine, large_relief)
    second = make(machine_client, large_relief, LARGE)
    wait_until(lambda: machine_client.job(second.id).waits_for == "memory")
    small_machine.engines()[0].parent().parent().kill()

    def started_again() -> Job | None:
        jobs = [machine_client.job(job.id) for job in (first, second)]
        return next((j for j in jobs if (j.id, j.attempt) in ((first.id, 2), (second.id, 1))), None)

    # Either may come first when the lease is over; the other one waits for it.
    earlier = wait_until(started_again)
    later = second if earlier.id == first.id else first
    machine_client.cancel(earlier.id)
    wait_until(lambda: state(machine_client, later) is JobState.RUNNING)
    wait_until(lambda: len(small_machine.workers()) == 2)
    cancel(machine_client, small_machine, later)


@pytest.mark.slow
def test_a_job_that_is_larger_than_the_machine_fails_and_holds_up_no_other(
    machine_client: Client, small_machine: Any, tmp_path: Path, small_relief: Path
) -> None:
    path = tmp_path / "huge.ply"
    path.write_bytes(ply_bytes(*punched_relief(400)))
    before = make(machine_client, small_relief, SMALL)
    huge = make(machine_client, path, LARGE)
    after = make(machine_client, small_relief, SMALL)
    with pytest.raises(JobFailedError) as caught:
        machine_client.wait(huge.id, timeout_s=GUARD_S)
    error = caught.value.job.error
    assert error is not None
    assert (error.code, error.retryable) == ("out_of_memory", False)
    assert int(error.message.split()[-2]) <= MACHINE_MB
    assert caught.value.job.attempt == 1
    assert all(machine_client.wait(job.id, timeout_s=GUARD_S).state.has_result for job in (before, after))
