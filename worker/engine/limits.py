"""Ceilings of an engine child, set by itself before it touches a file.

Tested in `tests/worker/engine/test_supervision.py`.
"""

import math
import os
import resource
from dataclasses import dataclass

_MIB = 1024 * 1024
# Mappings that are reserved but not yet used (thread stacks, allocator arenas) count here, though not as memory.
_DATA_SLACK_MB = 512
_CPU_SLACK_S = 60
_NICENESS = 5
# Of all processes and threads of the user, whom many workers may share: it stops a flood, where seccomp stops each one.
_MAX_PROCESSES = 8192


@dataclass(frozen=True)
class EngineLimits:
    """What one engine child may use.

    Attributes
    ----------
    time_s : float
        Wall-clock seconds; kept by the parent.
    memory_mb : int
        Resident memory in MiB; kept by the parent. The kernel refuses allocations some way above it.
    file_mb : int
        Size of the largest file that it may write, in MiB.
    n_threads : int
        Threads of numerical libraries.
    n_processes : int
        Processes that share one repair.
    """

    time_s: float
    memory_mb: int
    file_mb: int = 8192
    n_threads: int = 2
    n_processes: int = 1

    def apply(self) -> None:
        """Put the limits that the kernel keeps on this very process."""
        _lower(resource.RLIMIT_CORE, 0)
        _lower(resource.RLIMIT_DATA, (self.memory_mb + _DATA_SLACK_MB) * _MIB)
        _lower(resource.RLIMIT_NPROC, _MAX_PROCESSES)
        _lower(resource.RLIMIT_FSIZE, self.file_mb * _MIB)
        # For a child whose parent hangs: the parent limits wall-clock time.
        _lower(resource.RLIMIT_CPU, math.ceil(self.time_s * self.n_threads) + _CPU_SLACK_S)
        os.nice(_NICENESS)


def thread_environment(n_threads: int) -> dict[str, str]:
    """Environment that bounds the thread pools of numerical libraries; read by them once, when they are loaded."""
    names = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS", "TBB_NUM_THREADS")
    # Matrices of repairs are small: threads of numpy's BLAS would wait for each other.
    return {**dict.fromkeys(names, str(n_threads)), "OPENBLAS_NUM_THREADS": "1"}


def _lower(kind: int, wanted: int) -> None:
    """Lower a limit, never raise it: a container may have set a tighter one."""
    _, hard = resource.getrlimit(kind)
    limit = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
    resource.setrlimit(kind, (limit, limit))
