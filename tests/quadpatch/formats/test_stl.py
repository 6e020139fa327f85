"""STL in, STL out."""

import io
from pathlib import Path

import numpy as np
import pytest
import trimesh

from quadpatch.errors import CoordinateRangeError, EmptyMeshError, NotFiniteError, ReadError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Scan
from quadpatch.formats.stl import encode_stl, read_stl
from quadpatch.formats.stl_layout import is_binary_stl
from tests.quadpatch.formats.fills import EMPTY, appended, as_scan, cap_holes, n_open_edges
from tests.quadpatch.shapes import punched, sphere

FACET = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1.5e0 0\nendloop\nendfacet\n"


def read(data: bytes | str) -> Scan:
    return read_stl(data.encode() if isinstance(data, str) else data, ReadLimits())


def binary_ball() -> bytes:
    mesh = as_scan(punched(sphere(2), (0, 0, 1), radius=0.5))
    corners = (mesh.vertices + 100.123)[mesh.triangles].astype(np.float32).astype(np.float64)
    data = bytearray(encode_stl(corners, np.zeros((len(corners), 3)), np.zeros(len(corners), bool)))
    # A colour of another program in the attribute of the first facet, and a header that says `solid`.
    data[84 + 48 : 84 + 50] = b"\x34\x92"
    data[:12] = b"solid object"
    return bytes(data)


def test_binary_records_come_back_to_the_byte_and_the_hole_is_closed() -> None:
    data = binary_ball()
    scan = read(data)
    fill = cap_holes(scan)
    repaired = appended(scan, fill)
    assert repaired[84 : len(data)] == data[84:]
    assert repaired[:80] == data[:80]
    again = read(repaired)
    assert len(again.triangles) == len(scan.triangles) + len(fill.triangles)
    assert n_open_edges(scan) > 0
    assert n_open_edges(again) == 0
    attributes = [repaired[84 + 50 * i + 48] for i in range(len(scan.triangles), len(again.triangles))]
    assert set(attributes) == {1}
    other = trimesh.load(io.BytesIO(repaired), file_type="stl", process=False)
    assert (other.triangles == again.vertices[again.triangles]).all()


def test_solid_in_the_header_of_a_binary_file_is_not_believed() -> None:
    data = binary_ball()
    assert is_binary_stl(data)
    assert len(read(data).triangles) > 100


def test_bytes_behind_the_last_record_stay_behind_it() -> None:
    data = b"binary" + binary_ball()[6:] + b"trailer"
    scan = read(data)
    assert scan.source is not None
    assert appended(scan, EMPTY) == data


def test_ascii_text_stays_and_facets_stand_in_the_last_solid() -> None:
    text = f"solid A\n{FACET}endsolid A\nSOLID b\r\n{FACET.upper()}ENDSOLID b\n"
    scan = read(text)
    assert scan.vertices[:3].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1.5, 0]]
    fill = cap_holes(scan)
    repaired = appended(scan, fill).decode()
    head, tail = text.split("ENDSOLID")
    assert repaired.startswith(head)
    assert repaired.endswith("ENDSOLID" + tail)
    again = read(repaired)
    assert again.vertices[:6].tobytes() == scan.vertices.tobytes()
    new = np.concatenate([scan.vertices, fill.vertices])[fill.triangles]
    assert again.vertices[6:].tobytes() == new.tobytes()


@pytest.mark.parametrize(
    ("data", "error"),
    [
        ("solid a\nendsolid a\n", EmptyMeshError),
        (f"solid a\n{FACET.replace('1.5e0', 'nan')}endsolid a\n", NotFiniteError),
        (f"solid a\n{FACET.replace('1.5e0', 'one')}endsolid a\n", ReadError),
        (f"solid a\n{FACET}{FACET[:60]}", ReadError),
        (f"solid a\n{FACET.replace('vertex 1 0 0', '')}endsolid a\n", ReadError),
        (b"\1" * 60, ReadError),
        (bytes(80) + (1000).to_bytes(4, "little") + bytes(50), ReadError),
        (bytes(84), EmptyMeshError),
    ],
)
def test_wrong_files_are_refused(data: bytes | str, error: type[Exception]) -> None:
    with pytest.raises(error):
        read(data)


def facets_of(data: bytes) -> int:
    return int.from_bytes(data[80:84], "little")


def with_count(data: bytes, count: int) -> bytes:
    return data[:80] + count.to_bytes(4, "little") + data[84:]


@pytest.mark.parametrize("header", [b"solid exported", b"binary", b"COLOR=\xff\xff\xff\xff,MATERIAL=", b"solid facet"])
@pytest.mark.parametrize("trailer", [b"t", b"trailer", b"\0" * 50, b"\0" * 2048, b"some words of the program" * 20])
def test_a_binary_file_with_a_trailer_is_read_whatever_its_header_says(
    tmp_path: Path, header: bytes, trailer: bytes
) -> None:
    ball = binary_ball()
    path = tmp_path / "scan.stl"
    path.write_bytes(header.ljust(80, b"\0") + ball[80:] + trailer)
    scan = read_scan(path)
    assert len(scan.triangles) == facets_of(ball)
    assert scan.vertices.tobytes() == read(ball).vertices.tobytes()
    assert scan.source is not None
    assert appended(scan, EMPTY) == path.read_bytes()


def test_a_binary_file_with_a_trailer_needs_no_suffix(tmp_path: Path) -> None:
    path = tmp_path / "scan"
    path.write_bytes(b"solid exported".ljust(80, b"\0") + binary_ball()[80:] + b"trailer")
    assert read_scan(path).format == "stl"


def with_payloads(data: bytes, payload: bytes, every: int) -> bytes:
    """Put data of their own behind some facets, as long as their attribute byte counts say."""
    pieces = [data[:84]]
    for i in range(facets_of(data)):
        record = data[84 + 50 * i : 84 + 50 * i + 48]
        own = payload if i % every == 0 else b""
        pieces.append(record + len(own).to_bytes(2, "little") + own)
    return b"".join(pieces)


@pytest.mark.parametrize("every", [1, 3, 319])
@pytest.mark.parametrize("payload", [b"ABCD", b"\0\0", bytes(50), b"xyz" * 40])
def test_facets_with_data_of_their_own_are_refused(payload: bytes, every: int) -> None:
    data = with_payloads(binary_ball(), payload, every)
    with pytest.raises(ReadError, match="data of their own"):
        read(data)
    with pytest.raises((ReadError, CoordinateRangeError)):
        read(data + b"\1\2\3")


def test_a_count_that_is_not_that_of_the_facets_is_refused() -> None:
    ball = binary_ball()
    n = facets_of(ball)
    for count in (0, 1, n - 1, n - 7):
        with pytest.raises(ReadError, match=f"declares {count} facets, and more follow"):
            read(with_count(ball, count))
    for count in (n + 1, 2 * n, 2**32 - 1):
        with pytest.raises(ReadError, match=f"room for {n}"):
            read(with_count(ball, count))


def test_normals_as_long_as_the_area_or_of_no_meaning_at_facets_without_area_are_normals() -> None:
    mesh = as_scan(sphere(2))
    corners = np.concatenate([mesh.vertices[mesh.triangles], np.zeros((1, 3, 3))])
    normals = 50 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals[-1] = np.nan
    data = encode_stl(corners, normals, np.zeros(len(corners), bool))
    assert len(read(data + b"trailer").triangles) == len(corners)


NAMES = [
    "vertex 1 2 3",
    "facet",
    "facet normal 0 0 1",
    "endsolid endfacet endloop",
    "my part, v2 (größe)",
    "endsolid",
    "color=1 vertex",
    "solid solid",
]


@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("name", NAMES)
def test_an_ascii_name_may_hold_any_word(name: str, line_end: str) -> None:
    plain = f"solid {name}\n{FACET}endsolid {name}\n  SOLID {name.upper()}\n{FACET.upper()}  endSolid\n"
    text = plain.replace("\n", line_end)
    scan = read(text)
    assert len(scan.triangles) == 2
    fill = cap_holes(scan)
    repaired = appended(scan, fill)
    assert len(read(repaired).triangles) == 2 + len(fill.triangles)
    head, tail = text.encode()[: text.encode().rindex(b"endSolid")], b"endSolid" + line_end.encode()
    assert repaired.startswith(head)
    assert repaired.endswith(tail)


def test_ascii_text_in_one_line_and_behind_a_byte_order_mark_is_read() -> None:
    text = f"solid vertex 1 2 3 {FACET}endsolid vertex 1 2 3"
    assert len(read(text.replace("\n", " ")).triangles) == 1
    assert len(read(b"\xef\xbb\xbf" + text.encode()).triangles) == 1


def test_coordinates_of_no_scan_are_refused_in_binary_and_text() -> None:
    ball = bytearray(binary_ball())
    ball[84 + 12 : 84 + 16] = np.float32(3e38).tobytes()
    for data in (bytes(ball), f"solid a\n{FACET.replace('1.5e0', '3e38')}endsolid a\n".encode()):
        with pytest.raises(CoordinateRangeError) as caught:
            read(data)
        assert caught.value.code == "coordinate_out_of_range"


def test_small_integers_in_the_place_of_coordinates_are_refused() -> None:
    corners = np.arange(1, 91, dtype=np.uint32).view(np.float32).reshape(-1, 3, 3).astype(np.float64)
    data = encode_stl(corners, np.zeros((len(corners), 3)), np.zeros(len(corners), bool))
    with pytest.raises(CoordinateRangeError):
        read(data)
