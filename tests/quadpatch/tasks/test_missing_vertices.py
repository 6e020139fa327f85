import json
from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import NotFiniteError, OptionError
from quadpatch.formats.scan import Scan
from quadpatch.tasks.missing_vertices import missing_vertices
from tests.quadpatch.shapes import sphere


def scan(*nan: int) -> Scan:
    ball = sphere(0)
    vertices = ball.vertices.copy()
    vertices[list(nan)] = np.nan
    return Scan(vertices, ball.triangles, "ply")


def found(mask: np.ndarray) -> list[int]:
    return [int(i) for i in np.flatnonzero(mask)]


def test_vertices_without_a_position_are_missing() -> None:
    assert found(missing_vertices(scan(2, 5), "nan")) == [2, 5]


@pytest.mark.parametrize("text", ["1 3\n7", "1,3,7", "[1, 3, 7]", " [1,3,7,1]\n"])
def test_a_list_names_vertices(tmp_path: Path, text: str) -> None:
    (tmp_path / "list.txt").write_text(text)
    assert found(missing_vertices(scan(), tmp_path / "list.txt")) == [1, 3, 7]


@pytest.mark.parametrize("values", [np.array([1, 3, 7], np.uint8), np.isin(np.arange(12), [1, 3, 7])])
def test_a_numpy_file_holds_numbers_or_booleans(tmp_path: Path, values: np.ndarray) -> None:
    np.save(tmp_path / "list.npy", values)
    assert found(missing_vertices(scan(), tmp_path / "list.npy")) == [1, 3, 7]


@pytest.mark.parametrize(
    "text", ["12", "-1", "one", "[1.5]", "[true]", "[[1]]", "{}", "[", "1" * 5000, "[" * 900, "[null]", ""]
)
def test_a_list_that_does_not_fit_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "list.txt").write_text(text)
    with pytest.raises(OptionError):
        missing_vertices(scan(), tmp_path / "list.txt")


def npy(header: str, values: bytes = b"") -> bytes:
    return b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header.encode() + values


@pytest.mark.parametrize(
    "data",
    [
        npy("{'descr': '<i8', 'fortran_order': False, 'shape': (1000000000000,)}"),
        npy("{'descr': '|O', 'fortran_order': False, 'shape': (1,)}", b"x" * 8),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1,)}", b"x" * 8),
        npy("{'descr': '<i8', 'fortran_order': False, 'shape': (-1,)}"),
        npy("{'descr': '|b1', 'fortran_order': False, 'shape': (3,)}", b"\1\1\1"),
        npy("__import__('os')"),
        b"\x93NUMPY",
        b"\x93NUMPY\x09\x09",
    ],
)
def test_a_numpy_file_that_does_not_fit_is_refused(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "list.npy").write_bytes(data)
    with pytest.raises(OptionError):
        missing_vertices(scan(), tmp_path / "list.npy")


def test_a_list_of_another_size_than_the_mesh_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "list.json").write_text(json.dumps([1] * 10_000))
    with pytest.raises(OptionError, match="bytes"):
        missing_vertices(scan(), tmp_path / "list.json")


def test_a_list_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="can't be read"):
        missing_vertices(scan(), tmp_path / "none.txt")


def test_a_vertex_without_a_position_must_be_marked(tmp_path: Path) -> None:
    (tmp_path / "list.txt").write_text("3")
    with pytest.raises(NotFiniteError, match="vertex 2 first"):
        missing_vertices(scan(2, 3), tmp_path / "list.txt")


def test_nothing_missing_and_everything_missing_are_refused() -> None:
    with pytest.raises(OptionError, match="nothing to restore"):
        missing_vertices(scan(), "nan")
    with pytest.raises(OptionError, match="all vertices"):
        missing_vertices(scan(*range(12)), "nan")


def test_a_property_is_looked_for_in_ply_files_only() -> None:
    with pytest.raises(OptionError):
        missing_vertices(scan(), "property:gone")
