"""`python -m dispatcher`: keep every accepted job going until SIGTERM.

Any number may run, on any host; one leads, the others stand by. READY_FILE names a file that exists while it runs.
"""

import os
import secrets
import signal
import socket
import sys
from contextlib import ExitStack, closing

from dispatcher.loop import Dispatch
from dispatcher.periodic_tasks import periodic_tasks
from jobkit.database.leadership import DISPATCHER, Leadership
from jobkit.database.quotas import default_quotas
from jobkit.database.session import Database
from jobkit.errors import SettingsError
from jobkit.logs import set_up_logs
from jobkit.privacy import hide_memory
from jobkit.queue import TaskQueue
from jobkit.readiness import ready_file
from jobkit.settings import Settings, load_settings
from jobkit.storage.base import ObjectStore
from jobkit.storage.open import open_store

_EXIT_SETTINGS = 2
_RENEWALS_PER_LEASE = 3


def main() -> int:
    """Run one dispatcher; returns the exit code."""
    hide_memory()
    try:
        settings = load_settings()
        store = open_store(settings.effective_object_store_url, settings.scratch_dir)
    except SettingsError as error:
        sys.stderr.write(f"dispatcher: {error}\n")
        return _EXIT_SETTINGS
    set_up_logs(settings)
    _run(settings, store)
    return 0


def _run(settings: Settings, store: ObjectStore) -> None:
    with ExitStack() as stack:
        database = stack.enter_context(closing(Database(settings.effective_database_url)))
        database = database.limited(default_quotas(settings))
        database.migrate()
        redis_url = settings.redis_url.get_secret_value()
        queue = stack.enter_context(closing(TaskQueue(redis_url, settings.queue_name, settings.job_time_limit_s)))
        leadership = Leadership(database, DISPATCHER, _own_name(), settings.leader_lease_s)
        tasks = periodic_tasks(settings, database, store, queue, leadership)
        dispatch = Dispatch(leadership, settings.leader_lease_s / _RENEWALS_PER_LEASE, tasks)
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, lambda *_: dispatch.stop())
        stack.enter_context(ready_file())
        dispatch.run()


def _own_name() -> str:
    return f"{socket.gethostname()}-{os.getpid()}-{secrets.token_hex(3)}"


if __name__ == "__main__":
    sys.exit(main())
