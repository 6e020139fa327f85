"""How a transfer tells its caller how far it is.

Tested in `tests/quadpatch_client/test_transfers.py`.
"""

from collections.abc import Callable

# Called with the bytes done so far and the bytes in all.
ByteProgress = Callable[[int, int], None]


def no_progress(done: int, total: int) -> None:
    """Ignore progress."""
