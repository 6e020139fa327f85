"""The service for programs that run on asyncio: the client of `quadpatch_client.sdk`, in threads of its own.

No call keeps the event loop waiting. A call that is canceled is no longer waited for; what its thread has sent goes on.

Tested in `tests/integration/test_sdk.py`.
"""

import asyncio
from collections.abc import AsyncIterator, Callable
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any, ParamSpec, Self, TypeVar

from quadpatch_client.errors import WaitTimeoutError
from quadpatch_client.handles import files_by_role
from quadpatch_client.progress import ByteProgress, no_progress
from quadpatch_client.schema import (
    CallerLimits,
    FileRole,
    Job,
    JobSpec,
    JobState,
    Key,
    KeyWithSecret,
    Mesh,
    ModelList,
    NewTraining,
    Plan,
    Rule,
    RuleContent,
    Scope,
    Training,
)
from quadpatch_client.sdk import Client, ignore_job, with_result
from quadpatch_client.workers import Workers

P = ParamSpec("P")
T = TypeVar("T")


class AsyncClient:
    """One service.

    Parameters
    ----------
    base_url : str
        Like `http://127.0.0.1:8000`.
    api_key : str, optional
    patience_s : float
        How long a request is repeated while the line is down, in seconds.
    n_threads : int
        Calls at a time; further ones wait for their turn.

    Examples
    --------
    >>> async def repair(name: str) -> str:
    ...     async with AsyncClient(URL) as client:
    ...         job = await client.repair(Path(name), method={"method": "smooth"})
    ...         async for seen in job.events():
    ...             pass
    ...         await job.fetch(Path("repaired.ply"))
    ...         return seen.state.value
    >>> asyncio.run(repair("scan.ply"))
    'succeeded'
    """

    def __init__(
        self, base_url: str, api_key: str | None = None, patience_s: float = 60.0, *, n_threads: int = 16
    ) -> None:
        self._client = Client(base_url, api_key, patience_s)
        self._workers = Workers(n_threads)

    async def upload(self, path: Path, progress: ByteProgress = no_progress) -> Mesh:
        """Send a mesh file, as `Client.upload` does; `progress` is called in another thread."""
        return await self._call(self._client.upload, path, progress)

    async def mesh(self, mesh_id: str) -> Mesh:
        """Return a mesh as it stands."""
        return await self._call(self._client.mesh, mesh_id)

    async def wait_for_mesh(self, mesh_id: str, timeout_s: float | None = None) -> Mesh:
        """Wait until a mesh is analysed, as `Client.wait_for_mesh` does."""
        return await self._call(self._client.wait_for_mesh, mesh_id, timeout_s)

    async def create_job(self, spec: JobSpec, idempotency_key: str | None = None, *, runs_anew: bool = False) -> Job:
        """Start a job, as `Client.create_job` does."""
        return await self._call(self._client.create_job, spec, idempotency_key, runs_anew=runs_anew)

    async def create_job_once(self, spec: JobSpec) -> Job:
        """Start a job unless it is on its way or has a result, as `Client.create_job_once` does."""
        return await self._call(self._client.create_job_once, spec)

    async def plan(self, spec: JobSpec) -> Plan:
        """Ask what a job would do, without starting it."""
        return await self._call(self._client.plan, spec)

    async def job(self, job_id: str) -> Job:
        """Return a job as it stands."""
        return await self._call(self._client.job, job_id)

    async def jobs(self, limit: int | None = None, state: JobState | None = None, **search: str) -> list[Job]:
        """Return jobs, newest first, as `Client.jobs` yields them."""
        return await self._call(lambda: list(self._client.jobs(limit, state, **search)))

    async def models(self) -> ModelList:
        """Return all models and aliases."""
        return await self._call(self._client.models)

    async def rules(self) -> list[Rule]:
        """Return all rules by name, each in its latest version."""
        return await self._call(self._client.rules)

    async def rule(self, reference: str) -> Rule:
        """Return a rule by its name, in its latest version, or by `name@version`."""
        return await self._call(self._client.rule, reference)

    async def save_rule(self, name: str, content: RuleContent) -> Rule:
        """Save a rule; a name that is there gets its next version."""
        return await self._call(self._client.save_rule, name, content)

    async def limits(self) -> CallerLimits:
        """Return what limits the caller, and what the service offers."""
        return await self._call(self._client.limits)

    async def keys(self) -> list[Key]:
        """Return the keys of the tenant, without their secrets."""
        return await self._call(self._client.keys)

    async def create_key(
        self, name: str, scopes: list[Scope] | None = None, tenant: str | None = None, until: datetime | None = None
    ) -> KeyWithSecret:
        """Make a key, as `Client.create_key` does."""
        return await self._call(self._client.create_key, name, scopes, tenant, until)

    async def revoke_key(self, key_id: str) -> None:
        """End a key. There is no way back."""
        await self._call(self._client.revoke_key, key_id)

    async def train(self, wanted: NewTraining) -> Training:
        """Learn a model from uploaded meshes, as `Client.train` does."""
        return await self._call(self._client.train, wanted)

    async def events(self, job_id: str, timeout_s: float | None = None) -> AsyncIterator[Job]:
        """Yield a job as it stands, and whenever something about it has changed, until it has ended."""
        changes = self._client.events(job_id, timeout_s)
        while (job := await self._call(partial(next, changes, None))) is not None:
            yield job

    async def wait(
        self, job_id: str, on_change: Callable[[Job], None] = ignore_job, timeout_s: float | None = None
    ) -> Job:
        """Wait for the end of a job, as `Client.wait` does; `on_change` is called in the event loop."""
        async for job in self.events(job_id, timeout_s):
            on_change(job)
            if job.state.is_terminal:
                return with_result(job)
        raise WaitTimeoutError(f"job {job_id} did not end within {timeout_s:g} s")

    async def cancel(self, job_id: str) -> Job:
        """Cancel a job; one that has ended already is returned as it is."""
        return await self._call(self._client.cancel, job_id)

    async def delete(self, job_id: str) -> None:
        """Delete a finished job with all it left. There is no way back."""
        await self._call(self._client.delete, job_id)

    async def download(self, job: Job, role: FileRole, target: Path, progress: ByteProgress = no_progress) -> None:
        """Fetch a file of a finished job, as `Client.download` does; `progress` is called in another thread."""
        await self._call(self._client.download, job, role, target, progress)

    async def repair(self, path: Path, **options: Any) -> "AsyncJobHandle":
        """Send a scan and start a job on it, as `Client.repair` does."""
        return AsyncJobHandle(self, (await self._call(partial(self._client.repair, path, **options))).job)

    async def handle(self, job_id: str) -> "AsyncJobHandle":
        """Return a handle of a job that was started before."""
        return AsyncJobHandle(self, await self.job(job_id))

    async def close(self) -> None:
        """Close all connections."""
        self._workers.close()
        await asyncio.to_thread(self._client.close)

    async def __aenter__(self) -> Self:
        """Return itself."""
        return self

    async def __aexit__(self, *_: object) -> None:
        """Close."""
        await self.close()

    async def _call(self, call: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
        return await asyncio.wrap_future(self._workers.submit(partial(call, *arguments, **named)))


class AsyncJobHandle:
    """A job that was started, for asyncio.

    Attributes
    ----------
    job : Job
        As it was seen last.
    """

    def __init__(self, client: AsyncClient, job: Job) -> None:
        self._client, self.job = client, job

    @property
    def id(self) -> str:
        """Id of the job."""
        return self.job.id

    async def events(self, timeout_s: float | None = None) -> AsyncIterator[Job]:
        """Yield the job as it stands, and whenever something about it has changed, until it has ended."""
        async for job in self._client.events(self.id, timeout_s):
            self.job = job
            yield job

    async def wait(self, on_change: Callable[[Job], None] = ignore_job, timeout_s: float | None = None) -> Job:
        """Wait for the end, and return the job; errors are those of `Client.wait`."""
        self.job = await self._client.wait(self.id, on_change, timeout_s)
        return self.job

    async def fetch(
        self, result: Path, *, report: Path | None = None, html: Path | None = None, preview: Path | None = None
    ) -> list[Path]:
        """Wait for the end, and fetch what is asked for, as `JobHandle.fetch` does."""
        job = await self.wait()
        wanted = files_by_role(result, report, html, preview)
        for role, path in wanted.items():
            await self._client.download(job, role, path)
        return list(wanted.values())

    async def cancel(self) -> Job:
        """Cancel the job; one that has ended stays as it is."""
        self.job = await self._client.cancel(self.id)
        return self.job
