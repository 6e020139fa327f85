"""`python -m worker`: take tasks from the queue until SIGTERM.

Settings come from the environment, see `jobkit.settings`; READY_FILE names a file that exists while the worker
can take tasks. The first SIGTERM or SIGINT drains: a task that is nearly
done is finished, another one is handed back to the queue.

Tested in `tests/worker/test_executor.py`.
"""

import logging
import os
import sys
from contextlib import ExitStack, closing

from jobkit.database.quotas import default_quotas
from jobkit.database.session import Database
from jobkit.errors import SettingsError
from jobkit.logs import log_about, set_up_logs
from jobkit.privacy import hide_memory
from jobkit.queue import TaskQueue
from jobkit.readiness import ready_file
from jobkit.settings import Settings, load_settings
from jobkit.storage.base import ObjectStore
from jobkit.storage.open import open_store
from jobkit.telemetry import open_telemetry
from quadpatch.processes import usable_threads
from worker.abilities import abilities
from worker.context import Context, use_context, worker_name
from worker.engine.client import ForkServer, ForkServerLostError
from worker.engine.confinement import weaknesses
from worker.executor import execute
from worker.folders import worker_folder

_EXIT_BROKEN = 1
_EXIT_SETTINGS = 2


def main() -> int:
    """Run one worker; returns the exit code."""
    hide_memory()
    try:
        settings = load_settings()
        store = open_store(settings.effective_object_store_url, settings.scratch_dir)
    except SettingsError as error:
        sys.stderr.write(f"worker: {error}\n")
        return _EXIT_SETTINGS
    set_up_logs(settings)
    for weakness in weaknesses():
        logging.warning("this kernel has %s", weakness)
    return _run(settings, store)


def _run(settings: Settings, store: ObjectStore) -> int:
    n_threads = usable_threads()
    with ExitStack() as stack:
        database = stack.enter_context(closing(Database(settings.effective_database_url)))
        database = database.limited(default_quotas(settings))
        database.migrate()
        context = Context(
            name=worker_name(os.getpid()),
            settings=settings,
            database=database,
            store=store,
            queue=stack.enter_context(closing(_open_queue(settings))),
            fork_server=stack.enter_context(ForkServer(n_threads)),
            n_threads=n_threads,
            n_processes=settings.job_processes or n_threads,
            telemetry=stack.enter_context(open_telemetry("worker")),
            abilities=abilities(),
        )
        stack.enter_context(log_about(worker=context.name))
        stack.enter_context(worker_folder(context.work_folder))
        stack.enter_context(use_context(context))
        try:
            context.fork_server.start()
        except ForkServerLostError as error:
            # A worker that can't work takes no job: each would cost it an attempt.
            logging.critical("%s", error)
            return _EXIT_BROKEN
        context.admission.refresh()
        stack.enter_context(ready_file())
        level = settings.log_level.upper()
        execute(context.queue, settings.queue_name, context.name, context.draining, level, context.abilities)
    return 0


def _open_queue(settings: Settings) -> TaskQueue:
    return TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, settings.job_time_limit_s)


if __name__ == "__main__":
    sys.exit(main())
