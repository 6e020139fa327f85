"""What this worker can do that others may not: it depends on the extras that are installed."""

from importlib.util import find_spec

from jobkit.queue import NETWORKS
from quadpatch_rules.extras import OF_NETWORKS


def abilities() -> frozenset[str]:
    """Return what this worker can do, as `jobkit.queue` names it; nothing is loaded."""
    return frozenset({NETWORKS}) if all(find_spec(package) for package in OF_NETWORKS) else frozenset()
