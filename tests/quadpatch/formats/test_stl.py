"""STL in, STL out."""

import io

import numpy as np
import pytest
import trimesh

from quadpatch.errors import EmptyMeshError, NotFiniteError, ReadError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.scan import Scan
from quadpatch.formats.stl import encode_stl, is_binary_stl, read_stl
from tests.quadpatch.formats.fills import EMPTY, as_scan, cap_holes, n_open_edges
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
    assert scan.source is not None
    repaired = scan.source.append(scan, fill)
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


def test_solid_in_the_header_of_a_binary_file_fools_nobody() -> None:
    data = binary_ball()
    assert is_binary_stl(data)
    assert len(read(data).triangles) > 100


def test_bytes_behind_the_last_record_stay_behind_it() -> None:
    data = b"binary" + binary_ball()[6:] + b"trailer"
    scan = read(data)
    assert scan.source is not None
    assert scan.source.append(scan, EMPTY) == data


def test_ascii_text_stays_and_facets_stand_in_the_last_solid() -> None:
    text = f"solid A\n{FACET}endsolid A\nSOLID b\r\n{FACET.upper()}ENDSOLID b\n"
    scan = read(text)
    assert scan.vertices[:3].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1.5, 0]]
    fill = cap_holes(scan)
    assert scan.source is not None
    repaired = scan.source.append(scan, fill).decode()
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
