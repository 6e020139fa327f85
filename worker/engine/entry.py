"""The outermost function of an engine child: sets the limits, and turns every exception into a report."""

import contextlib
import os
import traceback
from collections.abc import Callable
from pathlib import Path

from quadpatch.errors import QuadpatchError
from worker.engine.confinement import confine
from worker.engine.reports import Reporter
from worker.engine.request import MESH_FOLDER, REFERENCE_FOLDER, EngineRequest
from worker.failures import Failure, from_os_error, over_memory


def run_confined(folder: Path, descriptor: int, task: Callable[[EngineRequest, Reporter], None]) -> None:
    """Load the request in `folder`, do the task under its limits and confined, and report how it ended.

    Parameters
    ----------
    folder : Path
    descriptor : int
        Write end of the pipe for reports.
    task : callable
    """
    reporter = Reporter(descriptor)
    request = EngineRequest.load(folder)
    try:
        request.limits.apply()
        confine(folder, request)
        task(request, reporter)
    except QuadpatchError as error:
        reporter.failed(Failure(error.code, _without_paths(str(error), folder), reporter.stage))
    except MemoryError:
        reporter.failed(over_memory(request.limits.memory_mb, reporter.stage))
    except PermissionError:
        # Refused by `worker.engine.confinement`, not by the disk: another attempt would be refused as well.
        _print_traceback()
        reporter.failed(Failure("engine_error", "the engine reached for what is closed to it", reporter.stage))
    except OSError as error:
        _print_traceback()
        reporter.failed(from_os_error(error, reporter.stage))
    except Exception:  # noqa: BLE001 - the outermost handler of an engine: the log gets the traceback
        _print_traceback()
        reporter.failed(Failure("engine_error", "unexpected internal error of the engine", reporter.stage))
    else:
        reporter.done()


def _print_traceback() -> None:
    # The log is on the same disk as the rest: where that is full, the report must be sent even so.
    with contextlib.suppress(OSError):
        traceback.print_exc()


def _without_paths(message: str, folder: Path) -> str:
    """Take the worker's own folder out of a message that goes to a client."""
    for prefix in (folder / MESH_FOLDER, folder / REFERENCE_FOLDER, folder):
        message = message.replace(f"{prefix}{os.sep}", "").replace(str(prefix), "")
    return message
