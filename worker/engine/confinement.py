"""Confines an engine child: it parses untrusted meshes with native code, and a mesh may exploit a fault in it.

A confined child reaches the folder of its request, the mesh, the model and the libraries, and nothing else: no other
file, no socket, no other process and nothing of theirs in `/proc`. Landlock and seccomp do it, where the kernel has
them; `weaknesses` says what is missing.

Tested in `tests/attacks/test_f_engine.py`.
"""

import os
import sys
import sysconfig
from pathlib import Path

import quadpatch
import quadpatch_rules
from worker.engine.landlock import landlock_version, restrict_files
from worker.engine.request import EngineRequest
from worker.engine.seccomp import has_seccomp, restrict_calls

_SYSTEM = (
    "/usr",
    "/lib",
    "/lib64",
    "/etc/ld.so.cache",
    "/etc/localtime",
    "/etc/fonts",
    "/etc/nsswitch.conf",
    "/etc/passwd",
)
# What numerical libraries ask about the machine before they start their threads.
_MACHINE = (
    "/proc/self",
    "/proc/cpuinfo",
    "/proc/meminfo",
    "/proc/stat",
    "/sys/devices",
    "/sys/fs/cgroup",
)
_DEVICES = ("/dev/urandom", "/dev/random", "/dev/zero")
_WRITABLE_DEVICES = ("/dev/null", "/dev/full")


def confine(folder: Path, request: EngineRequest) -> None:
    """Confine this process, before it opens the mesh.

    Parameters
    ----------
    folder : Path
        Of the request; the one place where it may write.
    request : EngineRequest
    """
    restrict_files(
        [*_library_folders(), *map(Path, (*_SYSTEM, *_MACHINE, *_DEVICES)), *_inputs(folder, request)],
        [folder, *map(Path, _WRITABLE_DEVICES)],
    )
    restrict_calls()


def weaknesses() -> list[str]:
    """Return a sentence for each means of confinement that this kernel lacks."""
    missing = [] if landlock_version() else ["no Landlock: engines can read the files of the worker's user"]
    return missing if has_seccomp() else [*missing, "no seccomp filters: engines can open sockets and start processes"]


def _library_folders() -> list[Path]:
    """Return where Python, its packages and the method lie: never a whole working folder, which may hold the data."""
    places = [
        sys.prefix,
        sys.base_prefix,
        *sysconfig.get_paths().values(),
        *os.environ.get("LD_LIBRARY_PATH", "").split(":"),
        *os.environ.get("PYTHONPATH", "").split(":"),
    ]
    packages = [path for path in sys.path if Path(path).name in ("site-packages", "dist-packages")]
    beside = Path(__file__).parents[2]
    packages_of_ours = [Path(str(package.__file__)).parent for package in (quadpatch, quadpatch_rules)]
    own = [*packages_of_ours, *(beside / name for name in ("worker", "training"))]
    return [
        *own,
        *(Path(place) for place in (*places, *packages) if Path(place).is_absolute() and Path(place) != Path("/")),
    ]


def _inputs(folder: Path, request: EngineRequest) -> list[Path]:
    """Return the files outside the folder that the request names: meshes, which may be linked, and the model."""
    model = [Path(request.model)] if os.path.isabs(request.model) else []
    meshes = [name for name in (request.source, request.reference, *request.meshes.values()) if name]
    return [*((folder / name).resolve() for name in meshes), *model]
