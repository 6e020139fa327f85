"""PLY in, PLY out: the same bits with rows behind them.

Also tests `quadpatch.formats.ply.encoding` and `quadpatch.formats.ply.new_rows`.
"""

import io

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings

from quadpatch.errors import FormatError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.ply.reader import read_ply
from quadpatch.formats.ply.rows import ListColumn, Rows
from quadpatch.formats.scan import Fill, Scan
from tests.quadpatch.formats.fills import EMPTY, SAMPLES, appended, as_scan, cap_holes, cut_hole, n_open_edges
from tests.quadpatch.formats.ply.builder import Ply, ply_files
from tests.quadpatch.shapes import punched, sphere


def read(data: bytes) -> Scan:
    return read_ply(data, ReadLimits())


def append(data: bytes, fill: Fill | None = None) -> tuple[bytes, Scan, Fill]:
    scan = read(data)
    fill = cap_holes(scan) if fill is None else fill
    return appended(scan, fill), scan, fill


def element(scan: Scan, name: str) -> Rows:
    rows: Rows = scan.source.file.element(name)  # type: ignore[union-attr]
    return rows


def column(scan: Scan, name: str, prop: str) -> np.ndarray:
    values = element(scan, name).scalar(prop)
    assert values is not None
    return values


def small_fill(scan: Scan) -> Fill:
    """One new vertex and two triangles, wherever they lie."""
    new = len(scan.vertices)
    triangles = np.array([[0, 1, new], [1, 2, new]])
    ones = np.ones(2, np.int64)
    return Fill(np.array([[0.5, 0.25, 8.0]]), triangles, ones[:1] * 7, np.array([0.5]), ones * 7, np.array([0.25, 0.5]))


@given(made=ply_files())
@settings(max_examples=200)
def test_every_measured_value_of_every_element_comes_back(made: tuple[Ply, list[list[float]], list[list[int]]]) -> None:
    ply, _, _ = made
    index = next(prop for name, _, props in ply.elements if name == "face" for prop in props if "vertex" in prop.name)
    data, scan, fill = append(ply.encode(), small_fill(read(ply.encode())))
    again = read(data)
    assert len(again.vertices) == len(scan.vertices) + 1
    assert again.vertices[: len(scan.vertices)].tobytes() == scan.vertices.tobytes()
    assert again.triangles.tolist() == scan.triangles.tolist() + fill.triangles.tolist()
    for name, count, props in ply.elements:
        rows = element(again, name)
        for number, prop in enumerate(props):
            found, old = rows.columns[number], element(scan, name).columns[number]
            if isinstance(found, ListColumn) and isinstance(old, ListColumn):
                assert found.counts[:count].tolist() == [len(value) for value in prop.values]
                assert found.values[: len(old.values)].tobytes() == old.values.tobytes()
            else:
                assert np.asarray(found)[:count].tobytes() == np.asarray(old).tobytes()
    assert index.name in [prop.name for prop in element(again, "face").element.properties]


@given(made=ply_files())
@settings(max_examples=60)
def test_header_lines_stay_but_for_counts_and_marks(made: tuple[Ply, list[list[float]], list[list[int]]]) -> None:
    data = made[0].encode()
    repaired, _, _ = append(data, EMPTY)
    old, new = (part.split(b"end_header")[0].splitlines(keepends=True) for part in (data, repaired))
    marks = [line for line in new if line not in old]
    assert [line for line in new if line in old] == old
    assert [line.split()[-1] for line in marks] == [b"filled", b"hole_id", b"confidence"] * 2


@given(made=ply_files())
@settings(max_examples=60)
def test_what_is_invented_is_marked_and_what_is_measured_is_not(
    made: tuple[Ply, list[list[float]], list[list[int]]],
) -> None:
    data, scan, _ = append(made[0].encode(), small_fill(read(made[0].encode())))
    again = read(data)
    n, m = len(scan.vertices), len(scan.triangles)
    assert column(again, "vertex", "filled").tolist() == [0] * n + [1]
    assert column(again, "vertex", "hole_id").tolist() == [-1] * n + [7]
    assert column(again, "vertex", "confidence").tolist() == [1.0] * n + [0.5]
    assert column(again, "face", "filled").tolist() == [0] * m + [1, 1]
    assert column(again, "face", "hole_id").tolist() == [-1] * m + [7, 7]
    assert column(again, "face", "confidence").tolist() == [1.0] * m + [0.25, 0.5]


@given(made=ply_files())
@settings(max_examples=60)
def test_a_second_repair_adds_rows_and_no_properties(made: tuple[Ply, list[list[float]], list[list[int]]]) -> None:
    once, _, _ = append(made[0].encode(), small_fill(read(made[0].encode())))
    twice, scan, _ = append(once, small_fill(read(once)))
    again = read(twice)
    assert twice.count(b"property uchar filled") == 2
    n = len(scan.vertices)
    assert column(again, "vertex", "confidence")[:n].tobytes() == column(scan, "vertex", "confidence").tobytes()
    assert column(again, "vertex", "filled")[-2:].tolist() == [1, 1]


@pytest.mark.parametrize(("code", "word"), [("<f4", "float"), ("<f8", "double")])
def test_coordinates_keep_their_type_and_every_bit(code: str, word: str) -> None:
    mesh = as_scan(punched(sphere(3), (0, 0, 1), radius=0.4))
    rng = np.random.default_rng(1)
    vertices = (1200 + mesh.vertices + rng.normal(scale=1e-3, size=mesh.vertices.shape)).astype(code)
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
    head += "".join(f"property {word} {axis}\n" for axis in "xyz")
    head += f"element face {len(mesh.triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    faces = np.zeros(len(mesh.triangles), np.dtype([("n", "u1"), ("v", "<i4", (3,))]))
    faces["n"], faces["v"] = 3, mesh.triangles
    body = vertices.tobytes()
    data, scan, fill = append(head.encode() + body + faces.tobytes())
    assert len(fill.triangles) > 0
    again = read(data)
    assert again.vertices[: len(vertices)].astype(vertices.dtype).tobytes() == body
    new = again.vertices[len(vertices) :]
    assert new.tobytes() == fill.vertices.astype(vertices.dtype).astype(np.float64).tobytes()
    assert n_open_edges(scan) > 0
    assert n_open_edges(again) == 0
    # Another reader sees the same file.
    other = trimesh.load(io.BytesIO(data), file_type="ply", process=False)
    assert len(other.faces) == len(again.triangles)
    assert (other.faces == again.triangles).all()


def test_ascii_rows_keep_their_text_to_the_letter() -> None:
    text = (
        "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement vertex 3\r\nproperty double x\r\nproperty double y\r\n"
        "property double z\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
        "0.10 1e-3  0\r\n1.000000000000000001 0 0 \r\n\t0 1 0\r\n3 0 1 2"
    )
    data, _, _ = append(text.encode(), small_fill(read(text.encode())))
    lines = data.decode().split("end_header\r\n")[1].split("\r\n")
    assert lines == [
        "0.10 1e-3  0 0 -1 1",
        "1.000000000000000001 0 0 0 -1 1 ",
        "\t0 1 0 0 -1 1",
        "0.5 0.25 8.0 1 7 0.5",
        "3 0 1 2 0 -1 1",
        "3 0 1 3 1 7 0.25",
        "3 1 2 3 1 7 0.5",
        "",
    ]


def test_strips_stay_and_each_hole_adds_a_row_of_strips() -> None:
    text = (
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 2 3 4\n"
    )
    data, scan, fill = append(text.encode(), small_fill(read(text.encode())))
    assert b"\n9 0 1 2 3 4 -1 2 3 4 0 -1 1\n7 0 1 5 -1 1 2 5 1 7 0.375\n" in data
    assert read(data).triangles.tolist() == scan.triangles.tolist() + fill.triangles.tolist()


def test_indices_that_the_file_cannot_count_are_refused() -> None:
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 255\nproperty float x\nproperty float y\n"
    head += "property float z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n"
    rng = np.random.default_rng(0)
    data = head.encode() + rng.normal(size=(255, 3)).astype("<f4").tobytes() + bytes([3, 0, 1, 2])
    append(data, small_fill(read(data)))
    more = data.replace(b"vertex 255", b"vertex 256").replace(b"\3\0\1\2", bytes(12) + b"\3\0\1\2")
    with pytest.raises(FormatError, match="8 bits"):
        append(more, small_fill(read(more)))


@pytest.mark.skipif(not SAMPLES.exists(), reason="pymeshlab came without its sample meshes")
def test_colours_and_qualities_of_a_real_scan_survive_and_spread() -> None:
    original = (SAMPLES / "colored_airplane.ply").read_bytes()
    data = with_hole_cut(original)
    repaired, scan, fill = append(data)
    again = read(repaired)
    n = len(scan.vertices)
    rim = np.unique(fill.triangles[fill.triangles < n])
    assert len(fill.vertices) > 10
    for name in ("red", "green", "blue", "alpha", "quality"):
        old, new = column(scan, "vertex", name), column(again, "vertex", name)
        assert new[:n].tobytes() == old.tobytes()
        assert (new[n:] >= old[rim].min()).all()
        assert (new[n:] <= old[rim].max()).all()
    assert n_open_edges(again) == 0


def with_hole_cut(data: bytes) -> bytes:
    """Cut 60 triangles out of a binary PLY of triangles."""
    scan = read(data)
    rows = element(scan, "face")
    left = cut_hole(scan, 1000, 60)
    table = np.frombuffer(data, np.uint8)[rows.start : rows.stop].reshape(len(scan.triangles), -1)[left]
    old = f"element face {len(scan.triangles)}\n".encode()
    new = f"element face {len(left)}\n".encode()
    return data[: rows.start].replace(old, new) + table.tobytes() + data[rows.stop :]


def test_elements_that_mean_nothing_to_a_repair_keep_their_bytes() -> None:
    path = SAMPLES / "rangemaps" / "face000.ply"
    if not path.exists():
        pytest.skip("pymeshlab came without its sample meshes")
    data, scan, _ = append(path.read_bytes(), EMPTY)
    camera = element(scan, "camera")
    assert path.read_bytes()[camera.start : camera.stop] in data
