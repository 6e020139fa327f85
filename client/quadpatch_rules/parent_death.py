"""Processes that never outlive the process that started them.

A parent that is killed with SIGKILL can't clean up; the kernel can. On Linux a child asks for a signal on its
parent's death. Elsewhere children stop only when the parent passes a signal on.

Tested in `tests/quadpatch/test_processes.py`.
"""

import ctypes
import os
import signal
import sys
from collections.abc import Callable

_PR_SET_PDEATHSIG = 1


def parent_death_signal(parent: int, death_signal: signal.Signals = signal.SIGTERM) -> Callable[[], None]:
    """Make a function that ties the process it is called in to its parent.

    It is fit to be a `preexec_fn`: the C library is loaded here, before the fork, and nothing but two system calls
    is left to do between fork and exec. The kernel watches the *thread* that forks, so start children from a thread
    that lives as long as the parent does.

    Parameters
    ----------
    parent : int
        Process id of the parent-to-be.
    death_signal : signal.Signals
        Sent to the child when its parent has ended.
    """
    libc = ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None

    def set_death_signal() -> None:
        if libc is None:
            return
        libc.prctl(_PR_SET_PDEATHSIG, int(death_signal), 0, 0, 0)
        # The parent may have ended before the call above: then no signal comes.
        if os.getppid() != parent:
            os._exit(1)

    return set_death_signal
