"""Everything that can end an attempt without a result, as a code and a sentence.

Nothing above this module sees a traceback: clients get `{code, message, stage, retryable}`, the log gets the rest.

::

    EngineFailedError           the attempt failed; `failure` says why
    EngineStoppedError          the parent wanted it to end; `reason` says why

Codes made here, besides those of `quadpatch.errors`, which pass through:

    out_of_memory               more memory than the limit
    time_limit_exceeded         more wall-clock time than the limit
    engine_crashed              the engine was ended by a signal, or without a report; another attempt may succeed
    engine_error                unexpected internal error
    no_space                    the disk of the worker is full; the attempt is not counted
    disk_error                  the disk of the worker can't be used; the attempt is not counted
    store_unavailable           the object store can't be read or written; the attempt is not counted
    mesh_missing                the mesh is gone from the store
    mesh_damaged                the bytes of the mesh in the store are not those that were uploaded
    model_missing               the model is gone from the registry or the store
    model_damaged               the bytes of the model are not those that were published
    result_too_large            a file of the result is over the limit
    acceptance_not_met          holes do not meet the limits of the spec, which says that the job fails then

Tested in `tests/worker/engine/test_supervision.py`.
"""

import enum
import errno
from dataclasses import dataclass

from quadpatch_rules.text import printable

_LONGEST_CODE = 64
# A full disk or an unavailable store takes a while to recover, by itself or by an operator: no need to retry at once.
OUTAGE_DELAY_S = 10.0
_BROKEN_DISK = (errno.EIO, errno.EROFS, errno.EACCES, errno.EPERM, errno.ESTALE, errno.EMFILE, errno.ENFILE)


class StopReason(enum.Enum):
    """Why a parent ends its engine."""

    CANCELED = "canceled"
    DRAINED = "drained"
    LOST = "lost"  # the attempt belongs to another worker by now


@dataclass(frozen=True)
class Failure:
    """Why an attempt failed.

    Attributes
    ----------
    code : str
        Stable.
    message : str
        A sentence for people.
    stage : str or None
        Of the method.
    retryable : bool
        Whether another attempt may succeed.
    is_outside : bool
        Whether the reason lies outside of the job: then the attempt is not counted, and the next one waits a while.
    """

    code: str
    message: str
    stage: str | None = None
    retryable: bool = False
    is_outside: bool = False

    def __post_init__(self) -> None:
        """Make code and message, which may hold text of a file, safe to print."""
        object.__setattr__(self, "code", printable(self.code, _LONGEST_CODE))
        object.__setattr__(self, "message", printable(self.message))


class EngineFailedError(Exception):
    """The engine ended without a result."""

    def __init__(self, failure: Failure) -> None:
        super().__init__(f"{failure.code}: {failure.message}")
        self.failure = failure


class EngineStoppedError(Exception):
    """The engine was ended on purpose."""

    def __init__(self, reason: StopReason) -> None:
        super().__init__(reason.value)
        self.reason = reason


def over_time(limit_s: float, stage: str | None) -> Failure:
    """Describe an engine that was ended at its time limit."""
    return Failure("time_limit_exceeded", f"the work took longer than the limit of {limit_s:g} s", stage)


def over_memory(limit_mb: int, stage: str | None) -> Failure:
    """Describe an engine that wanted more memory than its limit."""
    return Failure("out_of_memory", f"the work needs more memory than the limit of {limit_mb} MiB", stage)


def crashed(signal_name: str | None, stage: str | None) -> Failure:
    """Describe an engine that ended without a report."""
    manner = f"was ended by {signal_name}" if signal_name else "ended without a word"
    return Failure("engine_crashed", f"the engine {manner}", stage, retryable=True)


def store_unavailable() -> Failure:
    """Describe a store that does not work now."""
    message = "the object store can't be read or written"
    return Failure("store_unavailable", message, retryable=True, is_outside=True)


def from_os_error(error: OSError, stage: str | None) -> Failure:
    """Describe an operating system error; paths stay out of the message.

    A disk that is full, read-only or broken is no fault of the job: another worker may do it, or this one later.
    """
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return Failure("no_space", "the worker has no disk space left", stage, retryable=True, is_outside=True)
    if error.errno in _BROKEN_DISK:
        return Failure(
            "disk_error", f"the worker's disk failed: {error.strerror}", stage, retryable=True, is_outside=True
        )
    if error.errno == errno.EFBIG:
        return Failure("result_too_large", "a file of the result is larger than the limit", stage)
    return Failure("engine_error", f"the worker could not read or write a file: {error.strerror}", stage)
