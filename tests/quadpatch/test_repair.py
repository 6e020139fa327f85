import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadpatch.errors import FormatError, MeshError, ModelError, OptionError, QuadpatchError, ReadError
from quadpatch.formats.reading import read_scan
from quadpatch.options import HoleOptions, PatchOptions, RepairOptions
from quadpatch.processes import ProcessPool
from quadpatch.repair import inspect_file, repair_and_keep, repair_file
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched, relief, sphere, write_ply

PLACES = [(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.45, 0.5)]
RELIEF = punched(relief(80, 2.0, 0.03, 8), *PLACES, radius=0.13)

STAGES_OF_GEOMETRY = ["read", "holes", "fill", "judge", "write"]
STAGES_OF_A_MODEL = [
    *("read", "holes", "fill", "smooth", "quadrangulate", "patchify"),
    *("learn", "inpaint", "reconstruct", "judge", "write"),
]


def write_stl(path: Path, mesh: TriangleMesh) -> Path:
    corners = mesh.vertices[mesh.triangles].astype("<f4")
    facets = np.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets["corners"] = corners
    path.write_bytes(b"\0" * 80 + np.uint32(len(corners)).tobytes() + facets.tobytes())
    return path


WRITERS: dict[str, Callable[[Path, TriangleMesh], Path]] = {
    "f4.ply": lambda path, mesh: write_ply(path, mesh, "f4"),
    "f8.ply": lambda path, mesh: write_ply(path, mesh, "f8"),
    "binary.stl": write_stl,
}


@pytest.fixture(scope="module")
def scan_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_ply(tmp_path_factory.mktemp("scan") / "relief.ply", RELIEF)


@pytest.fixture(scope="module", params=["smooth", "self"])
def repaired(request: pytest.FixtureRequest, scan_file: Path) -> tuple[str, Path, dict[str, Any]]:
    output = scan_file.with_name(f"{request.param}.ply")
    return request.param, output, repair_file(scan_file, output, request.param)


def test_a_repair_has_the_same_bytes_whatever_the_number_of_processes(tmp_path: Path) -> None:
    at = np.arange(-1.5, 1.51, 0.6)
    plate = bumpy_plate(160, 4.0)
    holes = on_surface(plate, *((float(x), float(y)) for x in at for y in at))
    source, written, records = write_ply(tmp_path / "in.ply", punched(plate, *holes, radius=0.18)), set(), set()
    fractions: list[float] = []
    for n_processes in (1, 2, 3):
        output = tmp_path / f"{n_processes}.ply"
        with ProcessPool(n_processes) as pool:
            report = repair_and_keep(
                source, output, "smooth", progress=lambda _, fraction: fractions.append(fraction), pool=pool
            ).report
        assert report["counts"]["filled_smooth"] == len(at) ** 2
        written.add(output.read_bytes())
        records.add(json.dumps(report["holes"]))
    assert len(written) == 1
    assert len(records) == 1
    assert any(0 < fraction < 1 for fraction in fractions)


@pytest.mark.parametrize("model", ["smooth", pytest.param("self", marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", WRITERS)
def test_every_vertex_and_face_of_the_file_comes_back_bit_for_bit_and_in_order(
    tmp_path: Path, name: str, model: str
) -> None:
    source, output = WRITERS[name](tmp_path / f"in.{name}", RELIEF), tmp_path / f"out.{name}"
    report = repair_file(source, output, model)
    before, after = read_scan(source), read_scan(output)
    assert after.vertices[: len(before.vertices)].tobytes() == before.vertices.tobytes()
    assert after.triangles[: len(before.triangles)].tobytes() == before.triangles.tobytes()
    assert report["counts"]["filled"] + report["counts"]["filled_smooth"] == 4
    new = sum(hole["new_triangles"] for hole in report["holes"])
    assert len(after.triangles) == len(before.triangles) + new
    assert [hole["edges"] for hole in inspect_file(output)["holes"]] == [4 * 79]


def test_the_same_file_options_and_model_give_the_same_bytes(
    repaired: tuple[str, Path, dict[str, Any]], scan_file: Path, tmp_path: Path
) -> None:
    model, output, report = repaired
    again = repair_file(scan_file, tmp_path / output.name, model)
    assert (tmp_path / output.name).read_bytes() == output.read_bytes()
    assert [stage["name"] for stage in again["stages"]] == [stage["name"] for stage in report["stages"]]
    costs = {"stages": None, "calibration": None}
    assert {**again, **costs} == {**report, **costs}
    assert again["calibration"] == {**report["calibration"], "seconds": again["calibration"]["seconds"]}


def test_the_report_is_plain_json_and_its_counts_add_up(repaired: tuple[str, Path, dict[str, Any]]) -> None:
    model, _, report = repaired
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert set(report) == {
        *("schema", "task", "source", "length_unit", "model", "options"),
        *("counts", "patches", "colours", "texture", "holes", "calibration", "stages", "welded"),
        *("warnings", "warning_details"),
    }
    assert report["schema"] == 1
    assert report["model"]["name"] == model
    counts = report["counts"]
    assert counts["found"] == len(report["holes"]) == 5
    assert sum(counts[verdict] for verdict in ("filled", "filled_smooth", "skipped", "refused")) == counts["found"]
    for verdict in ("filled", "filled_smooth", "skipped", "refused"):
        assert counts[verdict] == sum(hole["verdict"] == verdict for hole in report["holes"])
    assert counts["filled"] == 0 or model == "self"
    expected = STAGES_OF_GEOMETRY if model == "smooth" else STAGES_OF_A_MODEL
    assert [stage["name"] for stage in report["stages"]] == expected
    assert all(stage["seconds"] >= 0 for stage in report["stages"])
    peaks = [stage["peak_memory_mib"] for stage in report["stages"]]
    assert peaks == sorted(peaks)
    assert peaks[0] > 10


def test_every_hole_is_measured_judged_and_explained(repaired: tuple[str, Path, dict[str, Any]]) -> None:
    _, _, report = repaired
    size = math.dist(*report["source"]["bounding_box"].values())
    assert [hole["id"] for hole in report["holes"]] == list(range(5))
    for hole in report["holes"]:
        for name in ("edges", "perimeter", "diameter", "area"):
            assert hole[name] > 0
        if hole["verdict"] == "filled":
            assert hole["code"] is None
            assert hole["reason"] is None
        else:
            assert hole["code"]
            assert hole["reason"]
        if hole["verdict"] == "skipped":
            assert hole["confidence"] is None
            assert hole["new_vertices"] == hole["new_triangles"] == 0
            assert hole["hole_id"] is None
        else:
            assert 0 <= hole["confidence"] <= 1
            assert hole["confidence"] == pytest.approx(math.exp(-hole["expected_error"] / (0.003 * size)))
            assert hole["measures"]["gap"] >= 0
        if hole["fill"] == "energies":
            assert sum(energy["share"] for energy in hole["energies"]) == pytest.approx(1.0, abs=0.03)
            assert all(
                energy.keys() == {"membrane", "plate", "variation", "slope", "share"} for energy in hole["energies"]
            )
        else:
            assert hole["energies"] is None


def test_facts_of_the_file_are_those_of_the_mesh(scan_file: Path) -> None:
    facts = inspect_file(scan_file)
    used = RELIEF.vertices[np.unique(RELIEF.triangles)]
    assert (facts["format"], facts["vertices"], facts["triangles"]) == ("ply", 6400, len(RELIEF.triangles))
    assert facts["bounding_box"] == {"min": used.min(axis=0).tolist(), "max": used.max(axis=0).tolist()}
    assert facts["length_unit"] == "mesh units"
    assert [hole["chosen"] for hole in facts["holes"]] == [False, True, True, True, True]
    assert facts["holes"][0]["reason"] == "outer border of a piece of the scan"
    assert json.loads(json.dumps(facts, allow_nan=False)) == facts


def test_progress_runs_through_every_stage_and_never_backwards(scan_file: Path, tmp_path: Path) -> None:
    told: list[tuple[str, float]] = []
    repair_file(scan_file, tmp_path / "out.ply", "self", progress=lambda name, part: told.append((name, part)))
    assert list(dict.fromkeys(name for name, _ in told)) == STAGES_OF_A_MODEL
    for stage in STAGES_OF_A_MODEL:
        parts = [part for name, part in told if name == stage]
        assert parts[0] == 0.0
        assert parts[-1] == 1.0
        assert parts == sorted(parts)


def test_options_reach_the_patches(scan_file: Path, tmp_path: Path) -> None:
    options = RepairOptions(HoleOptions(ids=(1, 2)), PatchOptions(0.4, 20, 1), seed=5)
    report = repair_file(scan_file, tmp_path / "out.ply", "self", options)
    assert {name: report["patches"][name] for name in ("length", "resolution", "overlap")} == {
        "length": 0.4,
        "resolution": 20,
        "overlap": 1,
    }
    assert report["options"]["seed"] == 5
    codes = {hole["id"]: hole["code"] for hole in report["holes"] if hole["verdict"] == "skipped"}
    assert codes == {0: "not_chosen", 3: "not_chosen", 4: "not_chosen"}


def test_the_shipped_dictionary_repairs(scan_file: Path, tmp_path: Path) -> None:
    report = repair_file(scan_file, tmp_path / "out.ply", "general-dictionary@1")
    assert report["model"]["kind"] == "dictionary"
    assert len(report["model"]["sha256"]) == 64
    # Patches of the holes are cut where calibration believes the model.
    assert (report["patches"]["count"] > 0) == (report["patches"]["believed_share"] > 0)
    assert report["counts"]["filled"] + report["counts"]["filled_smooth"] == 4


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_without_holes_comes_back_with_every_vertex_and_face_and_nothing_more(tmp_path: Path, name: str) -> None:
    source, output = WRITERS[name](tmp_path / f"in.{name}", sphere(3)), tmp_path / f"out.{name}"
    report = repair_file(source, output, "self")
    before, after = read_scan(source), read_scan(output)
    assert after.vertices.tobytes() == before.vertices.tobytes()
    assert after.triangles.tobytes() == before.triangles.tobytes()
    assert report["counts"] == {"found": 0, "filled": 0, "filled_smooth": 0, "skipped": 0, "refused": 0}
    assert report["holes"] == []


@pytest.mark.parametrize(
    ("mesh_name", "error"),
    [("missing.ply", ReadError), ("folder.ply", ReadError), ("text.ply", MeshError)],
)
def test_files_that_are_no_mesh_give_their_error(tmp_path: Path, mesh_name: str, error: type[QuadpatchError]) -> None:
    (tmp_path / "folder.ply").mkdir()
    (tmp_path / "text.ply").write_text("no mesh at all\n")
    with pytest.raises(error):
        repair_file(tmp_path / mesh_name, tmp_path / "out.ply", "smooth")
    with pytest.raises(error):
        inspect_file(tmp_path / mesh_name)


def test_a_suffix_that_is_not_written_is_refused_before_any_work(scan_file: Path, tmp_path: Path) -> None:
    stages: list[str] = []
    with pytest.raises(FormatError, match=r"\.docx"):
        repair_file(scan_file, tmp_path / "out.docx", "smooth", progress=lambda name, _: stages.append(name))
    assert stages == []


def test_unknown_models_and_holes_are_named(scan_file: Path, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no-such-model"):
        repair_file(scan_file, tmp_path / "out.ply", "no-such-model")
    with pytest.raises(OptionError, match="id 77"):
        repair_file(scan_file, tmp_path / "out.ply", "smooth", RepairOptions(HoleOptions(ids=(77,))))
    assert not (tmp_path / "out.ply").exists()


def test_a_format_that_implies_a_unit_is_a_warning(tmp_path: Path) -> None:
    mesh = punched(sphere(3), (0.0, 0.0, 1.0), radius=0.4)
    write_ply(tmp_path / "in.ply", mesh)
    (warning,) = repair_file(tmp_path / "in.ply", tmp_path / "out.glb", "smooth")["warnings"]
    assert warning == (
        "the scan states no length unit, and .glb always means meter: the numbers are unchanged; length_unit says what "
        "they are in"
    )
    assert repair_file(tmp_path / "in.ply", tmp_path / "out.ply", "smooth")["warnings"] == []
