from collections.abc import Iterator
from pathlib import Path

import pytest

from worker.engine.client import ForkServer


@pytest.fixture(scope="session")
def rogue_fork_server() -> Iterator[ForkServer]:
    """A fork server whose engines misbehave as they are told to, see rogue_engine."""
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("PYTHONPATH", str(Path(__file__).parent))
        with ForkServer(n_threads=1, engine="rogue_engine") as fork_server:
            yield fork_server
