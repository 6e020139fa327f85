"""Everything that the SDK raises on purpose.

::

    ClientError
    ├── UnreachableError        no answer, however often it was tried
    ├── RefusedError            the service answered with a problem document; `problem.code` is stable
    ├── AnswerError             the service answered something that is not its contract
    ├── MeshRejectedError       the service could not read the mesh; `problem.code` says why
    ├── JobFailedError          the job ended without a result; `job.error.code` says why
    ├── JobCanceledError        the job was canceled
    ├── WaitTimeoutError        the job, or the analysis of a mesh, was not done in time
    ├── DamagedTransferError    bytes arrived that are not those that were sent
    └── UsageError              an option that makes no sense, or a file that can't be read or written

Tested in `tests/quadpatch_client/test_transport.py`.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quadpatch_client.schema import Job, MeshProblem, Problem


# What the service says in terms of HTTP, in options of the client.
_IN_OPTIONS = {
    "unauthorized": "the key is missing or not valid: --api-key or QUADPATCH_CLIENT_API_KEY "
    "(`quadpatch-client doctor` looks)"
}

# What would be refused for any other file as well: it lies with the key or the options.
_OF_THE_REQUEST = frozenset(
    {
        "unauthorized",
        "invalid_token",
        "tenant_missing",
        "tenant_disabled",
        "scope_missing",
        "foreign_host",
        "route_not_found",
        "rule_not_found",
        "model_not_found",
        "model_kind_mismatch",
        "model_refused",
        "no_network_registered",
        "over_service_limit",
        "options_conflict",
    }
)


class ClientError(Exception):
    """Base of all errors of the SDK."""


class UnreachableError(ClientError):
    """No answer, however often it was tried."""


class RefusedError(ClientError):
    """The service answered with a problem document."""

    def __init__(self, problem: "Problem") -> None:
        details = "".join(f"; {error.pointer}: {error.message}" for error in problem.errors)
        super().__init__(f"{_IN_OPTIONS.get(problem.code, problem.detail)}{details} ({problem.code})")
        self.problem = problem

    @property
    def concerns_every_file(self) -> bool:
        """Whether the service would refuse the same for any other file: the key or the options are at fault."""
        return self.problem.code in _OF_THE_REQUEST


class AnswerError(ClientError):
    """The service answered something that is not its contract; maybe another program listens there."""


class MeshRejectedError(ClientError):
    """The service could not read the mesh."""

    def __init__(self, problem: "MeshProblem") -> None:
        super().__init__(f"{problem.message} ({problem.code})")
        self.problem = problem


class JobFailedError(ClientError):
    """The job ended without a result."""

    def __init__(self, job: "Job") -> None:
        reason = f"{job.error.message} ({job.error.code})" if job.error else "no reason was given"
        where = f" in stage {job.error.stage}" if job.error and job.error.stage else ""
        super().__init__(f"job {job.id} failed{where}: {reason}")
        self.job = job


class JobCanceledError(ClientError):
    """The job was canceled."""

    def __init__(self, job: "Job") -> None:
        super().__init__(f"job {job.id} was canceled")
        self.job = job


class WaitTimeoutError(ClientError):
    """The job, or the analysis of a mesh, was not done in time."""


class DamagedTransferError(ClientError):
    """Bytes arrived that are not those that were sent."""


class UsageError(ClientError):
    """An option that makes no sense, or a file that can't be read or written."""
