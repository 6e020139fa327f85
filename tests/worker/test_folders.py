import fcntl
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import GUARD_S
from worker.folders import request_folder, worker_folder

HOLD = (
    "import sys, time; from pathlib import Path; from worker.folders import worker_folder\n"
    "with worker_folder(Path(sys.argv[1])): print('held', flush=True); time.sleep(999)"
)


def test_a_request_folder_goes_whatever_happens_in_it(tmp_path: Path) -> None:
    def fail_in_a_folder() -> None:
        with request_folder(tmp_path) as folder:
            (folder / "mesh.ply").write_bytes(b"ply")
            raise KeyError

    with pytest.raises(KeyError):
        fail_in_a_folder()
    assert list(tmp_path.iterdir()) == []


def test_the_folder_of_a_killed_worker_is_swept_up_and_that_of_a_living_one_is_not(tmp_path: Path) -> None:
    holders = {}
    for name in ("killed", "living"):
        process = subprocess.Popen([sys.executable, "-c", HOLD, str(tmp_path / name)], stdout=subprocess.PIPE)
        assert process.stdout is not None
        assert process.stdout.readline() == b"held\n"
        holders[name] = process
        (tmp_path / name / "request-1").mkdir()
    os.kill(holders["killed"].pid, signal.SIGKILL)
    holders["killed"].wait()
    with worker_folder(tmp_path / "new"):
        assert sorted(path.name for path in tmp_path.iterdir()) == ["living", "new"]
        assert (tmp_path / "living" / "request-1").exists()
    for process in holders.values():
        process.kill()
        process.communicate()
    assert not (tmp_path / "new").exists()


def test_something_else_beside_the_folders_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "notes").mkdir()
    with worker_folder(tmp_path / "new"):
        assert (tmp_path / "notes").exists()


def test_a_folder_that_another_worker_takes_for_abandoned_before_it_is_locked_is_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, lock, removals = tmp_path / "new", fcntl.flock, [1, 2]

    def late_lock(descriptor: int, operation: int) -> None:
        if removals and operation == fcntl.LOCK_EX:
            removals.pop()
            shutil.rmtree(folder)
        lock(descriptor, operation)

    monkeypatch.setattr("worker.folders.fcntl.flock", late_lock)
    with worker_folder(folder):
        assert removals == []
        with request_folder(folder) as request:
            assert request.is_dir()
        # The lock is on the file that is there: a worker that starts now leaves the folder alone.
        with worker_folder(tmp_path / "other"):
            assert folder.is_dir()
    assert list(tmp_path.iterdir()) == []


def test_many_workers_that_start_at_once_all_keep_their_folders(tmp_path: Path) -> None:
    program = (
        "import sys; from pathlib import Path; from worker.folders import request_folder, worker_folder\n"
        "folder = Path(sys.argv[1])\n"
        "for _ in range(1000):\n"
        "    with worker_folder(folder), request_folder(folder) as request: assert request.is_dir()\n"
    )
    command = [sys.executable, "-c", program]
    workers = [subprocess.Popen([*command, str(tmp_path / str(number))], stderr=subprocess.PIPE) for number in range(4)]
    errors = [worker.communicate(timeout=GUARD_S)[1] for worker in workers]
    assert errors == [b""] * 4
