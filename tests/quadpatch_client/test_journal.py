import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch_client.errors import UsageError
from quadpatch_client.journal import Entry, Journal, Stamp, one_client_alone
from tests.waiting import GUARD_S

STAMP = Stamp(3, 4)


def test_of_each_file_the_latest_entry_counts(tmp_path: Path) -> None:
    path = tmp_path / "journal"
    journal = Journal(path)
    journal.write(Entry("a", "started", STAMP, "x", {"job": "job_1"}))
    journal.write(Entry("b", "skipped", STAMP, "x"))
    journal.write(Entry("a", "done", STAMP, "x", {"job": "job_1"}))
    journal.close()
    assert len(path.read_text().splitlines()) == 3
    again = Journal(path)
    done, skipped = Entry("a", "done", STAMP, "x", {"job": "job_1"}), Entry("b", "skipped", STAMP, "x")
    assert again.entries == {"a": done, "b": skipped}
    assert len(path.read_text().splitlines()) == 2
    again.close()


@given(cut=st.integers(0, 400))
def test_a_journal_that_is_cut_anywhere_keeps_what_is_whole(tmp_path_factory: pytest.TempPathFactory, cut: int) -> None:
    path = tmp_path_factory.mktemp("cut") / "journal"
    journal = Journal(path)
    for name in ("ä", "b", "c"):
        journal.write(Entry(name, "done", STAMP))
    journal.close()
    content = path.read_bytes()
    path.write_bytes(content[:cut])
    n_whole = content[:cut].count(b"\n") + (cut > 0 and content[cut : cut + 1] == b"\n")
    reopened = Journal(path)
    assert list(reopened.entries) == ["ä", "b", "c"][:n_whole]
    reopened.write(Entry("d", "failed", STAMP))
    reopened.close()
    last = Journal(path)
    last.close()
    assert list(last.entries) == [*["ä", "b", "c"][:n_whole], "d"]


def test_a_stamp_tells_bytes_apart(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"12")
    first = Stamp.of(tmp_path / "a")
    (tmp_path / "a").write_bytes(b"123")
    assert Stamp.of(tmp_path / "a") != first


def test_a_folder_is_held_by_one_client_and_let_go_by_one_that_dies(tmp_path: Path) -> None:
    code = (
        "import sys, pathlib; from quadpatch_client.journal import one_client_alone\n"
        "with one_client_alone(pathlib.Path(sys.argv[1])): print('held', flush=True); sys.stdin.read()"
    )
    command = [sys.executable, "-c", code, str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"held\n"
        with pytest.raises(UsageError, match="another quadpatch-client"), one_client_alone(tmp_path):
            pass
        other.kill()
        other.wait(GUARD_S)
    with one_client_alone(tmp_path):
        pass
