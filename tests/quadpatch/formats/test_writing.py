"""A mesh is written whatever becomes of what it carries besides its shape."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import FormatError
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Fill, Moved, Scan, VertexAttributes, WithoutImages
from quadpatch.formats.writing import write_scan
from tests.quadpatch.formats.fills import as_scan, cap_holes
from tests.quadpatch.shapes import punched, sphere

BALL = as_scan(punched(sphere(2), (0.0, 0.0, 1.0), radius=0.5))


@dataclass(frozen=True)
class Broken(WithoutImages):
    """The source of a scan whose attributes can't be carried on."""

    error: Exception

    def append(self, scan: Scan, fill: Fill) -> bytes:
        raise self.error

    def move(self, scan: Scan, moved: Moved) -> bytes:
        raise self.error

    def vertex_colours(self, scan: Scan) -> None:
        raise AssertionError

    def vertex_attributes(self, scan: Scan) -> VertexAttributes:
        raise self.error


ERRORS = [RuntimeError("Factor is exactly singular"), MemoryError(), FloatingPointError(), KeyError("u")]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
@pytest.mark.parametrize("suffix", ["ply", "stl", "obj", "off", "glb", "3mf"])
@pytest.mark.parametrize("own", [True, False], ids=["own format", "conversion"])
def test_attributes_that_fail_are_left_out_and_the_shape_is_written(
    tmp_path: Path, error: Exception, suffix: str, own: bool
) -> None:
    scan = Scan(BALL.vertices, BALL.triangles, suffix if own else "memory", source=Broken(error))
    fill = cap_holes(scan)
    path = tmp_path / f"out.{suffix}"
    (warning,) = write_scan(path, scan, fill)
    assert warning.startswith("colours, normals and the like are left out")
    assert len(read_scan(path).triangles) == len(scan.triangles) + len(fill.triangles)


def test_a_format_that_can_not_hold_the_mesh_is_still_an_error(tmp_path: Path) -> None:
    scan = Scan(BALL.vertices, BALL.triangles, "ply", source=Broken(FormatError("too few bits")))
    with pytest.raises(FormatError, match="too few bits"):
        write_scan(tmp_path / "out.ply", scan, cap_holes(scan))
    assert not (tmp_path / "out.ply").exists()


WORDS = {"largest": "1.7e308", "NaN": "nan", "infinite": "-inf", "tiny": "5e-324"}


@pytest.mark.parametrize("word", WORDS.values(), ids=WORDS.keys())
@pytest.mark.parametrize("suffix", ["ply", "stl", "obj", "off", "glb"])
def test_attributes_of_any_number_are_carried_on_without_a_warning(tmp_path: Path, word: str, suffix: str) -> None:
    names = ["x", "y", "z", "nx", "ny", "nz", "quality", "red"]
    header = ["ply", "format ascii 1.0", f"element vertex {len(BALL.vertices)}"]
    header += [f"property double {name}" for name in names]
    header += [f"element face {len(BALL.triangles)}", "property list uchar int vertex_indices", "end_header"]
    rows = [f"{x!r} {y!r} {z!r} {word} 0 1 {word} {word}" for x, y, z in BALL.vertices.tolist()]
    rows += [f"3 {a} {b} {c}" for a, b, c in BALL.triangles.tolist()]
    (tmp_path / "in.ply").write_text("\n".join([*header, *rows, ""]))
    scan = read_scan(tmp_path / "in.ply")
    fill = cap_holes(scan)
    assert write_scan(tmp_path / f"out.{suffix}", scan, fill) == []
    after = read_scan(tmp_path / f"out.{suffix}")
    assert np.isfinite(after.vertices).all()
    assert len(after.triangles) == len(scan.triangles) + len(fill.triangles)
