"""Pins and deletions on the command line, against a real service.

Also tests `quadpatch_client.job_commands`.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from typer.testing import CliRunner

from quadpatch_client.cli import app
from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.schema import JobSpec, JobState, SmoothMethod
from quadpatch_client.sdk import Client


def test_a_job_is_pinned_unpinned_and_deleted(
    serve: Callable[..., AbstractContextManager[Any]], tmp_path: Path
) -> None:
    scan = tmp_path / "scan.ply"
    scan.write_bytes(b"ply")
    with serve() as service, Client(service.url) as client:
        mesh = client.upload(scan)
        job = client.create_job(JobSpec(mesh_id=mesh.id, method=SmoothMethod(method="smooth")))

        def run(*arguments: str) -> int:
            return CliRunner().invoke(app, [*arguments, job.id, "--url", service.url]).exit_code

        assert run("pin") == 0
        assert client.job(job.id).pinned
        assert run("pin", "--off") == 0
        assert not client.job(job.id).pinned
        assert run("delete") == ExitCode.REJECTED
        assert client.cancel(job.id).state == JobState.CANCELED
        assert run("delete") == 0
        assert list(client.jobs()) == []
        assert run("delete") == run("pin") == ExitCode.REJECTED
