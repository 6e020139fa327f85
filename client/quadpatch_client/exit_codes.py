"""Exit codes of the command line, for scripts to rely on.

Tested in `tests/quadpatch_client/test_keeping.py`.
"""

import re
from enum import IntEnum

from quadpatch_client.errors import (
    ClientError,
    JobCanceledError,
    JobFailedError,
    MeshRejectedError,
    RefusedError,
    UnreachableError,
    UsageError,
    WaitTimeoutError,
)

_SERVER_ERROR = 500


class ExitCode(IntEnum):
    """The exit code of the command line."""

    OK = 0
    JOB_FAILED = 1
    USAGE = 2
    UNREACHABLE = 3
    REJECTED = 4
    CANCELED = 5
    OTHER = 6
    INTERRUPTED = 130


MEANINGS = {
    ExitCode.OK: "done; with warnings, too",
    ExitCode.JOB_FAILED: "the job failed",
    ExitCode.USAGE: "the command line is wrong, or a file can't be read or written",
    ExitCode.UNREACHABLE: "the service does not answer",
    ExitCode.REJECTED: "the service rejected the mesh or the request; the message ends with its code",
    ExitCode.CANCELED: "the job was canceled, or was not done by --timeout",
    ExitCode.OTHER: "the service failed, or answered something that is not its contract",
    ExitCode.INTERRUPTED: "Ctrl-C; `repair` has canceled its job",
}


def exit_codes_text() -> str:
    """Return the table of exit codes for --help."""
    return "\n\n".join(f"{code.value}: {meaning}" for code, meaning in MEANINGS.items())


def exit_code_of(error: ClientError) -> ExitCode:
    """Return the exit code of an error."""
    if isinstance(error, RefusedError):
        return ExitCode.OTHER if error.problem.status >= _SERVER_ERROR else ExitCode.REJECTED
    by_class: dict[type[ClientError], ExitCode] = {
        JobFailedError: ExitCode.JOB_FAILED,
        UsageError: ExitCode.USAGE,
        UnreachableError: ExitCode.UNREACHABLE,
        MeshRejectedError: ExitCode.REJECTED,
        JobCanceledError: ExitCode.CANCELED,
        WaitTimeoutError: ExitCode.CANCELED,
    }
    return by_class.get(type(error), ExitCode.OTHER)


def error_code(error: ClientError) -> str:
    """Return the stable code of an error, for scripts: that of the service or of the job, where one said it."""
    if isinstance(error, RefusedError | MeshRejectedError):
        return error.problem.code
    if isinstance(error, JobFailedError) and error.job.error is not None:
        return error.job.error.code
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", type(error).__name__.removesuffix("Error")).lower()
