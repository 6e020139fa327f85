import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from quadpatch.processes import LEAST_BYTES
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched, write_ply
from worker.engine.client import ForkServer
from worker.engine.limits import EngineLimits
from worker.engine.request import MESH_FOLDER, REPORT_NAME, EngineRequest
from worker.engine.supervision import Observer, run_engine
from worker.failures import EngineFailedError

LIMITS = EngineLimits(time_s=300.0, memory_mb=4096, n_threads=1)


@pytest.fixture(scope="module")
def fork_server(unlearned_models: Path) -> Iterator[ForkServer]:
    """Of a worker that was installed without torch."""
    with pytest.MonkeyPatch.context() as environment:
        # What it names is a library, which engines may read.
        environment.setenv("PYTHONPATH", f"{Path(__file__).parents[1]}:{unlearned_models}")
        with ForkServer(n_threads=1, engine="engine_without_torch") as fork_server:
            yield fork_server


def repair_request(folder: Path, model: str) -> EngineRequest:
    """A plate with a hole, and a request to repair it."""
    (folder / MESH_FOLDER).mkdir()
    write_ply(folder / MESH_FOLDER / "source.ply", punched(bumpy_plate(40, 2.0), (0, 0, 0), radius=0.2))
    return EngineRequest(
        task="repair", source=f"{MESH_FOLDER}/source.ply", output="repaired.ply", model=model, limits=LIMITS
    )


def test_engines_of_one_process_and_of_two_write_the_same_bytes(fork_server: ForkServer, tmp_path: Path) -> None:
    at, plate = np.arange(-1.5, 1.51, 0.6), bumpy_plate(160, 4.0)
    holes = on_surface(plate, *((float(x), float(y)) for x in at for y in at))
    written: list[bytes] = []
    fractions: list[float] = []
    for n_processes in (1, 2):
        folder = tmp_path / str(n_processes)
        (folder / MESH_FOLDER).mkdir(parents=True)
        source = write_ply(folder / MESH_FOLDER / "source.ply", punched(plate, *holes, radius=0.18), "f8")
        assert source.stat().st_size > LEAST_BYTES
        limits = replace(LIMITS, n_processes=n_processes)
        request = EngineRequest("repair", f"{MESH_FOLDER}/source.ply", limits, "repaired.ply", "smooth")
        fractions.clear()
        run_engine(fork_server, request, folder, Observer(lambda _, done: fractions.append(done), lambda: None))
        assert any(0 < fraction < 1 for fraction in fractions)
        written.append((folder / "repaired.ply").read_bytes())
    assert written[0] == written[1]


def test_a_worker_without_torch_fails_a_job_that_needs_it_for_good_and_says_how_to_install_it(
    fork_server: ForkServer, tmp_path: Path
) -> None:
    heard: list[str] = []
    observer = Observer(lambda stage, fraction: heard.append(stage), lambda: None)
    with pytest.raises(EngineFailedError) as caught:
        run_engine(fork_server, repair_request(tmp_path, "self-network"), tmp_path, observer)
    failure = caught.value.failure
    assert (failure.code, failure.retryable) == ("torch_missing", False)
    assert "install the extra 'networks'" in failure.message
    # Before any work is done.
    assert heard == []
    assert not (tmp_path / "repaired.ply").exists()


def test_a_worker_without_torch_goes_on_where_all_that_can_be_tried_is_asked_for(
    fork_server: ForkServer, tmp_path: Path
) -> None:
    request = replace(repair_request(tmp_path, "auto"), options={"effort": "best"})
    run_engine(fork_server, request, tmp_path, Observer(lambda stage, fraction: None, lambda: None))
    model = json.loads((tmp_path / REPORT_NAME).read_text())["model"]
    assert (model["effort"], list(model["not_tried"])) == ("best", ["self-network"])
    assert (tmp_path / "repaired.ply").is_file()


def test_a_worker_without_torch_runs_networks_that_are_ready(fork_server: ForkServer, tmp_path: Path) -> None:
    request = repair_request(tmp_path, "general-residual@1")
    run_engine(fork_server, request, tmp_path, Observer(lambda stage, fraction: None, lambda: None))
    assert json.loads((tmp_path / REPORT_NAME).read_text())["model"]["kind"] == "autoencoder"
    assert (tmp_path / "repaired.ply").is_file()
