"""The garbage collector of a process that works on one mesh and ends.

Tested in `tests/quadpatch_rules/test_garbage_collection.py`.
"""

import gc

_THRESHOLDS = (200_000, 20, 100)


def collect_seldom() -> None:
    """Look for cycles among new objects less often, and never again among those that are there.

    Scans of a million pieces make millions of small objects that stay to the end: by Python's own thresholds the search
    takes a quarter of the time.
    """
    gc.freeze()
    gc.set_threshold(*_THRESHOLDS)
