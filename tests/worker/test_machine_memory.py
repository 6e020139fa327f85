from pathlib import Path

import psutil
import pytest

from worker.machine_memory import machine_memory

MIB = 1 << 20


def write(root: Path, **files: str) -> None:
    for name, text in files.items():
        path = root / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def group(root: Path, folder: str, limit: str, used_mb: int, file_pages_mb: int = 0) -> None:
    """Write a group of version 2."""
    path = root / "sys/fs/cgroup" / folder
    path.mkdir(parents=True, exist_ok=True)
    (path / "memory.max").write_text(limit + "\n")
    (path / "memory.current").write_text(f"{used_mb * MIB}\n")
    stat = f"anon 1\nactive_file {file_pages_mb * MIB}\ninactive_file 0\n"
    (path / "memory.stat").write_text(stat)


def test_without_groups_it_is_the_memory_of_the_host(tmp_path: Path) -> None:
    found = machine_memory(root=tmp_path)
    assert found.limit_mb == psutil.virtual_memory().total // MIB
    assert 0 < found.free_mb < found.limit_mb


def test_the_operator_may_allow_less(tmp_path: Path) -> None:
    whole = machine_memory(root=tmp_path)
    assert machine_memory(300, tmp_path).limit_mb == 300
    assert machine_memory(2 * whole.limit_mb, tmp_path).limit_mb == whole.limit_mb


@pytest.mark.parametrize("place", ["system.slice/worker.service", "system.slice", ""])
def test_a_limit_holds_for_its_group_and_all_below_it(tmp_path: Path, place: str) -> None:
    write(tmp_path, proc__self__cgroup="0::/system.slice/worker.service\n")
    group(tmp_path, "system.slice/worker.service", "max", 50)
    group(tmp_path, "system.slice", "max", 50)
    group(tmp_path, place, str(100 * MIB), 80, 30)
    found = machine_memory(root=tmp_path)
    assert (found.limit_mb, found.free_mb) == (100, 50)


def test_the_tightest_group_counts(tmp_path: Path) -> None:
    write(tmp_path, proc__self__cgroup="0::/a/b\n")
    group(tmp_path, "a", str(200 * MIB), 190)
    group(tmp_path, "a/b", str(100 * MIB), 20)
    found = machine_memory(root=tmp_path)
    assert (found.limit_mb, found.free_mb) == (100, 10)


def test_a_full_group_has_nothing_left(tmp_path: Path) -> None:
    write(tmp_path, proc__self__cgroup="0::/\n")
    group(tmp_path, "", str(100 * MIB), 101)
    assert machine_memory(root=tmp_path).free_mb == 0


@pytest.mark.parametrize("place", ["docker/4f1c", ""])
def test_version_1_counts_like_version_2(tmp_path: Path, place: str) -> None:
    """Inside a container the path is that of the host, and the group lies at the mount."""
    write(tmp_path, proc__self__cgroup="9:name=systemd:/docker/4f1c\n4:cpu,memory:/docker/4f1c\n0::/docker/4f1c\n")
    folder = tmp_path / "sys/fs/cgroup/memory" / place
    folder.mkdir(parents=True)
    (folder / "memory.limit_in_bytes").write_text(f"{100 * MIB}\n")
    (folder / "memory.usage_in_bytes").write_text(f"{60 * MIB}\n")
    pages = f"active_file 0\ntotal_active_file {5 * MIB}\ntotal_inactive_file {10 * MIB}\n"
    (folder / "memory.stat").write_text(pages)
    found = machine_memory(root=tmp_path)
    assert (found.limit_mb, found.free_mb) == (100, 55)


def test_version_1_without_a_limit_is_no_limit(tmp_path: Path) -> None:
    write(tmp_path, proc__self__cgroup="4:memory:/\n")
    folder = tmp_path / "sys/fs/cgroup/memory"
    folder.mkdir(parents=True)
    (folder / "memory.limit_in_bytes").write_text("9223372036854771712\n")
    assert machine_memory(root=tmp_path).limit_mb == psutil.virtual_memory().total // MIB


def test_the_memory_of_this_machine_can_be_measured() -> None:
    found = machine_memory()
    assert 0 < found.free_mb <= found.limit_mb
