from collections.abc import Iterator
from pathlib import Path

import pytest

from worker.engine.client import Nursery


@pytest.fixture(scope="session")
def rogue_nursery() -> Iterator[Nursery]:
    """A nursery whose engines misbehave as they are told to, see rogue_engine."""
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("PYTHONPATH", str(Path(__file__).parent))
        with Nursery(n_threads=1, engine="rogue_engine") as nursery:
            yield nursery
