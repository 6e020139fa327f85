"""OFF in, OFF out."""

import numpy as np
import pytest

from quadpatch.errors import EmptyMeshError, FormatError, IndexRangeError, ReadError, TooLargeError
from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.off import read_off
from quadpatch.formats.scan import Fill, Scan
from tests.quadpatch.formats.fills import appended

SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"


def read(text: str) -> Scan:
    return read_off(text.encode(), ReadLimits())


def append(text: str) -> str:
    """A pyramid over the vertices 0, 1, 2, 3."""
    scan = read(text)
    new = len(scan.vertices)
    triangles = np.array([[1, 0, new], [2, 1, new], [3, 2, new], [0, 3, new]])
    hole = np.zeros(4, np.int64)
    fill = Fill(np.array([[0.5, 0.5, 1.0]]), triangles, hole[:1], np.ones(1), hole, np.ones(4))
    return appended(scan, fill).decode()


FACES = "3 1 0 4\n3 2 1 4\n3 3 2 4\n3 0 3 4\n"


@pytest.mark.parametrize("head", ["OFF\n4 1 0\n", "OFF 4 1 0\n", "4 1 0\n", "# by hand\n\nOFF # kind\n4 1\n"])
def test_the_counts_are_found_in_every_notation(head: str) -> None:
    assert read(f"{head}{SQUARE}4 0 1 2 3\n").triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_all_lines_stay_but_the_counts() -> None:
    text = "OFF\n# a square\n 4  1 0 # 4 1\n0 0 0 # first\n1 0 0\n\n1 1 0\n0 1 0\n# faces\n4 0 1 2 3  # all\n# end\n"
    repaired = append(text)
    old, new = text.splitlines(), repaired.splitlines()
    assert new[2] == " 5  5 0 # 4 1"
    assert [line for line in new if line in old] == [line for i, line in enumerate(old) if i != 2]
    assert new[8] == "0.5 0.5 1.0"
    assert "\n".join(new[11:15]) + "\n" == FACES
    assert len(read(repaired).triangles) == 6


def test_a_file_without_a_last_line_end_gets_one() -> None:
    assert append(f"OFF\n4 1 0\n{SQUARE}4 0 1 2 3").endswith(f"4 0 1 2 3\n{FACES}")


def test_line_ends_of_the_file_are_kept() -> None:
    text = f"OFF\n4 1 0\n{SQUARE}4 0 1 2 3\n".replace("\n", "\r\n")
    assert append(text).replace("\r\n", "").find("\n") == -1


def test_vertex_colours_spread_and_face_colours_are_those_of_the_neighbour() -> None:
    vertices = "0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n1 1 0 0 0 100 255\n0 1 0 0 0 100 255\n"
    repaired = append(f"COFF\n4 1 0\n{vertices}4 0 1 2 3 0.5 0.25 1\n")
    assert "\n0.5 0.5 1.0 128 0 50 255\n" in repaired
    assert repaired.count(" 0.5 0.25 1\n") == 5


def test_normals_of_new_vertices_are_those_of_the_new_surface() -> None:
    vertices = "".join(f"{line} 0 0 -1\n" for line in SQUARE.splitlines())
    assert "\n0.5 0.5 1.0 0.0 0.0 -1.0\n" in append(f"NOFF\n4 1 0\n{vertices}4 0 1 2 3\n")


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("OFF\n", ReadError),
        ("OFF\n4\n", ReadError),
        ("OFF\n-4 1 0\n", ReadError),
        ("OFF\n0 0 0\n", EmptyMeshError),
        (f"OFF\n4 0 0\n{SQUARE}", EmptyMeshError),
        (f"OFF\n99999999999999 1 0\n{SQUARE}", TooLargeError),
        (f"OFF\n4 5 0\n{SQUARE}3 0 1 2\n", ReadError),
        (f"OFF\n4 1 0\n{SQUARE}3 0 1 4\n", IndexRangeError),
        (f"OFF\n4 1 0\n{SQUARE}3 0 1\n", ReadError),
        (f"OFF\n4 1 0\n{SQUARE}3 0 1 1.5\n", ReadError),
        (f"OFF\n4 1 0\n{SQUARE}nan 0 1 2\n", ReadError),
        (f"OFF\n4 1 0\n{SQUARE[:-3]}\n3 0 1 2\n", ReadError),
        (f"OFF BINARY\n4 1 0\n{SQUARE}3 0 1 2\n", FormatError),
        (f"4OFF\n4 1 0\n{SQUARE}3 0 1 2\n", FormatError),
    ],
)
def test_wrong_files_are_refused(text: str, error: type[Exception]) -> None:
    with pytest.raises(error):
        read(text)
