"""What a worker reads out of the queue: a task's name and one id, and nothing else that RQ would act on.

An entry of RQ names functions by their dotted paths: the task, callbacks, an object to call it on. RQ imports and calls
them, so an entry with `os.system` would be a command. Here a name is looked up among the tasks instead. Callbacks,
webhooks, retries and repeats of an entry are left unread, for the same reason; the database decides about retries.

Tested in `tests/attacks/test_f_queue.py`.
"""

import re
from collections.abc import Callable
from typing import Any

from rq.exceptions import NoSuchJobError
from rq.job import Job

from jobkit.queue import INSPECT_MESH, MAKE_VIEW, PROVE_MODEL, RUN_JOB, RUN_SHADOW
from quadpatch_rules.ids import MODEL_NAME, TENANT
from worker.jobs import inspect_mesh, make_view, prove_model, run_job, run_shadow

TASKS: dict[str, Callable[[str], None]] = {
    RUN_JOB: run_job,
    INSPECT_MESH: inspect_mesh,
    PROVE_MODEL: prove_model,
    MAKE_VIEW: make_view,
    RUN_SHADOW: run_shadow,
}
# Of a job, a mesh or a view, or the reference to a version of a model, of a tenant perhaps.
_ID = re.compile(rf"[0-9A-Za-z_-]{{1,100}}|({TENANT}/)?{MODEL_NAME}@[1-9][0-9]{{0,9}}")


class UnknownTaskError(Exception):
    """An entry of the queue asks for something that is no task of a worker."""


class Entry(Job):  # type: ignore[misc]
    """An RQ job whose function is one of `TASKS`, called with one id."""

    @property
    def func(self) -> Callable[[str], None]:
        """Look the task up; nothing is imported.

        Raises
        ------
        UnknownTaskError
            If it is no task of a worker, or its arguments are not one id.
        """
        name, arguments = self.func_name, self.args
        task = TASKS.get(name) if isinstance(name, str) else None
        is_id = isinstance(arguments, list) and len(arguments) == 1 and _ID.fullmatch(str(arguments[0])) is not None
        if task is None or self.instance is not None or self.kwargs or not is_id:
            raise UnknownTaskError("an entry of the queue is no task of a worker")
        return task

    def restore(self, raw_data: Any) -> None:
        """Read what the queue holds, and drop all parts that would call something else.

        Raises
        ------
        NoSuchJobError
            If it can't be read: RQ then takes the next entry, while any other error would end the worker.
        """
        try:
            super().restore(raw_data)
        except (ValueError, TypeError, AttributeError, LookupError, AssertionError) as error:
            raise NoSuchJobError("an entry of the queue can't be read") from error
        self._success_callback_name = self._failure_callback_name = self._stopped_callback_name = None
        self._success_callback = self._failure_callback = self._stopped_callback = None
        self.webhooks: list[Any] = []
        self._dependency_ids: list[str] = []
        self.retries_left = self.repeats_left = None
