from pathlib import Path

import pytest

from quadpatch.compression.encode import EncodeOptions
from quadpatch.errors import FormatError, ReadError
from quadpatch.formats.reading import read_scan
from quadpatch.tasks.decode import decode_file
from quadpatch.tasks.encode import encode_file
from tests.quadpatch.shapes import sphere, write_ply


@pytest.fixture(scope="module")
def encoded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("encoded")
    source = write_ply(folder / "in.ply", sphere(2))
    encode_file(source, folder / "a.qpz", options=EncodeOptions(0.02))
    return folder / "a.qpz"


@pytest.mark.parametrize("suffix", ["ply", "stl", "obj", "off", "glb", "3mf"])
def test_every_format_that_is_written_holds_the_decoded_mesh(encoded: Path, tmp_path: Path, suffix: str) -> None:
    report = decode_file(encoded, tmp_path / f"out.{suffix}").report
    assert len(read_scan(tmp_path / f"out.{suffix}").triangles) == report["decoded"]["triangles"]


def test_decoding_twice_gives_the_same_bytes(encoded: Path, tmp_path: Path) -> None:
    for name in ("a.ply", "b.ply"):
        decode_file(encoded, tmp_path / name)
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()


def test_another_file_is_no_qpz_file(encoded: Path, tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"no \.qpz file"):
        decode_file(encoded.parent / "in.ply", tmp_path / "out.ply")
    with pytest.raises(ReadError, match="can't be read"):
        decode_file(tmp_path / "nothing.qpz", tmp_path / "out.ply")
    with pytest.raises(FormatError):
        decode_file(encoded, tmp_path / "out.qpz")


def test_a_damaged_file_writes_nothing(encoded: Path, tmp_path: Path) -> None:
    data = bytearray(encoded.read_bytes())
    data[-1] ^= 1
    (tmp_path / "bad.qpz").write_bytes(bytes(data))
    with pytest.raises(ReadError, match="damaged"):
        decode_file(tmp_path / "bad.qpz", tmp_path / "out.ply")
    assert not (tmp_path / "out.ply").exists()
