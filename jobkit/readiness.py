"""A file that exists as long as a worker can take tasks, for launchers and health checks."""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

READY_FILE_VARIABLE = "READY_FILE"


@contextmanager
def ready_file(environment: Mapping[str, str] = os.environ) -> Iterator[None]:
    """Let the file that the environment names exist for the length of a `with` block; nothing where it names none."""
    name = environment.get(READY_FILE_VARIABLE)
    if not name:
        yield
        return
    path = Path(name)
    path.write_text(str(os.getpid()), encoding="ascii")
    try:
        yield
    finally:
        path.unlink(missing_ok=True)
