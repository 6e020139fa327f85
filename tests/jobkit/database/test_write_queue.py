from concurrent.futures import ThreadPoolExecutor
from functools import partial

import pytest

from jobkit.database import write_queue
from jobkit.database.write_queue import WriteQueue
from jobkit.errors import DatabaseUnavailableError
from tests.waiting import wait_until


def has_waiting(queue: WriteQueue, count: int) -> bool:
    return len(queue) == count


def test_threads_write_in_the_order_in_which_they_come() -> None:
    queue, order = WriteQueue(), list[int]()

    def write(number: int) -> None:
        with queue:
            order.append(number)

    with ThreadPoolExecutor(8) as pool:
        with queue:
            for number in range(8):
                turn = pool.submit(write, number)
                wait_until(partial(has_waiting, queue, number + 2))
        turn.result()
    assert order == list(range(8))
    assert len(queue) == 0


def test_a_thread_that_gives_up_keeps_no_other_from_writing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    queue = WriteQueue()
    monkeypatch.setattr(write_queue, "BUSY_TIMEOUT_MS", 1)
    with queue, pytest.raises(DatabaseUnavailableError), queue:
        pass
    with queue:
        assert len(queue) == 1
    assert len(queue) == 0
