"""Letters A and D: mutated files get a code or a mesh; the local stack stays as it was.

`make mutants` sends hundreds of them.
"""

from pathlib import Path

import psutil

from onebox.demo import running_stack
from tests.mutants.__main__ import memory_faults
from tests.mutants.bases import FORMATS, made, real
from tests.mutants.campaign import Mutant, judged, left_behind, mutant, peaks, send_all
from tests.mutants.mutations import MUTATIONS
from tests.waiting import wait_until

SEED, COUNT = 7, 20


def test_mutated_files_get_a_code_or_a_mesh_and_nothing_is_lost(tmp_path: Path) -> None:
    files = made()
    mutants = [mutant(files, SEED, number) for number in range(COUNT)]
    assert {one.kind for one in mutants} == set(MUTATIONS)
    with running_stack(tmp_path / "stack") as url:
        (local_stack,) = [p for p in psutil.Process().children() if str(tmp_path / "stack") in p.cmdline()]
        before = peaks(local_stack)
        assert {name for name, _ in before.mb} >= {
            "onebox",
            "service",
            "dispatcher",
            "worker",
            "worker.engine.fork_server",
        }
        outcomes = send_all(url, mutants)
        wait_until(lambda: not left_behind(tmp_path / "stack"))
        assert memory_faults(before, peaks(local_stack)) == []
    assert [outcome for outcome in outcomes if outcome.fault] == []
    assert len({outcome.answer for outcome in outcomes}) > 1


def test_seed_and_number_alone_say_what_is_sent() -> None:
    files = made() | real()
    assert {Path(name).suffix.lower()[1:] for name in files} == set(FORMATS)
    assert mutant(files, 3, 5) == mutant(files, 3, 5)
    assert mutant(files, 3, 5).data != mutant(files, 4, 5).data


def test_an_answer_without_a_code_or_with_an_unclean_message_is_a_fault() -> None:
    one = Mutant(0, "sheet.ply", "bits", "sheet.ply", b"")
    assert not judged(one, ("unreadable_mesh", "a line")).fault
    assert not judged(one, ("mesh", "")).fault
    assert judged(one, ("engine_error", "a line")).fault
    assert judged(one, ("unreadable_mesh", "two\nlines")).fault
    assert judged(one, ("unreadable_mesh", "x" * 501)).fault
