import pytest

from quadpatch.errors import FormatError, ReadError
from quadpatch.formats.detection import KNOWN, detect_format

CONTENTS: dict[str, bytes] = {
    "ply": b"ply\nformat ascii 1.0\n",
    "stl": b"solid part\n facet normal 0 0 1\n",
    "obj": b"# made by hand\nv 0 0 0\n",
    "off": b"# made by hand\nOFF\n3 1 0\n",
    "glb": b"glTF\x02\0\0\0",
    "gltf": b'{"asset": {"version": "2.0"}}',
    "3mf": b"PK\x03\x04 3D/3dmodel.model",
}


def test_there_is_a_sample_of_each_format() -> None:
    assert CONTENTS.keys() == set(KNOWN)


@pytest.mark.parametrize("suffix", ["", "txt", *KNOWN])
@pytest.mark.parametrize("name", KNOWN)
def test_the_content_alone_says_the_format(name: str, suffix: str) -> None:
    assert detect_format(CONTENTS[name], suffix) == name


def test_a_binary_stl_may_begin_like_an_ascii_one() -> None:
    assert detect_format(b"solid".ljust(80) + (1).to_bytes(4, "little") + bytes(50), "") == "stl"


def test_the_suffix_counts_where_the_content_leaves_it_open() -> None:
    assert detect_format(b"something else", "off") == "off"
    with pytest.raises(FormatError, match="none of the formats"):
        detect_format(b"something else", "docx")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"PK\x03\x04 scan.ply", "zip archive"),
        (b"<?xml version='1.0'?><COLLADA>", "COLLADA"),
        (b"Kaydara FBX Binary  \0", "FBX"),
        (b"# vtk DataFile Version 3.0\n", "VTK"),
    ],
)
def test_known_formats_that_are_not_read_are_named_whatever_the_suffix(content: bytes, message: str) -> None:
    with pytest.raises(FormatError, match=message):
        detect_format(content, "ply")


@pytest.mark.parametrize("content", [b"", b" \r\n\t", b"\0" * 100])
def test_a_file_without_content_is_empty(content: bytes) -> None:
    with pytest.raises(ReadError, match="empty"):
        detect_format(content, "stl")
