"""Letter F: an engine that was taken over reaches its folder, its mesh and its libraries, and nothing else.

Also tests `worker.engine.landlock` and `worker.engine.seccomp`.
"""

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from quadpatch.processes import LEAST_BYTES
from tests.waiting import GUARD_S
from tests.worker import reaching_out
from worker.engine.client import ForkServer
from worker.engine.confinement import weaknesses
from worker.engine.limits import EngineLimits
from worker.engine.request import EngineRequest
from worker.engine.supervision import Observer, run_engine

LIMITS = EngineLimits(time_s=GUARD_S, memory_mb=1024, n_threads=1, n_processes=2)


@pytest.fixture(scope="module", params=[False, True], ids=["engine", "helper"])
def reached(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, bool]]:
    """What such an engine got through with, or a process that shares its work."""
    if weaknesses():
        pytest.skip(f"this kernel has {', '.join(weaknesses())}")
    outside = tmp_path_factory.mktemp("outside")
    folder = outside / "request"
    folder.mkdir()
    (outside / "secret").write_text("hunter2")
    (outside / "object").write_bytes(bytes(LEAST_BYTES))
    (folder / "source.ply").symlink_to(outside / "object")
    (folder / "worker.pid").write_text(str(os.getpid()))
    options = {"behaviour": "reach_out", "in_helper": request.param}
    asked = EngineRequest("repair", "source.ply", LIMITS, options=options)
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("PYTHONPATH", str(Path(reaching_out.__file__).parent))
        with ForkServer(n_threads=1, engine="rogue_engine") as fork_server:
            run_engine(fork_server, asked, folder, Observer(lambda stage, fraction: None, lambda: None))
    yield json.loads((folder / "reached.json").read_text())
    assert (outside / "secret").read_text() == "hunter2"


@pytest.mark.parametrize("attempt", reaching_out.FORBIDDEN)
def test_an_engine_cannot(reached: dict[str, bool], attempt: str) -> None:
    assert not reached[attempt]


@pytest.mark.parametrize("attempt", reaching_out.ALLOWED)
def test_an_engine_can_still(reached: dict[str, bool], attempt: str) -> None:
    """Without this the test above would pass for an engine that can do nothing at all."""
    assert reached[attempt]
