"""A job that was started: wait for it, follow it, fetch what it made.

Tested in `tests/integration/test_sdk.py`.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from quadpatch_client.schema import FileRole, Job

if TYPE_CHECKING:
    from quadpatch_client.sdk import Client


class JobHandle:
    """A job of one service.

    Attributes
    ----------
    job : Job
        As it was seen last.
    """

    def __init__(self, client: "Client", job: Job) -> None:
        self._client, self.job = client, job

    @property
    def id(self) -> str:
        """Id of the job."""
        return self.job.id

    def events(self, timeout_s: float | None = None) -> Iterator[Job]:
        """Yield the job as it stands, and whenever something about it has changed, until it has ended.

        Examples
        --------
        >>> with Client(URL) as client:
        ...     job = client.repair(Path("scan.ply"), method={"method": "smooth"})
        ...     states = [job.state.value for job in job.events()]
        >>> states[-1]
        'succeeded'
        """
        for job in self._client.events(self.id, timeout_s):
            self.job = job
            yield job

    def wait(self, on_change: Callable[[Job], None] | None = None, timeout_s: float | None = None) -> Job:
        """Wait for the end, and return the job; `on_change` gets it whenever something has changed.

        Raises
        ------
        JobFailedError, JobCanceledError, WaitTimeoutError
        """
        self.job = self._client.wait(self.id, on_change or _ignore, timeout_s)
        return self.job

    def fetch(
        self, result: Path, *, report: Path | None = None, html: Path | None = None, preview: Path | None = None
    ) -> list[Path]:
        """Wait for the end, and fetch what is asked for, verified by its sha256; return what was written.

        Parameters
        ----------
        result, report, html, preview : Path
            Each appears whole or not at all.

        Raises
        ------
        JobFailedError, JobCanceledError, DamagedTransferError
        """
        job = self.wait()
        wanted = files_by_role(result, report, html, preview)
        for role, path in wanted.items():
            self._client.download(job, role, path)
        return list(wanted.values())

    def cancel(self) -> Job:
        """Cancel the job; one that has ended stays as it is."""
        self.job = self._client.cancel(self.id)
        return self.job


def files_by_role(result: Path, report: Path | None, html: Path | None, preview: Path | None) -> dict[FileRole, Path]:
    """Return which file of a job goes where."""
    places: dict[FileRole, Path | None] = {
        "result": result,
        "report": report,
        "html_report": html,
        "preview": preview,
    }
    return {role: path for role, path in places.items() if path is not None}


def _ignore(_: Job) -> None:
    pass
