"""How the C library keeps memory that was freed."""

import ctypes
import sys

# As malloc.h numbers it.
_M_MMAP_THRESHOLD = -3
LARGE_BYTES = 1 << 20


def return_large_buffers() -> None:
    """Let buffers of a MiB and more go back to the kernel as soon as they are freed.

    glibc raises that limit by itself to the largest buffer that was ever freed. Parts of uploads to S3 have 8 MiB; kept
    for reuse between others, they left gaps, and the process grew with the length of an upload. Does nothing where the
    C library is another one.
    """
    if sys.platform != "linux":
        return
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_M_MMAP_THRESHOLD, LARGE_BYTES)
