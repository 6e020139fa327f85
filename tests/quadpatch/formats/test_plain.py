from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import FormatError
from quadpatch.formats.plain import encode_plain_ply, write_mesh
from quadpatch.formats.reading import read_scan
from quadpatch.types import TriangleMesh
from tests.quadpatch.shapes import sphere


def test_a_mesh_comes_back_bit_for_bit_with_its_unit(tmp_path: Path) -> None:
    mesh = sphere(2)
    assert write_mesh(tmp_path / "a.ply", mesh, "millimeter") == []
    scan = read_scan(tmp_path / "a.ply")
    assert (scan.vertices == mesh.vertices).all()
    assert (scan.triangles == mesh.triangles).all()
    assert b"comment unit millimeter\n" in (tmp_path / "a.ply").read_bytes()


def test_coordinates_that_float32_holds_take_four_bytes() -> None:
    mesh = sphere(2)
    rounded = TriangleMesh(mesh.vertices.astype(np.float32).astype(np.float64), mesh.triangles)
    assert len(encode_plain_ply(rounded, None)) < len(encode_plain_ply(mesh, None)) - 11 * len(mesh.vertices)


def test_an_unknown_suffix_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError):
        write_mesh(tmp_path / "a.qpz", sphere(1), None)
