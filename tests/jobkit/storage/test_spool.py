import errno
import hashlib
from pathlib import Path

import pytest

from jobkit.errors import StoreUnavailableError, TooLargeError
from jobkit.storage.scratch import ScratchFolder
from jobkit.storage.spool import SpoolingWriter, translated_os_errors

DATA = b"ply\n" * 1000


@pytest.fixture
def kept() -> dict[str, bytes]:
    return {}


def writer(folder: Path, kept: dict[str, bytes], max_bytes: int | None = None) -> SpoolingWriter:
    def keep(path: Path, key: str) -> None:
        kept[key] = path.read_bytes()

    return SpoolingWriter(ScratchFolder(folder), keep, "meshes", max_bytes)


def files(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file()]


def test_what_is_committed_is_counted_hashed_and_whole(tmp_path: Path, kept: dict[str, bytes]) -> None:
    with writer(tmp_path, kept, len(DATA)) as spool:
        spool.write(DATA[:7])
        spool.write(DATA[7:])
        stored = spool.commit()
    assert (stored.size_bytes, stored.sha256) == (len(DATA), hashlib.sha256(DATA).hexdigest())
    assert kept == {stored.key: DATA}
    assert stored.sha256 in stored.key


def test_what_is_not_committed_is_thrown_away(tmp_path: Path, kept: dict[str, bytes]) -> None:
    with writer(tmp_path, kept) as spool:
        spool.write(DATA)
        assert files(tmp_path) != []
    assert kept == {}
    assert [path for path in files(tmp_path) if path.read_bytes()] == []


def test_one_byte_over_the_limit_is_refused(tmp_path: Path, kept: dict[str, bytes]) -> None:
    with writer(tmp_path, kept, 10) as spool:
        spool.write(bytes(10))
        with pytest.raises(TooLargeError, match="more than 10 bytes"):
            spool.write(b"x")
    assert kept == {}


@pytest.mark.parametrize(
    ("code", "message"),
    [
        (errno.ENOENT, "is not there"),
        (errno.ENOSPC, "no space left"),
        (errno.EROFS, "refuses to be written"),
        (errno.EIO, "can't be used"),
    ],
)
def test_what_the_disk_refuses_is_said_without_the_path(code: int, message: str) -> None:
    with pytest.raises(StoreUnavailableError, match=message) as caught, translated_os_errors():
        raise OSError(code, "words", "/secret/place")
    assert "secret" not in str(caught.value)
