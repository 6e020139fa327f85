"""Child processes that never outlive the process that started them.

A supervisor that is killed with SIGKILL can't clean up; the kernel can. On Linux every child asks for a signal on
its parent's death. Elsewhere only the orderly way out, a signal forwarded by the supervisor, stops the children.
"""

import ctypes
import os
import signal
import sys
from collections.abc import Callable

_PR_SET_PDEATHSIG = 1


def leash(death_signal: signal.Signals = signal.SIGTERM) -> Callable[[], None]:
    """Make a `preexec_fn` that ties a child to this process.

    The kernel watches the *thread* that forks, so start children from the main thread only. The C library is
    loaded here, before the fork: nothing but two system calls is left to do between fork and exec.

    Parameters
    ----------
    death_signal : signal.Signals
        What the child gets when its parent is gone.
    """
    parent = os.getpid()
    libc = ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None

    def tie() -> None:
        if libc is None:
            return
        libc.prctl(_PR_SET_PDEATHSIG, int(death_signal), 0, 0, 0)
        # The parent may have died before the call above: no signal will come any more.
        if os.getppid() != parent:
            os._exit(1)

    return tie
