"""Which tests run in one process of `pytest -n`: those of a file, and all that share the local stack. Longest first."""

from typing import Any

from xdist.scheduler import LoadFileScheduling

_LOCAL_STACK = "tests/integration/"
# What takes longest has few tests, so that xdist would begin it last, and one core would wait for it in the end.
LONGEST = (
    _LOCAL_STACK,
    "tests/faults/test_faults.py",
    "tests/contract/test_schemathesis.py",
    "tests/quadpatch/test_repair_by_fitting.py",
    "tests/training/test_network_run.py",
    "tests/training/test_processes.py",
)


class SharingScheduling(LoadFileScheduling):  # type: ignore[misc]  # xdist carries no types
    """Like `--dist loadfile`, with one local stack: each process would start one of its own, with its workers."""

    def _split_scope(self, nodeid: str) -> str:
        return _LOCAL_STACK if nodeid.startswith(_LOCAL_STACK) else str(super()._split_scope(nodeid))

    def _assign_work_unit(self, node: Any) -> None:
        self.workqueue.move_to_end(min(self.workqueue, key=_place), last=False)
        super()._assign_work_unit(node)


def _place(scope: str) -> int:
    return LONGEST.index(scope) if scope in LONGEST else len(LONGEST)
