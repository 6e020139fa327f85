"""Cancel, crash and stop in the middle of a repair; nothing may stay behind and no job may hang."""

import contextlib
import os
import signal
from pathlib import Path
from typing import Any

import httpx
import psutil
import pytest

from onebox.demo import running_stack
from quadpatch_client.errors import JobCanceledError, JobFailedError
from quadpatch_client.schema import Job, JobSpec, JobState
from quadpatch_client.sdk import Client
from tests.waiting import GUARD_S, wait_until

# Learns from the mesh itself, which takes seconds: time enough to interrupt it.
LONG = {"method": {"method": "dictionary", "model": "self"}, "output": {"preview": False}}
# Patches this small make thousands of quads: the mesher is at it for seconds, and never looks up.
FINE = {"method": "dictionary", "model": "self", "patches": {"length": 0.012}}


def assert_nothing_is_left(local_stack: Any) -> None:
    """Processes and files go soon after the job has ended: where its worker is slow, the dispatcher ends it first."""
    wait_until(lambda: not local_stack.engines() and not local_stack.requests())


def start_long_job(client: Client, local_stack: Any, path: Path) -> Job:
    """Start a long job and return it when its engine is at work."""
    mesh = client.wait_for_mesh(client.upload(path).id, timeout_s=GUARD_S)
    job = client.create_job(JobSpec.model_validate({"mesh_id": mesh.id, **LONG}))
    wait_until(lambda: client.job(job.id).percent > 0 and local_stack.engines())
    return job


def test_a_canceled_job_leaves_no_process_and_no_file(client: Client, local_stack: Any, large_relief: Path) -> None:
    job = start_long_job(client, local_stack, large_relief)
    assert client.cancel(job.id).state in (JobState.CANCELING, JobState.CANCELED)
    with pytest.raises(JobCanceledError):
        client.wait(job.id, timeout_s=GUARD_S)
    assert_nothing_is_left(local_stack)
    assert not (local_stack.data / "objects" / "results" / job.id).exists()


@pytest.mark.slow
def test_a_job_is_canceled_in_the_middle_of_native_code(client: Client, local_stack: Any, fine_relief: Path) -> None:
    mesh = client.wait_for_mesh(client.upload(fine_relief).id, timeout_s=GUARD_S)
    job = client.create_job(JobSpec.model_validate({"mesh_id": mesh.id, "method": FINE}))
    wait_until(lambda: client.job(job.id).stage == "quadrangulate")
    client.cancel(job.id)
    with pytest.raises(JobCanceledError):
        client.wait(job.id, timeout_s=GUARD_S)
    events = httpx.get(f"{local_stack.url}/v1/jobs/{job.id}/events", timeout=GUARD_S).json()["items"]
    assert [event["type"] for event in events[-2:]] == ["cancel_requested", "canceled"]
    assert events[-3]["data"]["stage"] == "quadrangulate"
    assert_nothing_is_left(local_stack)


def test_an_engine_killed_in_every_attempt_ends_in_a_clear_failure(
    client: Client, local_stack: Any, large_relief: Path
) -> None:
    job = start_long_job(client, local_stack, large_relief)

    def has_ended_among_kills() -> bool:
        for engine in local_stack.engines():
            with contextlib.suppress(psutil.NoSuchProcess):
                engine.kill()
        return client.job(job.id).state.is_terminal

    wait_until(has_ended_among_kills)
    with pytest.raises(JobFailedError) as caught:
        client.wait(job.id, timeout_s=GUARD_S)
    error = caught.value.job.error
    assert error is not None
    assert (error.code, error.message) == ("engine_crashed", "the engine was ended by SIGKILL")
    assert caught.value.job.attempt == caught.value.job.max_attempts
    assert_nothing_is_left(local_stack)


@pytest.mark.slow
def test_a_killed_worker_takes_its_engine_along_and_another_attempt_succeeds(
    client: Client, local_stack: Any, large_relief: Path
) -> None:
    job = start_long_job(client, local_stack, large_relief)
    (engine,) = local_stack.engines()
    worker = engine.parent().parent()
    worker.kill()
    wait_until(lambda: not engine.is_running())
    finished = client.wait(job.id, timeout_s=GUARD_S)
    assert finished.attempt == 2
    wait_until(lambda: len(local_stack.workers()) == 2)
    wait_until(lambda: local_stack.requests() == [])


@pytest.mark.slow
def test_a_stopped_worker_hands_its_job_back(client: Client, local_stack: Any, large_relief: Path) -> None:
    job = start_long_job(client, local_stack, large_relief)
    (engine,) = local_stack.engines()
    worker = engine.parent().parent()
    # A job that is nearly done may still end in the stopped worker; this one stands still.
    engine.suspend()
    worker.terminate()
    finished = client.wait(job.id, timeout_s=GUARD_S)
    assert finished.state.has_result
    assert finished.attempt == 2


def test_a_job_over_its_time_limit_fails_with_the_code_and_the_stage(
    client: Client, local_stack: Any, fine_relief: Path
) -> None:
    """The limit is long enough to begin with, and a small part of what the job takes."""
    mesh = client.upload(fine_relief)
    limited = {"mesh_id": mesh.id, "method": FINE, "limits": {"time_s": 4.0}}
    job = client.create_job(JobSpec.model_validate(limited))
    with pytest.raises(JobFailedError, match="longer than the limit of 4 s") as caught:
        client.wait(job.id, timeout_s=GUARD_S)
    error = caught.value.job.error
    assert error is not None
    assert (error.code, error.retryable) == ("time_limit_exceeded", False)
    assert error.stage is not None
    assert_nothing_is_left(local_stack)


@pytest.mark.slow
def test_a_killed_queue_comes_back_and_no_job_is_lost(client: Client, local_stack: Any, large_relief: Path) -> None:
    mesh = client.upload(large_relief)
    smooth = {"mesh_id": mesh.id, "method": {"method": "smooth"}, "output": {"preview": False}}
    local_stack.valkey().kill()
    jobs = [client.create_job(JobSpec.model_validate(smooth)) for _ in range(3)]
    assert all(client.wait(job.id, timeout_s=GUARD_S).state.has_result for job in jobs)


@pytest.mark.slow
def test_a_stopped_local_stack_leaves_nothing_running(tmp_path: Path) -> None:
    with running_stack(tmp_path) as url, Client(url) as client:
        (pid,) = [int(line) for line in (tmp_path / "box.lock").read_text().split()]
        client.models()
    assert not Path(f"/proc/{pid}").exists()
    running = [path for path in Path("/proc").glob("[0-9]*") if _data_folder(path) == str(tmp_path)]
    assert running == []


@pytest.mark.slow
def test_a_killed_local_stack_leaves_nothing_running(tmp_path: Path) -> None:
    with running_stack(tmp_path) as url, Client(url) as client:
        client.models()
        os.kill(int((tmp_path / "box.lock").read_text()), signal.SIGKILL)
        wait_until(lambda: not [p for p in Path("/proc").glob("[0-9]*") if _data_folder(p) == str(tmp_path)])


def _data_folder(process: Path) -> str:
    try:
        if " Z " in (process / "stat").read_text():
            return ""
        variables = (process / "environ").read_bytes().split(b"\0")
    except OSError:
        return ""
    return next((v.partition(b"=")[2].decode() for v in variables if v.startswith(b"QUADPATCH_DATA_DIR=")), "")
