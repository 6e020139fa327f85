"""What the processes of one user hide from each other."""

import ctypes
import sys

_PR_SET_DUMPABLE = 4


def hide_memory() -> None:
    """Close this process's memory and environment, which hold secrets, to others of the same user.

    On Linux `/proc/PID/environ`, `/proc/PID/mem` and debuggers are then for root alone, and no core is dumped. Programs
    that it starts are as open as any other until they call this themselves.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_DUMPABLE, 0, 0, 0, 0)
