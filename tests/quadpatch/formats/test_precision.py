"""What conversion to formats with 32-bit numbers costs."""

from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import PrecisionError
from quadpatch.formats.precision import check_precision, single_step
from quadpatch.formats.scan import Scan
from quadpatch.repair import repair_file
from quadpatch.types import FloatArray
from tests.quadpatch.shapes import bumpy_plate, punched, write_ply

EDGE = 0.1
PLATE = punched(bumpy_plate(31, 30 * EDGE), (0.0, 0.0, 0.0), radius=0.4)


def at(offset: float | FloatArray, file_format: str = "ply") -> Scan:
    return Scan(PLATE.vertices + offset, PLATE.triangles, file_format)


@pytest.mark.parametrize("suffix", [".stl", ".glb", ".gltf", ".STL"])
def test_where_the_step_shows_the_warning_names_it(suffix: str) -> None:
    (warning,) = check_precision(at(5000.0), Path(f"out{suffix}"))
    assert f"steps of {np.spacing(np.float32(5001.5)):.3g}" in warning
    assert "mean edge length is 0.1" in warning


@pytest.mark.parametrize("suffix", [".stl", ".glb", ".gltf"])
def test_where_triangles_collapse_the_conversion_is_refused(suffix: str) -> None:
    with pytest.raises(PrecisionError, match="triangles would collapse") as caught:
        check_precision(at(np.array([5e6, 4e6, 100.0])), Path(f"out{suffix}"))
    assert caught.value.code == "precision_lost"


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".off", ".3mf"])
def test_formats_that_keep_all_digits_cost_nothing(suffix: str) -> None:
    assert check_precision(at(5e6), Path(f"out{suffix}")) == []


def test_near_the_origin_and_in_the_scans_own_format_nothing_is_lost() -> None:
    assert check_precision(at(0.0), Path("out.stl")) == []
    assert check_precision(at(5e6, "stl"), Path("out.stl")) == []
    assert check_precision(at(5e6, "glb"), Path("out.glb")) == []


def test_vertices_that_no_triangle_uses_do_not_count() -> None:
    scan = at(0.0)
    far = Scan(np.concatenate([scan.vertices, [[5e6, 0.0, 0.0]]]), scan.triangles, "ply")
    assert single_step(far) == single_step(scan)


def test_one_sliver_in_a_thousand_triangles_is_told_and_not_refused() -> None:
    scan = at(5000.0)
    sliver = scan.vertices[[0, 0, 0]] + np.array([[0, 0, 0], [1e-5, 0, 0], [0, 1e-5, 0]])
    corners = len(scan.vertices) + np.arange(3)
    with_sliver = Scan(
        np.concatenate([scan.vertices, sliver]), np.concatenate([scan.triangles, corners[None]]), scan.format
    )
    (warning,) = check_precision(with_sliver, Path("out.stl"))
    assert warning.endswith("and 1 triangles collapse")


def test_a_repair_is_refused_before_any_work_and_leaves_no_file(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", type(PLATE)(PLATE.vertices + 5e6, PLATE.triangles))
    stages: list[str] = []
    with pytest.raises(PrecisionError):
        repair_file(source, tmp_path / "out.stl", "smooth", progress=lambda name, _: stages.append(name))
    assert set(stages) == {"read"}
    assert not (tmp_path / "out.stl").exists()


def test_the_warning_stands_in_the_report(tmp_path: Path) -> None:
    source = write_ply(tmp_path / "in.ply", type(PLATE)(PLATE.vertices + 5000.0, PLATE.triangles))
    report = repair_file(source, tmp_path / "out.stl", "smooth")
    assert [warning for warning in report["warnings"] if "32-bit" in warning]
    assert repair_file(source, tmp_path / "out.ply", "smooth")["warnings"] == []
