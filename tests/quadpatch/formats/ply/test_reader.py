"""Reading PLY of every make.

Also tests `quadpatch.formats.ply.ascii`, `quadpatch.formats.ply.binary` and `quadpatch.formats.ply.header`.
"""

import struct

import numpy as np
import pytest
from hypothesis import given, settings

from quadpatch.errors import EmptyMeshError, FormatError, IndexRangeError, NotFiniteError, ReadError, TooLargeError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.ply.reader import read_ply
from quadpatch.formats.scan import Scan
from tests.quadpatch.formats.ply.builder import Ply, ply_files

XYZ = "property float x\nproperty float y\nproperty float z\n"
TRIANGLE = "0 0 0\n1 0 0\n0 1 0\n"


def read(data: bytes | str) -> Scan:
    return read_ply(data.encode() if isinstance(data, str) else data, ReadLimits())


def ascii_ply(n_vertices: int, vertices: str, faces: str, element: str = "face 1", more: str = "") -> str:
    return (
        f"ply\nformat ascii 1.0\nelement vertex {n_vertices}\n{XYZ}{more}element {element}\n"
        f"property list uchar int vertex_indices\nend_header\n{vertices}{faces}"
    )


@given(made=ply_files())
@settings(max_examples=200)
def test_vertices_and_faces_are_read_from_any_header(made: tuple[Ply, list[list[float]], list[list[int]]]) -> None:
    ply, vertices, faces = made
    scan = read(ply.encode())
    assert scan.vertices.tolist() == vertices
    assert scan.triangles.tolist() == faces


@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("first", [b"\n", b"\r", b"\r\n", b" "])
def test_a_binary_body_may_begin_with_bytes_that_look_like_line_ends(line_end: str, first: bytes) -> None:
    header = ascii_ply(3, "", "").replace("ascii", "binary_little_endian").replace("\n", line_end)
    x = struct.unpack("<f", (first * 4)[:4])[0]
    body = struct.pack("<9f", x, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<B3i", 3, 0, 1, 2)
    scan = read(header.encode() + body)
    assert scan.vertices[0, 0] == x
    assert scan.triangles.tolist() == [[0, 1, 2]]


def test_rows_of_ascii_files_may_break_across_lines() -> None:
    scan = read(ascii_ply(3, "0 0\n0 1 0 0\n0 1 0", "\n3 0\n1 2"))
    assert scan.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_polygons_become_triangles_that_cover_them() -> None:
    arrow = "0 0 0\n4 0 0\n4 4 0\n3 1 0\n"
    scan = read(ascii_ply(4, arrow, "4 0 1 2 3\n3 0 1 3\n", element="face 2"))
    a, b, c = np.moveaxis(scan.vertices[scan.triangles[:2]], 1, 0)
    areas = np.cross(b - a, c - a)[:, 2] / 2
    assert (areas > 0).all()
    assert areas.sum() == 4.0
    assert scan.triangles[2].tolist() == [0, 1, 3]


def test_strips_alternate_and_begin_again_behind_a_negative_index() -> None:
    vertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n"
    scan = read(ascii_ply(5, vertices, "9 0 1 2 3 4 -1 2 3 4\n", element="tristrips 1"))
    assert scan.triangles.tolist() == [[0, 1, 2], [2, 1, 3], [2, 3, 4], [2, 3, 4]]


def test_mixed_lists_cost_no_accuracy() -> None:
    rng = np.random.default_rng(0)
    sizes = rng.integers(3, 6, 500)
    polygons = [rng.permutation(50)[:size] for size in sizes]
    header = ascii_ply(50, "", "", element="face 500").replace("ascii", "binary_big_endian")
    points = rng.normal(size=(50, 3))
    body = points.astype(">f4").tobytes()
    body += b"".join(struct.pack(f">B{len(p)}i", len(p), *p) for p in polygons)
    scan = read(header.encode() + body)
    assert len(scan.triangles) == (sizes - 2).sum()
    of_first = scan.triangles[: sizes[0] - 2]
    assert set(of_first.ravel()) == set(polygons[0].tolist())


@pytest.mark.parametrize(
    ("text", "error"),
    [
        (ascii_ply(3, TRIANGLE, "3 0 1 3\n"), IndexRangeError),
        (ascii_ply(3, TRIANGLE, "3 0 1 -1\n"), IndexRangeError),
        (ascii_ply(3, "0 0 0\n1 0 nan\n0 1 0\n", "3 0 1 2\n"), NotFiniteError),
        (ascii_ply(3, "0 0 0\n1 0 inf\n0 1 0\n", "3 0 1 2\n"), NotFiniteError),
        (ascii_ply(3, "0 0 0\n1 0 1e39\n0 1 0\n", "3 0 1 2\n"), NotFiniteError),
        (ascii_ply(3, TRIANGLE, "2 0 1\n"), EmptyMeshError),
        (ascii_ply(0, "", "", element="face 0"), EmptyMeshError),
        (ascii_ply(3, TRIANGLE, ""), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 x\n"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 1.5\n"), ReadError),
        (ascii_ply(3, TRIANGLE, "3.5 0 1 2\n"), ReadError),
        (ascii_ply(3, TRIANGLE, "-3 0 1 2\n"), ReadError),
        (ascii_ply(10**17, TRIANGLE, "3 0 1 2\n"), TooLargeError),
        (ascii_ply(1000, TRIANGLE, "3 0 1 2\n"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("uchar", "float"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("uchar", "byte"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("property float z\n", ""), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("float y", "float x"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("element face", "element vertex"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("vertex_indices", "corners"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("end_header", "end"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("element face 1", "element face one"), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("format ascii 1.0\n", ""), ReadError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("ascii", "compressed"), FormatError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("ascii 1.0", "ascii 2.0"), FormatError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("element face", "element range_grid"), FormatError),
        (ascii_ply(3, TRIANGLE, "3 0 1 2\n").replace("element face", "element edge"), EmptyMeshError),
    ],
)
def test_wrong_files_are_refused_by_name(text: str, error: type[Exception]) -> None:
    with pytest.raises(error):
        read(text)


def test_a_count_beyond_the_file_is_refused_before_anything_is_allocated() -> None:
    header = ascii_ply(3, "", "", element="face 39999999").replace("ascii", "binary_little_endian")
    with pytest.raises(ReadError, match="39,999,999 rows"):
        read(header.encode() + bytes(60))


def test_a_list_longer_than_the_file_is_refused() -> None:
    header = ascii_ply(3, "", "", element="face 2").replace("ascii", "binary_little_endian")
    header = header.replace("list uchar", "list uint")
    body = bytes(36) + struct.pack("<I3iI", 3, 0, 1, 2, 2**32 - 1)
    with pytest.raises(ReadError):
        read(header.encode() + body + bytes(8))


def test_negative_list_lengths_of_binary_files_are_named() -> None:
    header = ascii_ply(3, "", "").replace("ascii", "binary_little_endian").replace("list uchar", "list char")
    with pytest.raises(ReadError, match="row 0"):
        read(header.encode() + bytes(36) + struct.pack("<b3i", -3, 0, 1, 2))


@pytest.mark.parametrize(
    "declaration", ["property float p{}\n", "element e{} 0\n", "element e{} 0\nproperty float p\n"]
)
def test_a_header_of_endless_declarations_is_refused(declaration: str) -> None:
    few, many = ("".join(declaration.format(i) for i in range(n)) for n in (100, 20_000))
    values = " 0" * 100 if declaration.startswith("property") else ""
    vertices = "".join(f"{row}{values}\n" for row in TRIANGLE.splitlines())
    assert len(read(ascii_ply(3, vertices, "3 0 1 2\n", more=few)).vertices) == 3
    with pytest.raises(ReadError, match="declares more than 4096"):
        read(ascii_ply(3, TRIANGLE, "3 0 1 2\n", more=many))
