"""Views of files, and of repairs in all formats."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.errors import EmptyMeshError, ReadError
from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.writing import write_scan
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_file
from quadpatch.types import TriangleMesh
from quadpatch.views.surfaces import LEVELS, LevelName, Repaired, write_mesh_view, write_repair_view
from tests.quadpatch.shapes import bumpy_plate, moved, on_surface, open_grid, punched, sphere, write_ply
from tests.quadpatch.views.test_glb import attribute, extras, loaded

PLATE = bumpy_plate(70, 4.0)
SCAN = punched(PLATE, *on_surface(PLATE, (-1.0, -1.0), (0.9, 0.2)), radius=0.25)
NO_FILL = Fill(
    np.zeros((0, 3)),
    np.zeros((0, 3), np.int64),
    *(np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.int64), np.zeros(0)),
)


def write_as(path: Path, mesh: TriangleMesh) -> Path:
    write_scan(path, Scan(mesh.vertices, mesh.triangles, "mesh"), NO_FILL)
    return path


def repaired_as(folder: Path, source: str, result: str, options: RepairOptions | None = None) -> Repaired:
    scan = write_as(folder / f"scan.{source}", SCAN)
    report = repair_file(scan, folder / f"repaired.{result}", "smooth", options)
    (folder / "report.json").write_text(json.dumps(report))
    return Repaired(folder / f"repaired.{result}", folder / "report.json", scan)


@pytest.mark.parametrize(
    ("source", "result"),
    [
        *((name, name) for name in ("ply", "stl", "obj", "off", "glb", "3mf")),
        *(("ply", "glb"), ("stl", "ply"), ("ply", "3mf")),
    ],
)
def test_invented_surface_is_told_apart_in_every_format(tmp_path: Path, source: str, result: str) -> None:
    options = None if source in ("glb", "3mf") else RepairOptions(length_unit="millimeter")
    repaired = repaired_as(tmp_path, source, result, options)
    write_repair_view(repaired, tmp_path / "view.glb", "coarse")
    file = loaded((tmp_path / "view.glb").read_bytes())
    assert [node["name"] for node in file.document["nodes"]] == ["measured", "invented"]
    report = json.loads(repaired.report.read_text())
    filled = {row["id"]: row for row in report["holes"] if row["new_triangles"]}
    assert len(filled) == 2
    n_invented = file.document["accessors"][file.document["meshes"][1]["primitives"][0]["indices"]]["count"] // 3
    assert n_invented == sum(row["new_triangles"] for row in filled.values())
    holes = attribute(file, 1, "_HOLE_ID")[:, 0]
    places = attribute(file, 1, "POSITION") + extras(file)["origin"]
    for id_, row in filled.items():
        assert np.linalg.norm(places[holes == id_] - row["centre"], axis=1).max() < row["diameter"]
        for name, key in (("_CONFIDENCE", "confidence"), ("_EXPECTED_ERROR", "expected_error")):
            assert np.allclose(attribute(file, 1, name)[holes == id_, 0], row[key])
    assert (attribute(file, 1, "_DISTANCE_TO_PLAIN_FILL") == 0).all()
    assert extras(file)["length_unit"] == report["length_unit"]


def test_a_model_moves_a_fill_by_what_the_report_says(tmp_path: Path) -> None:
    repaired = repaired_as(tmp_path, "ply", "ply")
    report = json.loads(repaired.report.read_text())
    row = next(row for row in report["holes"] if row["new_triangles"])
    row["verdict"], row["measures"]["departure"] = "filled", 0.25
    repaired.report.write_text(json.dumps(report))
    write_repair_view(repaired, tmp_path / "view.glb", "coarse")
    file = loaded((tmp_path / "view.glb").read_bytes())
    is_moved = attribute(file, 1, "_HOLE_ID") == row["id"]
    assert np.array_equal(attribute(file, 1, "_DISTANCE_TO_PLAIN_FILL"), np.where(is_moved, 0.25, 0.0))


def test_distances_to_a_reference_stand_at_every_vertex(tmp_path: Path) -> None:
    repaired = repaired_as(tmp_path, "ply", "ply")
    reference = write_ply(tmp_path / "reference.ply", moved(PLATE, (0.0, 0.0, 50.0)))
    write_repair_view(repaired, tmp_path / "view.glb", "coarse", reference)
    file = loaded((tmp_path / "view.glb").read_bytes())
    for part in (0, 1):
        assert np.abs(attribute(file, part, "_DISTANCE_TO_REFERENCE") - 50.0).max() < 0.5
    assert set(extras(file)["ranges"]) >= {"_DISTANCE_TO_REFERENCE", "_CONFIDENCE"}


def test_a_task_without_holes_shows_one_surface(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "clean.ply", PLATE)
    report = {"task": "denoise", "length_unit": "mesh units", "source": {"format": "ply"}}
    (tmp_path / "report.json").write_text(json.dumps(report))
    write_repair_view(Repaired(source, tmp_path / "report.json", source), tmp_path / "view.glb", "coarse")
    assert [node["name"] for node in loaded((tmp_path / "view.glb").read_bytes()).document["nodes"]] == ["measured"]


def facts_of(path: Path, level: LevelName) -> tuple[int, dict[str, Any]]:
    view = path.with_suffix(f".{level}.glb")
    write_mesh_view(path, view, level)
    return view.stat().st_size, extras(loaded(view.read_bytes()))


def test_a_large_mesh_comes_in_two_levels_within_their_bytes(tmp_path: Path) -> None:
    mesh = bumpy_plate(450, 4.0)
    path = write_ply(tmp_path / "large.ply", mesh)
    (coarse, about), (fine, whole) = facts_of(path, "coarse"), facts_of(path, "fine")
    assert coarse < 2_000_000 < fine < 20_000_000
    assert (about["is_reduced"], whole["is_reduced"]) == (True, False)
    assert about["triangles"] == whole["triangles"] == len(mesh.triangles)
    assert about["origin"] == whole["origin"]
    assert np.allclose(about["bounding_box"]["min"], mesh.vertices.min(axis=0))


def test_a_mesh_of_borders_alone_is_within_the_bytes_as_well(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    corners = rng.uniform(-1, 1, (120_000, 1, 3)) + rng.normal(0, 0.01, (120_000, 3, 3))
    soup = TriangleMesh(corners.reshape(-1, 3), np.arange(360_000).reshape(-1, 3))
    size, about = facts_of(write_ply(tmp_path / "soup.ply", soup), "coarse")
    assert 100_000 < size <= LEVELS["coarse"].n_bytes
    assert about["is_reduced"]


def test_colours_of_a_screen_become_linear_and_those_of_gltf_stay(tmp_path: Path) -> None:
    plate = open_grid(4)
    lines = ["ply", "format ascii 1.0", f"element vertex {len(plate.vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"] + [f"property uchar {c}" for c in ("red", "green", "blue")]
    lines += [f"element face {len(plate.triangles)}", "property list uchar int vertex_indices", "end_header"]
    lines += [f"{x} {y} {z} 188 0 255" for x, y, z in plate.vertices.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in plate.triangles.tolist()]
    path = tmp_path / "coloured.ply"
    path.write_text("\n".join(lines) + "\n")
    write_mesh_view(path, tmp_path / "once.glb", "coarse")
    write_mesh_view(tmp_path / "once.glb", tmp_path / "twice.glb", "coarse")
    for name in ("once.glb", "twice.glb"):
        file = loaded((tmp_path / name).read_bytes())
        assert np.abs(attribute(file, 0, "COLOR_0") - [0.503, 0.0, 1.0, 1.0]).max() < 0.003
        assert extras(file)["has_colours"]


def test_what_is_no_surface_has_no_view(tmp_path: Path) -> None:
    line = TriangleMesh(np.array([[0.0, 0, 0], [1, 1, 1]]), np.array([[0, 1, 1]]))
    with pytest.raises(EmptyMeshError):
        write_mesh_view(write_ply(tmp_path / "line.ply", line), tmp_path / "view.glb", "coarse")
    (tmp_path / "text.ply").write_text("no mesh")
    with pytest.raises(ReadError):
        write_mesh_view(tmp_path / "text.ply", tmp_path / "view.glb", "coarse")


def test_a_tiny_mesh_is_not_reduced(tmp_path: Path) -> None:
    path = write_ply(tmp_path / "ball.ply", sphere(2))
    assert facts_of(path, "coarse")[1]["is_reduced"] is False
