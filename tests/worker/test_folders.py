import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

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
