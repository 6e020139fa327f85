import subprocess
import sys

from tests.waiting import GUARD_S


def test_cycles_are_looked_for_seldom_but_still_found() -> None:
    program = (
        "import gc, weakref; from quadpatch_rules.garbage_collection import collect_seldom; collect_seldom()\n"
        "assert gc.isenabled() and gc.get_threshold()[0] > 10_000 and gc.get_freeze_count() > 1000\n"
        "class Node: pass\n"
        "node = Node(); node.itself = node; known = weakref.ref(node); del node\n"
        "kept = [[] for _ in range(300_000)]\n"
        "assert known() is None"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=GUARD_S, check=False)
    assert done.returncode == 0, done.stderr
