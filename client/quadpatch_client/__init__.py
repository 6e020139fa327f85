"""Client of Quadpatch, a service that repairs holes in 3D scans: SDK and command line.

What programs need is imported from here: `from quadpatch_client import Client, JobSpec`. It is loaded on first use: the
service takes the wire schema from this package, and loads no HTTP client with it.

Tested in `tests/integration/test_client_alone.py`.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quadpatch_client.async_sdk import AsyncClient, AsyncJobHandle
    from quadpatch_client.errors import (
        AnswerError,
        ClientError,
        DamagedTransferError,
        JobCanceledError,
        JobFailedError,
        MeshRejectedError,
        RefusedError,
        UnreachableError,
        UsageError,
        WaitTimeoutError,
    )
    from quadpatch_client.handles import JobHandle
    from quadpatch_client.schema import Job, JobSpec, JobState, Mesh, Plan
    from quadpatch_client.sdk import Client

_ERRORS = (
    "AnswerError",
    "ClientError",
    "DamagedTransferError",
    "JobCanceledError",
    "JobFailedError",
    "MeshRejectedError",
    "RefusedError",
    "UnreachableError",
    "UsageError",
    "WaitTimeoutError",
)
_MODULES = {
    **dict.fromkeys(_ERRORS, "errors"),
    **dict.fromkeys(("Job", "JobSpec", "JobState", "Mesh", "Plan"), "schema"),
    **dict.fromkeys(("AsyncClient", "AsyncJobHandle"), "async_sdk"),
    "Client": "sdk",
    "JobHandle": "handles",
}
__all__ = [
    "AnswerError",
    "AsyncClient",
    "AsyncJobHandle",
    "Client",
    "ClientError",
    "DamagedTransferError",
    "Job",
    "JobCanceledError",
    "JobFailedError",
    "JobHandle",
    "JobSpec",
    "JobState",
    "Mesh",
    "MeshRejectedError",
    "Plan",
    "RefusedError",
    "UnreachableError",
    "UsageError",
    "WaitTimeoutError",
]


def __getattr__(name: str) -> object:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
    globals()[name] = value
    return value
