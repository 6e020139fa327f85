"""The service in Python: upload a mesh, start a job, wait for it, fetch what it made.

::

    with Client("http://127.0.0.1:8000") as client:
        mesh = client.upload(Path("scan.ply"))
        job = client.create_job(JobSpec(mesh_id=mesh.id))
        job = client.wait(job.id)
        client.download(job, "result", Path("scan_repaired.ply"))

Tested in `tests/quadpatch_client/test_watching.py`.
"""

import hashlib
import json
import tempfile
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Self

from quadpatch_client.catalogue import PAGE, Catalogue
from quadpatch_client.closeups import unpack_closeups
from quadpatch_client.errors import (
    ClientError,
    JobCanceledError,
    JobFailedError,
    RefusedError,
    WaitTimeoutError,
)
from quadpatch_client.handles import JobHandle
from quadpatch_client.mesh_calls import MeshCalls
from quadpatch_client.polling import parse
from quadpatch_client.progress import ByteProgress, no_progress
from quadpatch_client.schema import (
    FileRole,
    Job,
    JobPage,
    JobSpec,
    JobState,
    Plan,
    identity_of,
)
from quadpatch_client.transfers import download, label_of, sent_name
from quadpatch_client.transport import Transport
from quadpatch_client.watching import watch

# Of failed and canceled jobs with the same spec that are passed over.
_MOST_KEYS = 20


def ignore_job(job: Job) -> None:
    """Ignore a change of a job."""


def with_result(job: Job) -> Job:
    """Return a job that has ended with a result.

    Raises
    ------
    JobFailedError, JobCanceledError
    """
    if job.state == JobState.FAILED:
        raise JobFailedError(job)
    if job.state == JobState.CANCELED:
        raise JobCanceledError(job)
    return job


class Client(MeshCalls, Catalogue):
    """One service.

    Parameters
    ----------
    base_url : str
        Like `http://127.0.0.1:8000`.
    api_key : str, optional
        Needed wherever the service listens to others than its own machine.
    patience_s : float
        How long a request is repeated while the line is down, in seconds.
    """

    def __init__(self, base_url: str, api_key: str | None = None, patience_s: float = 60.0) -> None:
        super().__init__(Transport(base_url, api_key, patience_s))

    def create_job(self, spec: JobSpec, idempotency_key: str | None = None, *, runs_anew: bool = False) -> Job:
        """Start a job. Repeated on a broken line, it is still started once.

        A spec without `mesh_name` takes the name of the file that this client uploaded last as that mesh.

        Parameters
        ----------
        spec : JobSpec
        idempotency_key : str, optional
            Give your own to be safe across a restart of your program.
        runs_anew : bool
            Whether it runs although an equal job has left a result.
        """
        if spec.mesh_name is None:
            spec = spec.model_copy(update={"mesh_name": self._names.get(spec.mesh_id) or None})
        response = self._transport.request(
            "POST",
            "/v1/jobs",
            json=spec.model_dump(mode="json"),
            headers={
                "Idempotency-Key": idempotency_key or str(uuid.uuid4()),
                **({"Cache-Control": "no-cache"} if runs_anew else {}),
            },
        )
        return parse(Job, response)

    def create_job_once(self, spec: JobSpec) -> Job:
        """Start a job, unless the same spec was sent before and its job is on its way or has a result: return that.

        So a program that was ended, or that gave up on a service which was away, finds its job again by asking for
        the same thing. A job that failed or was canceled is no reason not to start another one.
        """
        text = json.dumps(json.loads(identity_of(spec)), sort_keys=True)
        digest = hashlib.sha256(text.encode()).hexdigest()
        for number in range(1, _MOST_KEYS + 1):
            try:
                job = self.create_job(spec, f"same-{digest}-{number}")
            except RefusedError as error:
                # Under the same key an older client sent something else.
                if error.problem.code != "idempotency_conflict":
                    raise
                continue
            if job.state not in (JobState.FAILED, JobState.CANCELED):
                return job
        return self.create_job(spec)

    def plan(self, spec: JobSpec) -> Plan:
        """Ask what a job would do, without starting it."""
        response = self._transport.request(
            "POST", "/v1/jobs", params={"dry_run": "true"}, json=spec.model_dump(mode="json")
        )
        return parse(Plan, response)

    def job(self, job_id: str) -> Job:
        """Return a job as it stands."""
        return parse(Job, self._transport.request("GET", f"/v1/jobs/{job_id}"))

    def wait(self, job_id: str, on_change: Callable[[Job], None] = ignore_job, timeout_s: float | None = None) -> Job:
        """Wait for the end of a job and return it.

        Parameters
        ----------
        job_id : str
        on_change : callable
            Called with the job whenever something about it has changed, its place in the queue and the estimate of
            its end among it.
        timeout_s : float, optional
            None: wait as long as it takes.

        Raises
        ------
        JobFailedError, JobCanceledError, WaitTimeoutError
        """
        for job in self.events(job_id, timeout_s):
            on_change(job)
            if job.state.is_terminal:
                return with_result(job)
        raise WaitTimeoutError(f"job {job_id} did not end within {timeout_s:g} s")

    def events(self, job_id: str, timeout_s: float | None = None) -> Iterator[Job]:
        """Yield a job as it stands now, and whenever something about it has changed, until it has ended.

        Parameters
        ----------
        job_id : str
        timeout_s : float, optional
            None: as long as it takes.
        """
        seen = None
        for job in watch(self._transport, f"/v1/jobs/{job_id}", timeout_s):
            if job != seen:
                yield job
            seen = job

    def repair(self, path: Path, **options: Any) -> "JobHandle":
        """Send a scan and start a job on it; the same file with the same options finds its job again.

        Parameters
        ----------
        path : Path
        **options
            Fields of the job spec, such as `holes={"max_diameter": 20.0}` or `output={"preview": True}`.

        Raises
        ------
        ClientError, pydantic.ValidationError
            The latter, a ValueError, where there is no such field, or it may not be so.

        Examples
        --------
        >>> with Client(URL) as client:
        ...     job = client.repair(Path("scan.ply"), method={"method": "smooth"})
        ...     job.fetch(Path("repaired.ply"), report=Path("report.json"))
        ...     print(job.wait().state)
        [PosixPath('repaired.ply'), PosixPath('report.json')]
        succeeded
        """
        mesh = self.upload(path)
        named = {"label": label_of(path), "mesh_name": sent_name(path) or None, **options}
        return JobHandle(self, self.create_job_once(JobSpec.model_validate({"mesh_id": mesh.id, **named})))

    def handle(self, job_id: str) -> "JobHandle":
        """Return a handle of a job that was started before."""
        return JobHandle(self, self.job(job_id))

    def cancel(self, job_id: str) -> Job:
        """Cancel a job; one that has ended already is returned as it is."""
        try:
            return parse(Job, self._transport.request("POST", f"/v1/jobs/{job_id}/cancel"))
        except RefusedError as error:
            if error.problem.code != "job_finished":
                raise
            return self.job(job_id)

    def delete(self, job_id: str) -> None:
        """Delete a finished job with all it left. There is no way back."""
        self._transport.request("DELETE", f"/v1/jobs/{job_id}")

    def pin(self, job_id: str, is_pinned: bool = True) -> None:
        """Keep a job whatever the retention, or no longer."""
        self._transport.request("PUT" if is_pinned else "DELETE", f"/v1/jobs/{job_id}/pin")

    def download(
        self,
        job: Job,
        role: FileRole,
        target: Path,
        progress: ByteProgress = no_progress,
    ) -> None:
        """Fetch a file of a finished job; `target` appears whole or not at all.

        Raises
        ------
        ClientError
            If the job has no such file.
        DamagedTransferError
        """
        file = job.result.file(role) if job.result else None
        link: str | None = getattr(job.links, role)
        if file is None or link is None:
            raise ClientError(f"job {job.id} has no {role}")
        download(self._transport, link, target, file.sha256, progress)

    def download_closeups(self, job: Job, folder: Path) -> list[Path]:
        """Fetch the pictures of the chosen holes and unpack them into a folder; return the files, `hole_<id>.png`.

        The folder is made where it is missing. Nothing is written outside of it.

        Raises
        ------
        ClientError
            If the job has none, or what came holds anything but such pictures.
        DamagedTransferError
        """
        with tempfile.TemporaryDirectory() as scratch:
            archive = Path(scratch) / "closeups.zip"
            self.download(job, "closeups", archive)
            return unpack_closeups(archive, folder)

    def jobs(self, limit: int | None = None, state: JobState | None = None, **search: str) -> Iterator[Job]:
        """Yield jobs, newest first, fetched page by page.

        Parameters
        ----------
        limit : int, optional
            Most jobs; None: all.
        state : JobState, optional
            Only jobs in this state.
        search : str
            Further parameters of `GET /v1/jobs`, such as `label="station 4*"`.
        """
        left = limit
        cursor: str | None = None
        while left is None or left > 0:
            params = {"limit": str(min(left or PAGE, PAGE)), **search}
            params |= {"cursor": cursor} if cursor else {}
            params |= {"state": state.value} if state else {}
            page = parse(JobPage, self._transport.request("GET", "/v1/jobs", params=params))
            yield from page.items
            left = None if left is None else left - len(page.items)
            cursor = page.next_cursor
            if cursor is None:
                return

    def close(self) -> None:
        """Close all connections."""
        self._transport.close()

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()
