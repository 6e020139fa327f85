"""A dispatcher in a process of its own, as it runs in a plant."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from jobkit.settings import Settings
from tests.waiting import end


@contextmanager
def dispatching(settings: Settings, **changes: object) -> Iterator[subprocess.Popen[bytes]]:
    values: dict[str, object] = {
        "data_dir": settings.data_dir,
        "database_url": settings.database_url.get_secret_value(),
        "object_store_url": settings.object_store_url,
        "redis_url": settings.redis_url.get_secret_value(),
        "queue_name": settings.queue_name,
        "dispatch_s": 0.1,
        "leader_lease_s": 1,
        **changes,
    }
    named = {f"QUADPATCH_{name.upper()}": str(value) for name, value in values.items()}
    environment = {name: value for name, value in os.environ.items() if not name.startswith("QUADPATCH_")}
    process = subprocess.Popen([sys.executable, "-m", "dispatcher"], env=environment | named)
    try:
        yield process
    finally:
        end(process)
