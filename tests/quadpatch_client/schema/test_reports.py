"""Real reports, held to the models that describe them.

Also tests `quadpatch_client/schema/report_parts.py`, `quadpatch_client/schema/task_reports.py` and
`quadpatch_client/schema/training_reports.py`.
"""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import BaseModel, TypeAdapter, ValidationError

from quadpatch.compression.encode import EncodeOptions
from quadpatch.repair import repair_file
from quadpatch.tasks.decode import decode_file
from quadpatch.tasks.denoise import denoise_file
from quadpatch.tasks.encode import encode_file
from quadpatch.tasks.restore import restore_file
from quadpatch.types import TriangleMesh
from quadpatch_client.schema.reports import Report
from tests.quadpatch.formats.coloured_files import coloured_ply
from tests.quadpatch.formats.textured_files import write_obj
from tests.quadpatch.html_report.pages import repaired_with_page
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched, relief, sphere, write_ply
from tests.quadpatch.test_repair_by_effort import SCAN
from tests.quadpatch.test_textured_fill import RAMPED
from training.requested import TrainingOptions, train_dictionary
from training.sources import Source

REPORT: TypeAdapter[BaseModel] = TypeAdapter(Report)
RELIEF = relief(40)


def holed(folder: Path) -> Path:
    return write_ply(folder / "in.ply", punched(RELIEF, *on_surface(RELIEF, (0.4, 0.4), (-0.4, -0.3)), radius=0.2))


def filled(model: str) -> Callable[[Path], dict[str, Any]]:
    return lambda folder: repair_file(holed(folder), folder / "out.ply", model)


def coloured(folder: Path) -> dict[str, Any]:
    colours = np.full((len(RELIEF.vertices), 3), 90.0)
    mesh = punched(RELIEF, *on_surface(RELIEF, (0.4, 0.4)), radius=0.2)
    source = folder / "in.ply"
    source.write_bytes(coloured_ply(mesh, colours))
    return repair_file(source, folder / "out.ply", "smooth")


def textured(folder: Path) -> dict[str, Any]:
    return repair_file(write_obj(folder, RAMPED), folder / "out.obj", "smooth")


def restored(folder: Path) -> dict[str, Any]:
    ball = sphere(4)
    vertices = np.array(ball.vertices)
    vertices[::7] = np.nan
    source = write_ply(folder / "in.ply", TriangleMesh(vertices, ball.triangles))
    return restore_file(source, folder / "out.ply").report


def denoised(folder: Path) -> dict[str, Any]:
    return denoise_file(write_ply(folder / "in.ply", RELIEF), folder / "out.ply").report


def encoded(*, keep_connectivity: bool) -> Callable[[Path], dict[str, Any]]:
    options = EncodeOptions(0.02, keep_connectivity=keep_connectivity)
    return lambda folder: (
        encode_file(write_ply(folder / "in.ply", sphere(3)), folder / "out.qpz", options=options).report
    )


def decoded(folder: Path) -> dict[str, Any]:
    encoded(keep_connectivity=False)(folder)
    return decode_file(folder / "out.qpz", folder / "out.ply").report


def trained(folder: Path) -> dict[str, Any]:
    meshes = [
        Source(letter * 64, write_ply(folder / f"{letter}.ply", bumpy_plate(50, 1.0, i)), letter * 64)
        for i, letter in enumerate("ab")
    ]
    return train_dictionary(meshes, folder / "learned.safetensors", TrainingOptions("plates", 8, 8, 1, 0.5))


def with_page(folder: Path) -> dict[str, Any]:
    """A repair that was asked for as a page too: its report has a provenance."""
    job = {"job_id": "job_1", "tenant": "default", "request_id": None}
    asked = {**job, "label": "a", "metadata": {"order": "A-17"}, "rule": "castings@2"}
    return repaired_with_page(write_ply(folder / "in.ply", SCAN), folder / "report.html", asked, "auto").report


MAKERS: Mapping[str, Callable[[Path], dict[str, Any]]] = {
    "smooth": filled("smooth"),
    "self": filled("self"),
    "auto": filled("auto"),
    "coloured": coloured,
    "with a page": with_page,
    "textured": textured,
    "restore": restored,
    "denoise": denoised,
    "encode": encoded(keep_connectivity=False),
    "encode with connectivity": encoded(keep_connectivity=True),
    "decode": decoded,
    "train": trained,
}


def undescribed(value: Any, described: Any, path: str = "") -> Iterator[str]:
    """Paths of the fields that a report has and its model has not."""
    if isinstance(described, BaseModel):
        names = {field.alias or name: name for name, field in type(described).model_fields.items()}
        for name, item in value.items():
            if name in names:
                yield from undescribed(item, getattr(described, names[name]), f"{path}/{name}")
            else:
                yield f"{path}/{name}"
    elif isinstance(described, list):
        for item, one in zip(value, described, strict=True):
            yield from undescribed(item, one, path)


@pytest.mark.parametrize("name", MAKERS)
def test_the_model_describes_every_field_of_a_real_report(name: str, tmp_path: Path) -> None:
    report = MAKERS[name](tmp_path)
    described = REPORT.validate_python(report, strict=True)
    assert described.model_dump()["task"] == report["task"]
    assert list(undescribed(report, described)) == []


def test_a_field_of_the_wrong_type_is_found(tmp_path: Path) -> None:
    report = decoded(tmp_path)
    with pytest.raises(ValidationError):
        REPORT.validate_python({**report, "max_error": "small"}, strict=True)
    assert list(undescribed({**report, "new": 1}, REPORT.validate_python(report))) == ["/new"]
