"""Which tests run in the same process of `pytest -n`: those of a file, and all that share the one box."""

from xdist.scheduler import LoadFileScheduling

_BOX = "tests/integration/"


class SharingScheduling(LoadFileScheduling):
    """Like `--dist loadfile`, with one box: each process would start one of its own, with its workers."""

    def _split_scope(self, nodeid: str) -> str:
        return _BOX if nodeid.startswith(_BOX) else str(super()._split_scope(nodeid))
