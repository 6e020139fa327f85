"""The outermost function of an engine child: sets the limits, and turns every exception into a report.

Tested in `tests/worker/engine/test_supervision.py`.
"""

import contextlib
import os
import traceback
from collections.abc import Callable
from pathlib import Path

from quadpatch.errors import ProcessLostError, QuadpatchError
from quadpatch.processes import ProcessPool, n_processes_for
from worker.engine.confinement import confine
from worker.engine.reports import Reporter
from worker.engine.request import MESH_FOLDER, REFERENCE_FOLDER, EngineRequest
from worker.failures import Failure, from_os_error, over_memory

# Called with the request, what takes reports, and the processes that share the work.
Task = Callable[[EngineRequest, Reporter, ProcessPool], None]


def run_confined(folder: Path, descriptor: int, task: Task) -> None:
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
        pool = _fork_pool(folder, request, reporter)
        confine(folder, request)
        task(request, reporter, pool)
        pool.close()
    except ProcessLostError as error:
        _end_likewise(error.status)
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


def _fork_pool(folder: Path, request: EngineRequest, reporter: Reporter) -> ProcessPool:
    """Fork the processes that share a repair; each of them is under the same limits, and confines itself."""

    def prepare() -> None:
        reporter.close()
        confine(folder, request)

    n_processes = n_processes_for(folder / request.source, request.limits.n_processes)
    pool = ProcessPool(n_processes if request.task == "repair" else 1, prepare)
    if pool.is_shared:
        reporter.processes(pool.process_ids)
    return pool


def _end_likewise(status: int) -> None:
    """End this process as the one ended that shared its work: the worker tells from that what happened."""
    if status < 0:
        os.kill(os.getpid(), -status)
    os._exit(status)


def _print_traceback() -> None:
    # The log is on the same disk as the rest: where that is full, the report must be sent even so.
    with contextlib.suppress(OSError):
        traceback.print_exc()


def _without_paths(message: str, folder: Path) -> str:
    """Take the worker's own folder out of a message that goes to a client."""
    for prefix in (folder / MESH_FOLDER, folder / REFERENCE_FOLDER, folder):
        message = message.replace(f"{prefix}{os.sep}", "").replace(str(prefix), "")
    return message
