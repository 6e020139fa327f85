import threading
from pathlib import Path

from jobkit.storage.scratch import ScratchFolder


def test_a_file_stays_while_it_is_open_and_goes_with_the_sweep_after_that(tmp_path: Path) -> None:
    path, file = ScratchFolder(tmp_path).new_file()
    with file:
        ScratchFolder(tmp_path)
        assert path.exists()
    ScratchFolder(tmp_path)
    assert not path.exists()


def test_no_sweep_ever_takes_a_file_from_its_maker(tmp_path: Path) -> None:
    folder, is_done = ScratchFolder(tmp_path), threading.Event()

    def sweep() -> None:
        while not is_done.is_set():
            ScratchFolder(tmp_path)

    sweepers = [threading.Thread(target=sweep) for _ in range(2)]
    for sweeper in sweepers:
        sweeper.start()
    for _ in range(300):
        path, file = folder.new_file()
        with file:
            assert path.exists()
    is_done.set()
    for sweeper in sweepers:
        sweeper.join()
