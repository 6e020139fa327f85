"""The client's command line against a real local stack."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from quadpatch_client.cli import app
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.schema import Job, JobSpec, JobState
from quadpatch_client.sdk import Client
from tests.waiting import GUARD_S, wait_until


@pytest.fixture
def run(local_stack: Any) -> Callable[..., Result]:
    """Runs a command of the client and returns how it ended."""

    def run_client(*arguments: str | Path) -> Result:
        return CliRunner().invoke(
            app, [*map(str, arguments)], env={"QUADPATCH_CLIENT_URL": local_stack.url, "COLUMNS": "200"}
        )

    return run_client


def test_repair_writes_what_was_asked_for_and_tells_so(
    run: Callable[..., Result], relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    names = ("out.ply", "r.json", "p.png", "holes", "r.html")
    output, report, preview, closeups, page = (tmp_path / name for name in names)
    arguments = ["-o", output, "--method", "smooth", "--report", report, "--preview", preview, "--closeups", closeups]
    arguments += ["--html", page]
    done = run("repair", relief_file("float.ply"), *arguments)
    assert done.exit_code == ExitCode.OK, done.stderr
    assert done.stdout == ""
    assert "float.ply has 5 holes: 4 filled smoothly, 1 left open by rule" in done.stderr
    pictures = [closeups / f"hole_{i}.png" for i in (1, 2, 3, 4)]
    assert sorted(closeups.iterdir()) == pictures
    assert all(f"wrote {path}" in done.stderr for path in (output, report, preview, page, *pictures))
    assert all(path.stat().st_size > 0 for path in (output, report, preview, page, *pictures))


def test_the_suffix_of_the_output_says_its_format(
    run: Callable[..., Result], relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    options = ["--method", "smooth", "--json", "--quiet"]
    done = run("repair", relief_file("float.ply"), "-o", tmp_path / "out.glb", *options)
    assert json.loads(done.stdout)["result"]["format"] == "glb"
    assert (tmp_path / "out.glb").read_bytes().startswith(b"glTF")
    run("repair", relief_file("float.ply"), "-o", tmp_path / "out.mesh", "--format", "ply", *options)
    assert (tmp_path / "out.mesh").read_bytes().startswith(b"ply")


def test_a_scan_is_encoded_and_brought_back(
    run: Callable[..., Result], relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    scan, encoded, again = relief_file("float.ply"), tmp_path / "scan.qpz", tmp_path / "again.stl"
    done = run("encode", scan, "-o", encoded, "--max-error", "0.01")
    assert done.exit_code == ExitCode.OK, done.stderr
    assert f"float.ply: encoded in {encoded.stat().st_size:,} bytes, no farther than 0.0" in done.stderr
    assert encoded.stat().st_size < scan.stat().st_size / 10
    done = run("decode", encoded, "-o", again)
    assert done.exit_code == ExitCode.OK, done.stderr
    assert again.stat().st_size > encoded.stat().st_size


def test_json_on_stdout_is_the_job(
    run: Callable[..., Result], relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    done = run(
        "repair", relief_file("float.ply"), "-o", tmp_path / "out.ply", "--method", "smooth", "--json", "--quiet"
    )
    assert json.loads(done.stdout)["result"]["holes"]["filled_smooth"] == 4
    assert done.stderr == ""


def test_holes_lists_every_hole_and_what_would_be_filled(
    run: Callable[..., Result], relief_file: Callable[[str], Path]
) -> None:
    done = run("holes", relief_file("float.ply"), "--max-diameter", "0.05")
    assert done.exit_code == ExitCode.OK, done.stderr
    assert "5 holes; lengths in mesh units" in done.stdout
    # The fifth is the outer border, which stays open whatever its size.
    assert done.stdout.count("no: too wide") == 4
    assert done.stdout.count("no: border") == 1
    plan = json.loads(run("holes", relief_file("float.ply"), "--json").stdout)
    assert [hole["selected"] for hole in plan["holes"]] == [False, True, True, True, True]


def test_the_doctor_finds_nothing_in_the_way_of_a_healthy_service(run: Callable[..., Result]) -> None:
    done = run("doctor", "--json")
    assert done.exit_code == ExitCode.OK, done.stdout
    found = {finding["subject"]: finding["verdict"] for finding in json.loads(done.stdout)}
    assert {"address", "service", "clock", "readiness", "key", "limits"} <= found.keys()
    assert "error" not in found.values()


def test_jobs_and_models_are_listed(run: Callable[..., Result]) -> None:
    assert isinstance(json.loads(run("jobs", "--limit", "2", "--json").stdout), list)
    assert set(json.loads(run("models", "--json").stdout)) == {"models", "aliases", "next_cursor"}
    assert run("jobs").exit_code == run("models").exit_code == ExitCode.OK


def test_exit_codes_tell_what_went_wrong(
    run: Callable[..., Result], relief_file: Callable[[str], Path], tmp_path: Path
) -> None:
    mesh, garbage, output = relief_file("float.ply"), tmp_path / "garbage.ply", tmp_path / "out.ply"
    garbage.write_bytes(b"ply\n" + os.urandom(500))
    wrong = {
        ("repair", mesh, "-o", output, "--method", "smooth", "--model", "self"): ExitCode.USAGE,
        ("repair", mesh, "-o", output, "--max-diameter", "-1"): ExitCode.USAGE,
        ("repair", tmp_path / "absent.ply", "-o", output): ExitCode.USAGE,
        ("repair", mesh, "-o", tmp_path / "absent" / "out.ply", "--method", "smooth"): ExitCode.USAGE,
        ("repair", mesh, "-o", tmp_path / "out.xyz", "--method", "smooth"): ExitCode.USAGE,
        ("repair", mesh, "-o", output, "--method", "smooth", "--report", output): ExitCode.USAGE,
        ("repair", mesh, "-o", output, "--model", "no-such-model@1"): ExitCode.REJECTED,
        ("repair", mesh, "-o", output, "--method", "cnn", "--model", "general-dictionary@1"): ExitCode.REJECTED,
        ("repair", mesh, "-o", output, "--method", "cnn", "--fit-steps", "9"): ExitCode.USAGE,
        ("repair", mesh, "-o", output, "--method", "cnn", "--model", "self", "--fit-seconds", "0"): ExitCode.USAGE,
        ("repair", mesh, "-o", output, "--method", "smooth", "--hole", "99"): ExitCode.REJECTED,
        ("holes", garbage): ExitCode.REJECTED,
        ("cancel", "job_00000000000000000000000000"): ExitCode.REJECTED,
        ("models", "--url", "http://127.0.0.1:9"): ExitCode.UNREACHABLE,
    }
    assert {arguments: run(*arguments).exit_code for arguments in wrong} == wrong
    assert not output.exists()


def test_a_timeout_cancels_the_job(run: Callable[..., Result], large_relief: Path, tmp_path: Path) -> None:
    done = run("repair", large_relief, "-o", tmp_path / "out.ply", "--model", "self", "--timeout", "0.5")
    assert done.exit_code == ExitCode.CANCELED
    assert "did not end within 0.5 s" in done.stderr
    assert not (tmp_path / "out.ply").exists()


@pytest.fixture
def with_ctrl_c() -> Iterator[None]:
    """A run in the background is started with Ctrl-C ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("with_ctrl_c")
def test_ctrl_c_before_the_service_has_answered_cancels_the_job_all_the_same(
    run: Callable[..., Result], client: Client, large_relief: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[Job] = []

    def create(self: Client, spec: JobSpec) -> Job:
        os.kill(os.getpid(), signal.SIGINT)
        made.append(self.create_job(spec))
        return made[0]

    monkeypatch.setattr(Client, "create_job_once", create)
    done = run("repair", large_relief, "-o", tmp_path / "out.ply", "--model", "self")
    assert done.exit_code == ExitCode.INTERRUPTED
    assert "the job is canceled as soon as the service has answered" in " ".join(done.stderr.split())
    assert f"job {made[0].id}: cancel" in done.stderr
    wait_until(lambda: client.job(made[0].id).state.is_terminal)
    assert client.job(made[0].id).state == JobState.CANCELED


def test_ctrl_c_cancels_the_job_and_says_so(client: Any, local_stack: Any, large_relief: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "quadpatch_client", "repair", str(large_relief), "-o", str(tmp_path / "out.ply")]
    process = subprocess.Popen(
        [*command, "--model", "self", "--url", local_stack.url, "--label", "interrupted"],
        stderr=subprocess.PIPE,
        text=True,
        # A run in the background is started with Ctrl-C ignored, and hands that on.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509
    )

    def running() -> list[Any]:
        return [job for job in client.jobs(20) if job.spec.label == "interrupted" and job.state == JobState.RUNNING]

    (job,) = wait_until(running, process)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=GUARD_S)
    assert process.returncode == ExitCode.INTERRUPTED
    assert f"job {job.id}: cancel" in said
    wait_until(lambda: client.job(job.id).state.is_terminal)
    assert client.job(job.id).state == JobState.CANCELED
