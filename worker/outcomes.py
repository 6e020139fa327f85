"""How a task ended: with a value, a failure, or because it was asked to end.

Tested in `tests/worker/test_repairs.py`.
"""

import logging
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TypeVar

from jobkit.errors import NotFoundError, ObjectDamagedError, StoreUnavailableError
from jobkit.meshes import MESH_DAMAGED, MeshSource
from jobkit.storage.digests import verified_file
from worker.context import Context
from worker.engine.request import MESH_FOLDER, REFERENCE_FOLDER
from worker.failures import (
    EngineFailedError,
    EngineStoppedError,
    Failure,
    StopReason,
    from_os_error,
    store_unavailable,
)
from worker.folders import request_folder
from worker.spec import source_name

T = TypeVar("T")

_log = logging.getLogger("quadpatch.worker")


def outcome_of(work: Callable[[], T], subject: str) -> T | Failure | StopReason:
    """Do the work; an error becomes a failure, and its traceback stays in the log.

    Parameters
    ----------
    work : callable
    subject : str
        What is worked on, for the log.
    """
    try:
        return work()
    except EngineFailedError as error:
        _log.warning("%s: %s", subject, error)
        return error.failure
    except EngineStoppedError as error:
        return error.reason
    except StoreUnavailableError:
        _log.warning("%s: the store does not work", subject, exc_info=True)
        return store_unavailable()
    except OSError as error:
        _log.warning("%s failed", subject, exc_info=True)
        return from_os_error(error, None)
    except Exception:  # noqa: BLE001 - the outermost handler of a task: the client gets a code, the log the traceback
        _log.exception("%s failed", subject)
        return Failure("engine_error", "unexpected internal error of the worker")


@contextmanager
def folder_with_mesh(context: Context, source: MeshSource, reference: MeshSource | None = None) -> Iterator[Path]:
    """Make the folder of a request with the mesh in it, and its reference, under names that state their formats.

    Raises
    ------
    EngineFailedError
        If a mesh is gone from the store, or its bytes are not those that were uploaded.
    """
    with request_folder(context.work_folder) as folder, ExitStack() as files:
        files.enter_context(linked(context, source, folder, MESH_FOLDER, "the mesh"))
        if reference is not None:
            files.enter_context(linked(context, reference, folder, REFERENCE_FOLDER, "the reference mesh"))
        yield folder


@contextmanager
def linked(context: Context, source: MeshSource, folder: Path, subfolder: str, name: str) -> Iterator[None]:
    """Link the verified file of a mesh into a folder of its own; `name` is for people."""
    try:
        with verified_file(context.store, source.key, source.sha256) as path:
            (folder / subfolder).mkdir()
            (folder / source_name(source, subfolder)).symlink_to(path)
            yield
    except NotFoundError as error:
        raise EngineFailedError(Failure("mesh_missing", f"{name} is gone from the store")) from error
    except ObjectDamagedError as error:
        message = f"the bytes of {name} in the store are not those that were uploaded; upload it again"
        raise EngineFailedError(Failure(MESH_DAMAGED, message)) from error
