from collections import OrderedDict
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.distribution import LONGEST, SharingScheduling

ROOT = Path(__file__).resolve().parents[1]


class Node:
    """A process of tests, as the scheduler sees it; notes the tests that it was sent."""

    def __init__(self) -> None:
        self.gateway = SimpleNamespace(id="gw0")
        self.sent: list[int] = []

    def send_runtest_some(self, indices: list[int]) -> None:
        self.sent += indices


@pytest.mark.parametrize("scope", LONGEST)
def test_what_begins_first_is_there(scope: str) -> None:
    assert (ROOT / scope).exists()


def test_long_files_begin_first_and_all_of_the_box_stay_together() -> None:
    tests = [
        "tests/jobkit/test_ids.py::test_a",
        "tests/jobkit/test_ids.py::test_b",
        "tests/faults/test_faults.py::test_c",
        "tests/integration/test_demo.py::test_d",
        "tests/integration/test_uploads.py::test_e",
    ]
    scheduling = SharingScheduling(SimpleNamespace(getvalue=lambda _: ["popen"]))
    node = Node()
    scheduling.assigned_work[node] = OrderedDict()
    scheduling.registered_collections[node] = tests
    for test in tests:
        scheduling.workqueue.setdefault(scheduling._split_scope(test), OrderedDict())[test] = False
    for _ in range(3):
        scheduling._assign_work_unit(node)
    assert [tests[i].rpartition("_")[2] for i in node.sent] == ["d", "e", "c", "a", "b"]
