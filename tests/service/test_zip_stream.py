import io
import random
import shutil
import subprocess
import tracemalloc
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from service.zip_stream import Entry, zip_stream

MB = 1 << 20


def test_what_comes_out_is_what_went_in() -> None:
    contents = {"a.ply": b"one", "b/ü.ply": random.Random(0).randbytes(3 * MB), "empty.csv": b""}
    entries = [Entry(name, len(data), [data[:MB], data[MB:]]) for name, data in contents.items()]
    archive = zipfile.ZipFile(io.BytesIO(b"".join(zip_stream(entries))))
    assert archive.testzip() is None
    assert {name: archive.read(name) for name in archive.namelist()} == contents


def test_other_readers_open_it(tmp_path: Path) -> None:
    path = tmp_path / "all.zip"
    path.write_bytes(b"".join(zip_stream([Entry("scan.ply", 5 << 30, [b"x" * MB])])))
    reader = shutil.which("unzip")
    if reader is None:
        pytest.skip("there is no unzip")
    done = subprocess.run([reader, "-t", str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    assert "scan.ply" in done.stdout


def test_a_large_entry_says_its_size_in_64_bits() -> None:
    whole = b"".join(zip_stream([Entry("large.ply", 5 << 30, [b"x"])]))
    # The extra field 0x0001 of the local header, which stands before the bytes.
    assert whole[30 + len("large.ply") :][:2] == b"\x01\x00"
    assert zipfile.ZipFile(io.BytesIO(whole)).read("large.ply") == b"x"


def test_it_is_written_as_it_is_read_and_nothing_of_it_is_kept() -> None:
    def chunks() -> Iterator[bytes]:
        for _ in range(64):
            yield bytes(MB)

    tracemalloc.start()
    try:
        n_bytes = sum(len(piece) for piece in zip_stream(Entry(f"{i}.ply", 64 * MB, chunks()) for i in range(2)))
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert n_bytes > 128 * MB
    assert peak < 8 * MB


def test_an_error_leaves_an_archive_that_no_reader_takes_for_whole() -> None:
    def broken() -> Iterator[bytes]:
        yield b"half"
        raise OSError("the disk is gone")

    received: list[bytes] = []
    with pytest.raises(OSError, match="gone"):
        received.extend(zip_stream([Entry("a.ply", 3, [b"one"]), Entry("b.ply", 9, broken())]))
    with pytest.raises(zipfile.BadZipFile):
        zipfile.ZipFile(io.BytesIO(b"".join(received)))
