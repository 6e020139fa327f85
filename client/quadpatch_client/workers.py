"""Threads that do not keep a program from ending: Ctrl-C waits for none of them.

Tested in `tests/quadpatch_client/test_batch.py`.
"""

import threading
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import Any, TypeVar

T = TypeVar("T")


class Workers:
    """A number of threads that run what they are handed, in turn.

    Parameters
    ----------
    n_workers : int
    """

    def __init__(self, n_workers: int) -> None:
        self._calls: SimpleQueue[tuple[Future[Any], Callable[[], Any]] | None] = SimpleQueue()
        self._n_workers = n_workers
        for _ in range(n_workers):
            threading.Thread(target=self._work, daemon=True).start()

    def submit(self, call: Callable[[], T]) -> "Future[T]":
        """Run something once a thread is free."""
        future: Future[T] = Future()
        self._calls.put((future, call))
        return future

    def close(self) -> None:
        """Let the threads end once they have done what they were handed."""
        for _ in range(self._n_workers):
            self._calls.put(None)

    def _work(self) -> None:
        while (handed := self._calls.get()) is not None:
            future, call = handed
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(call())
            except BaseException as error:  # noqa: BLE001  raised where the result is asked for
                future.set_exception(error)
