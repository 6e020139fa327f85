"""The memory of the machine of this process: what it may take in all, and what is free now.

Both are the least of what the host has and of what control groups leave, version 1 or 2: those of this process and all
above it. Pages of files count as free, since the kernel drops them when memory is short.
"""

from collections.abc import Iterator
from pathlib import Path

import psutil

from jobkit.jobs.reservations import MachineMemory

_MIB = 1 << 20
# Limit and usage of a group, and the prefix of what counts its descendants, too; by controller: "" is version 2.
_FILES = {
    "": ("memory.max", "memory.current", ""),
    "memory": ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_"),
}
_MOUNTS = {"": ("sys/fs/cgroup", "sys/fs/cgroup/unified"), "memory": ("sys/fs/cgroup/memory",)}


def machine_memory(most_mb: int = 0, root: Path = Path("/")) -> MachineMemory:
    """Measure the memory.

    Parameters
    ----------
    most_mb : int
        Limit of the operator, in MiB; 0: none.
    root : Path
        Where `proc/self/cgroup` and `sys/fs/cgroup` lie.
    """
    host = psutil.virtual_memory()
    rooms = [(host.total, host.available), *_group_rooms(root, host.total)]
    limit_mb, free_mb = (min(figures) // _MIB for figures in zip(*rooms, strict=True))
    return MachineMemory(min(limit_mb, most_mb or limit_mb), free_mb)


def _group_rooms(root: Path, total: int) -> Iterator[tuple[int, int]]:
    """Yield limit and free bytes of each control group that limits this process to less than `total`."""
    for folder, controller in _group_folders(root):
        limit_name, usage_name, prefix = _FILES[controller]
        try:
            limit = (folder / limit_name).read_text().strip()
            if limit == "max" or int(limit) >= total:
                continue
            usage, pages = int((folder / usage_name).read_text()), (folder / "memory.stat").read_text()
        except OSError:
            continue  # the root group has no limit, and a container may not see the groups above its own
        counts = dict(line.split() for line in pages.splitlines())
        of_files = sum(int(counts.get(f"{prefix}{name}_file", 0)) for name in ("active", "inactive"))
        yield int(limit), max(int(limit) - usage + of_files, 0)


def _group_folders(root: Path) -> Iterator[tuple[Path, str]]:
    """Yield the folders of the memory groups of this process, from its own upwards, and their controller."""
    try:
        lines = (root / "proc/self/cgroup").read_text().splitlines()
    except OSError:
        return  # not Linux
    for line in lines:
        _, controllers, path = line.split(":", 2)
        controller = next((name for name in _MOUNTS if name in controllers.split(",")), None)
        for mount in _MOUNTS.get(controller, ()) if controller is not None else ():
            own = root / mount / path.lstrip("/")
            # Inside a container the path may be that of the host: then its own group lies at the mount itself.
            for folder in (own, *own.parents):
                yield folder, str(controller)
                if folder == root / mount:
                    break
