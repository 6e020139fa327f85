import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from jobkit.errors import StoreUnavailableError
from jobkit.storage.local import LocalStore
from jobkit.storage.open import open_store


def files_below(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file()]


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 64 KiB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(folder)], check=False, capture_output=True
    )
    if mounted.returncode:
        pytest.skip("file systems can't be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_full_disk_is_told_as_such_and_nothing_half_written_stays(small_disk: Path) -> None:
    store = LocalStore(small_disk)
    (small_disk / "large").symlink_to("/dev/zero")
    with pytest.raises(StoreUnavailableError, match="the object store has no space left"):
        store.put_file("meshes/large", small_disk / "large")
    (small_disk / "large").unlink()
    assert files_below(small_disk) == []
    store.check()


def test_a_disk_without_room_for_a_byte_does_not_pass_the_check(small_disk: Path) -> None:
    store = LocalStore(small_disk)
    with (small_disk / "ballast").open("wb", buffering=0) as ballast:
        while ballast.tell() < 64 << 10 and _grows(ballast):
            pass
    with pytest.raises(StoreUnavailableError, match="no space left"):
        store.check()
    (small_disk / "ballast").unlink()
    store.check()


def _grows(file: object) -> bool:
    try:
        return bool(file.write(b"0" * 4096))  # type: ignore[attr-defined]
    except OSError:
        return False


def test_a_disk_that_refuses_writes_is_told_as_such(small_disk: Path) -> None:
    store = LocalStore(small_disk)
    with store.writer("meshes") as writer:
        writer.write(b"0")
        key = writer.commit().key
    subprocess.run(["mount", "-o", "remount,ro", str(small_disk)], check=True)
    for refused in (store.check, lambda: store.delete(key), lambda: store.delete_prefix("meshes")):
        with pytest.raises(StoreUnavailableError, match="refuses to be written"):
            refused()
    assert b"".join(store.read(key)) == b"0"
    assert b"".join(LocalStore(small_disk).read(key)) == b"0"


def test_a_store_whose_folder_is_gone_is_no_empty_store(tmp_path: Path) -> None:
    store = LocalStore(tmp_path / "objects")
    shutil.rmtree(tmp_path / "objects")
    calls = (store.check, lambda: store.size("meshes/a"), lambda: store.read("meshes/a"), lambda: list(store.keys()))
    for call in calls:
        with pytest.raises(StoreUnavailableError, match="is not there"):
            call()


def test_a_store_that_can_not_be_made_fails_when_it_is_used(tmp_path: Path) -> None:
    (tmp_path / "objects").write_bytes(b"a file, not a folder")
    store = LocalStore(tmp_path / "objects")
    with pytest.raises(StoreUnavailableError):
        store.check()


def test_a_store_may_lie_in_a_folder_with_a_blank_in_its_name(tmp_path: Path) -> None:
    store = open_store(f"file://{tmp_path}/my%20objects")
    store.check()
    assert (tmp_path / "my objects").is_dir()


KILLED = """
import os, signal, sys
from pathlib import Path
from jobkit.storage.local import LocalStore
writer = LocalStore(Path(sys.argv[1])).writer("meshes")
writer.write(b"0" * 100_000)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_the_next_process_removes_what_a_killed_writer_left_and_nothing_of_living_ones(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], check=False)
    assert len(files_below(tmp_path)) == 1
    store = LocalStore(tmp_path)
    assert files_below(tmp_path) == []
    with store.writer("meshes") as writer:
        writer.write(b"alive")
        LocalStore(tmp_path)
        stored = writer.commit()
    assert files_below(tmp_path) == [tmp_path / stored.key]
