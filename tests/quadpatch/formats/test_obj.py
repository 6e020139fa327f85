"""OBJ in, OBJ out: all lines as they were, and a group behind them."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.errors import EmptyMeshError, IndexRangeError, ReadError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.obj import read_obj
from quadpatch.formats.obj_source import ObjSource
from quadpatch.formats.scan import Fill, Scan
from tests.quadpatch.formats.fills import SAMPLES, cap_holes, cut_hole, n_open_edges

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def read(data: bytes | str) -> Scan:
    return read_obj(data.encode() if isinstance(data, str) else data, ReadLimits())


def source(scan: Scan) -> ObjSource:
    assert isinstance(scan.source, ObjSource)
    return scan.source


def lid(scan: Scan) -> Fill:
    """A pyramid over the vertices 0, 1, 2, 3."""
    new = len(scan.vertices)
    triangles = np.array([[1, 0, new], [2, 1, new], [3, 2, new], [0, 3, new]])
    hole = np.zeros(4, np.int64)
    return Fill(np.array([[0.5, 0.5, 1.0]]), triangles, hole[:1], np.ones(1), hole, np.ones(4))


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3\nf 1 3 4\n",
        "f 1 2 3 # a comment\n  f\t1  3 4\n",
        "f 1 2 \\\n3\nf 1 3 4\n",
        "f -4 -3 -2\nf -4 -2 -1",
        "f 1// 2// 3//\r\nf 1/ 3/ 4/\r\n",
        "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1\n",
        "l 1 2\np 1\ng a b\ns off\no x\nf 1 2 3\nusemtl m#1\nf 1/9 3/9 4/9\n",
    ],
)
def test_faces_are_read_in_every_notation(faces: str) -> None:
    assert read(SQUARE + faces).triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_negative_indices_count_from_where_they_stand() -> None:
    scan = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 0 1\nv 1 0 1\nv 1 1 1\nf -3 -2 -1\n")
    assert scan.triangles.tolist() == [[0, 1, 2], [3, 4, 5]]


# What the reader takes for a coordinate.
USUAL = st.floats(-1e18, 1e18).filter(lambda number: number == 0 or abs(number) > 1e-37)


@given(st.lists(st.lists(USUAL, min_size=3, max_size=3), min_size=3, max_size=9))
def test_coordinates_of_text_are_exact(points: list[list[float]]) -> None:
    text = "".join("v {!r} {!r} {!r}\n".format(*point) for point in points)
    assert read(text + "f 1 2 3\n").vertices.tolist() == points


@pytest.mark.parametrize("codec", ["utf-16-le", "utf-16-be", "utf-8"])
def test_text_with_a_byte_order_mark_is_read_and_appended_in_its_encoding(codec: str) -> None:
    data = ("\ufeff# größe\r\n" + SQUARE + "f 1 2 3 4").encode(codec)
    scan = read(data)
    repaired = source(scan).append(scan, lid(scan))
    assert repaired.startswith(data)
    assert repaired.decode(codec).endswith("g quadpatch_filled\r\nf 2 1 5\r\nf 3 2 5\r\nf 4 3 5\r\nf 1 4 5\r\n")
    assert len(read(repaired).triangles) == 6


def test_the_text_stays_and_the_fill_is_a_group_with_the_material_around_it() -> None:
    text = f"mtllib a.mtl\n{SQUARE}v 9 9 9\nusemtl far\nf 5 5 5\nusemtl near\nf 1 2 3 4\nusemtl far\n"
    scan = read(text)
    repaired = source(scan).append(scan, lid(scan)).decode()
    tail = "v 0.5 0.5 1.0\ng quadpatch_filled\nusemtl near\nf 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n"
    assert repaired == text + tail


def test_colours_behind_coordinates_spread_to_new_vertices() -> None:
    text = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 0 1\nv 0 1 0 0 0 1\nf 1 2 3 4\n"
    scan = read(text)
    repaired = source(scan).append(scan, lid(scan)).decode()
    assert "\nv 0.5 0.5 1.0 0.5 0.0 0.5\n" in repaired


def test_rim_corners_keep_their_normals_and_new_ones_get_those_of_the_new_surface() -> None:
    scan = read(SQUARE + "vn 0 0 -1\nf 1//1 2//1 3//1 4//1\n")
    repaired = source(scan).append(scan, lid(scan)).decode()
    assert "\nvn 0.0 0.0 -1.0\ng quadpatch_filled\nf 2//1 1//1 5//2\n" in repaired


def test_texture_comes_from_the_chart_that_the_rim_uses_most() -> None:
    # Three faces around the square are in one chart, the fourth is far away in the atlas.
    sides = "v -1 0 0\nv 0 -1 0\nv 1 -1 0\nv 2 0 0\nv 2 1 0\nv 1 2 0\n"
    near = ("0.1 0.1", "0.2 0.1", "0.2 0.2", "0.1 0.2", "0.15 0", "0.3 0.15", "0.15 0.3")
    atlas = "".join(f"vt {point}\n" for point in (*near, "0.9 0.9", "0.95 0.9", "0.9 0.95"))
    faces = "f 1/1 6/5 2/2\nf 2/2 8/6 3/3\nf 3/3 10/7 4/4\nf 4/8 5/9 1/10\n"
    scan = read(SQUARE + sides + atlas + faces)
    repaired = source(scan).append(scan, lid(scan)).decode()
    new = [line.split() for line in repaired.split("f 4/8 5/9 1/10\n")[1].splitlines()]
    points = np.array([[float(word) for word in words[1:]] for words in new if words[0] == "vt"])
    assert len(points) == 5
    assert points.min() >= 0.1
    assert points.max() <= 0.2
    middle = points[np.abs(points - 0.15).sum(axis=1) < 1e-9]
    assert len(middle) == 1


@pytest.mark.skipif(not SAMPLES.exists(), reason="pymeshlab came without its sample meshes")
def test_texture_of_a_real_scan_survives_and_spreads() -> None:
    text = textured_bunny_with_a_hole()
    scan = read(text)
    fill = cap_holes(scan)
    repaired = source(scan).append(scan, fill)
    assert repaired.startswith(text)
    again = read(repaired)
    old, new = source(scan), source(again)
    n_open = n_open_edges(scan)
    assert len(fill.vertices) > 20
    assert n_open_edges(again) < n_open
    corners = new.corner_texture[len(scan.triangles) :]
    assert (corners >= 0).all()
    assert (new.texture[corners] >= old.texture.min(axis=0)).all()
    assert (new.texture[corners] <= old.texture.max(axis=0)).all()
    # No new triangle stretches across the atlas from one chart to another.
    assert np.ptp(new.texture[corners], axis=1).max() < 0.1


def textured_bunny_with_a_hole() -> bytes:
    """Cut 40 faces out of the bunny; its indices are negative, so lines may only leave from the end of the file."""
    text = (SAMPLES / "bunny10k_textured.obj").read_bytes()
    scan = read(text)
    left = set(cut_hole(scan, 700, 40).tolist())
    lines = text.splitlines(keepends=True)
    rows = [i for i, line in enumerate(lines) if line.startswith(b"f ")]
    gone = {line for row, line in enumerate(rows) if row not in left}
    return b"".join(line for i, line in enumerate(lines) if i not in gone)


def test_a_material_file_is_never_opened(tmp_path: Path) -> None:
    scan = read(f"mtllib {tmp_path}/none.mtl\nmtllib http://example.invalid/a.mtl\n{SQUARE}f 1 2 3 4\n")
    assert len(scan.triangles) == 2


@pytest.mark.parametrize(
    ("text", "error"),
    [
        (SQUARE + "f 1 2 5\n", IndexRangeError),
        (SQUARE + "f 1 2 0\n", IndexRangeError),
        (SQUARE + "f 1 2 -5\n", IndexRangeError),
        (SQUARE + "f 1 2 x\n", ReadError),
        (SQUARE + "f 1 2 1.5\n", ReadError),
        (SQUARE + "f 1/1/1/1 2 3\n", ReadError),
        (SQUARE + "f /1 2 3\n", ReadError),
        (SQUARE + "f 1 2\n", EmptyMeshError),
        (SQUARE + "f\n", EmptyMeshError),
        ("f 1 2 3\n", EmptyMeshError),
        ("v 0 0\nf 1 1 1\n", ReadError),
        ("v 0 0 zero\nf 1 1 1\n", ReadError),
        (b"\xff\xfev 0", ReadError),
    ],
)
def test_wrong_files_are_refused(text: bytes | str, error: type[Exception]) -> None:
    with pytest.raises(error):
        read(text)


def test_long_indentation_costs_nothing() -> None:
    scan = read(SQUARE + " " * 3_000_000 + "f 1 2 3\n" + "\t" * 40 + "f 1 3 4")
    assert len(scan.triangles) == 2


def test_comments_end_lines_but_not_names() -> None:
    scan = read(SQUARE + "usemtl a#b\nf 1 2 3#4\n#f 1 2 3\nf 1 3 4 # f 1 2 3\n")
    assert len(scan.triangles) == 2
    assert source(scan).materials == [b"a#b"]
    assert re.search(rb"usemtl a#b\nf", source(scan).append(scan, lid(scan)))
