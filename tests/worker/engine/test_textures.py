"""Texture images in a confined engine."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.quadpatch.formats.textured_files import encoded, flat, write_3mf, write_glb, write_gltf, write_obj
from tests.quadpatch.shapes import bumpy_plate, punched
from worker.engine.client import ForkServer
from worker.engine.limits import EngineLimits
from worker.engine.request import MESH_FOLDER, REPORT_NAME, EngineRequest
from worker.engine.supervision import Observer, run_engine

LIMITS = EngineLimits(time_s=300.0, memory_mb=4096, n_threads=1)
PLATE = punched(bumpy_plate(24, 2.0), (0, 0, 0), radius=0.2)
GREY = np.full((32, 32, 3), 180, np.uint8)


@pytest.fixture(scope="module")
def fork_server() -> Iterator[ForkServer]:
    with ForkServer(n_threads=1) as fork_server:
        yield fork_server


def report_of(fork_server: ForkServer, folder: Path, source: Path, output: str) -> dict[str, Any]:
    request = EngineRequest(
        task="repair",
        source=f"{MESH_FOLDER}/{source.name}",
        output=output,
        model="smooth",
        options={"colours": "harmonic"},
        limits=LIMITS,
    )
    run_engine(fork_server, request, folder, Observer(lambda stage, fraction: None, lambda: None))
    report: dict[str, Any] = json.loads((folder / REPORT_NAME).read_text())
    return report


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP", "TIFF", "BMP"])
def test_images_in_a_mesh_are_carried_on(fork_server: ForkServer, tmp_path: Path, kind: str) -> None:
    (tmp_path / MESH_FOLDER).mkdir()
    source = write_glb(tmp_path / MESH_FOLDER, flat(PLATE, encoded(GREY, kind)))
    report = report_of(fork_server, tmp_path, source, "repaired.glb")
    assert report["texture"]["page"] is not None
    assert report["warnings"] == []


def test_a_package_is_carried_on_as_well(fork_server: ForkServer, tmp_path: Path) -> None:
    (tmp_path / MESH_FOLDER).mkdir()
    source = write_3mf(tmp_path / MESH_FOLDER, flat(PLATE, encoded(GREY)))
    assert report_of(fork_server, tmp_path, source, "repaired.3mf")["texture"]["page"] is not None


@pytest.mark.parametrize(("write", "name"), [(write_obj, "repaired.obj"), (write_gltf, "repaired.glb")])
def test_images_that_did_not_come_along_are_a_warning(
    fork_server: ForkServer, tmp_path: Path, write: Any, name: str
) -> None:
    (tmp_path / MESH_FOLDER).mkdir()
    source = write(tmp_path / MESH_FOLDER, flat(PLATE, encoded(GREY)))
    for beside in {*source.parent.iterdir()} - {source}:
        beside.unlink()
    report = report_of(fork_server, tmp_path, source, name)
    assert [problem["code"] for problem in report["texture"]["problems"]] == ["image_missing"]
    assert (tmp_path / name).is_file()
