"""Processes that share the work of one task, forked from the one that does it.

Most of a repair is thousands of short steps of numpy on small arrays, which threads of one interpreter do one after the
other. The processes are forked before anything untrusted is read, and are sent what they work on. No thread is started
before that, as those of `concurrent.futures.ProcessPoolExecutor` would be: the kernel confines threads one by one.

Which pieces some work is cut into never depends on how many processes there are, so neither do its results.

Tested in `tests/quadpatch/test_processes.py`.
"""

import os
import pickle
import signal
import traceback
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from resource import RUSAGE_SELF, getrusage
from typing import Generic, NoReturn, Self, TypeVar

from quadpatch.errors import ProcessLostError
from quadpatch.progress import Fraction, no_fraction
from quadpatch_rules.parent_death import parent_death_signal

Item = TypeVar("Item")
Result = TypeVar("Result")

THREADS_VARIABLE = "OMP_NUM_THREADS"
# A file of fewer bytes is worked on by one process: it takes less than a second, and is not to pay for a fork.
LEAST_BYTES = 1_000_000
# More processes than this find too few pieces of work.
MOST_PROCESSES = 8
_PICKLE_PROTOCOL = 5


def usable_threads() -> int:
    """Count the threads that this process may use: what the variable says that numerical libraries obey, else cores."""
    stated = os.environ.get(THREADS_VARIABLE, "")
    if stated.isdecimal() and int(stated) > 0:
        return int(stated)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def n_processes_for(source: Path, n_threads: int) -> int:
    """Say how many processes are to work on a file, where so many threads may run at once."""
    try:
        n_bytes = source.stat().st_size
    except OSError:
        return 1
    return max(1, min(n_threads, MOST_PROCESSES, 1 + n_bytes // LEAST_BYTES))


class ProcessPool:
    """The process that makes it, and helpers that are forked from that.

    Fork in the main thread, before the task reads a file or starts a thread; `close` ends the helpers. They also end
    when the thread that forked them does.

    Parameters
    ----------
    n_processes : int
        That work at once, this one among them; 1 forks none.
    prepare : callable, optional
        Called in every helper before its first piece of work.
    """

    def __init__(self, n_processes: int = 1, prepare: Callable[[], object] | None = None) -> None:
        self._helpers: list[_Helper] = []
        self._idle: SimpleQueue[_Helper] = SimpleQueue()
        self._threads: ThreadPoolExecutor | None = None
        if n_processes < 2 or not hasattr(os, "fork"):
            return
        for _ in range(n_processes - 1):
            helper = _Helper(prepare, [other.connection for other in self._helpers])
            self._helpers.append(helper)
            self._idle.put(helper)
        # Its threads start with the first piece of work.
        self._threads = ThreadPoolExecutor(len(self._helpers))

    @property
    def is_shared(self) -> bool:
        """Whether there are helpers."""
        return bool(self._helpers)

    @property
    def process_ids(self) -> list[int]:
        """Those of the helpers."""
        return [helper.pid for helper in self._helpers]

    @property
    def extra_memory_mib(self) -> int:
        """The most memory that helpers have had beyond what they shared with this process when they were forked."""
        return sum(helper.extra_kib for helper in self._helpers) // 1024

    def submit(self, function: Callable[..., Result], *arguments: object) -> "Future[Result]":
        """Let a helper, of which there are some, call a function; see `begin`."""
        if self._threads is None:
            raise ValueError("there is no helper")
        return self._threads.submit(self._elsewhere, function, arguments)

    def begin(self, function: Callable[[Item], Result], items: Iterable[Item]) -> "Shared[Item, Result]":
        """Let helpers apply a function to items while this process does something else.

        Parameters
        ----------
        function : callable
            Function, items and results are pickled. The helpers have the modules that this process had loaded.
        items : iterable
        """
        todo = list(items)
        futures = [self.submit(function, item) for item in todo] if self.is_shared else []
        return Shared(function, todo, futures)

    def map(
        self, function: Callable[[Item], Result], items: Iterable[Item], reach: Fraction = no_fraction
    ) -> list[Result]:
        """Apply a function to every item, several at a time; see `begin` and `Shared.finish`."""
        todo = list(items)
        # What is one piece of work is done at once where it is.
        shared = self.begin(function, todo) if len(todo) > 1 else Shared(function, todo, [])
        return shared.finish(reach)

    def map_in_threads(self, function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
        """Apply a function to every item in threads of this process: for a few long steps of numpy on large arrays."""
        if not self.is_shared:
            return [function(item) for item in items]
        with ThreadPoolExecutor(len(self._helpers) + 1) as threads:
            return list(threads.map(function, items))

    def close(self) -> None:
        """End the helpers, whatever they do."""
        for helper in self._helpers:
            helper.end()
        if self._threads is not None:
            self._threads.shutdown(cancel_futures=True)
        for helper in self._helpers:
            helper.connection.close()
        self._helpers, self._threads = [], None

    def __enter__(self) -> Self:
        """They run already."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()

    def _elsewhere(self, function: Callable[..., Result], arguments: tuple[object, ...]) -> Result:
        helper = self._idle.get()
        try:
            return helper.call(function, arguments)
        finally:
            self._idle.put(helper)


@dataclass(frozen=True)
class Shared(Generic[Item, Result]):
    """Pieces of work that helpers have begun with."""

    function: Callable[[Item], Result]
    items: Sequence[Item]
    futures: "Sequence[Future[Result]]"

    def finish(self, reach: Fraction = no_fraction) -> list[Result]:
        """Take part until all is done; results in the order of the items.

        Helpers take items from the front; this process takes those from the end that none has begun.

        Parameters
        ----------
        reach : callable
            Told the done fraction, from this thread.

        Raises
        ------
        ProcessLostError
            If a helper ends before it has answered.
        """
        results: list[Result] = []
        for i in reversed(range(len(self.items))):
            is_mine = not self.futures or self.futures[i].cancel()
            results.append(self.function(self.items[i]) if is_mine else self.futures[i].result())
            reach(len(results) / len(self.items))
        return results[::-1]


class _Helper:
    """A forked process that calls what it is sent, one after the other."""

    def __init__(self, prepare: Callable[[], object] | None, others: list[Connection]) -> None:
        self.connection, far_end = Pipe()
        self.extra_kib = 0
        set_death_signal = parent_death_signal(os.getpid(), signal.SIGKILL)
        self.pid = os.fork()
        if self.pid == 0:
            _become_helper(far_end, [self.connection, *others], set_death_signal, prepare)
        far_end.close()

    def call(self, function: Callable[..., Result], arguments: tuple[object, ...]) -> Result:
        """Let it call a function and wait for the answer."""
        try:
            self.connection.send_bytes(pickle.dumps((function, arguments), _PICKLE_PROTOCOL))
            is_result, answer, self.extra_kib = pickle.loads(self.connection.recv_bytes())
        except (EOFError, OSError) as error:
            raise ProcessLostError(self._status()) from error
        if not is_result:
            raise answer
        result: Result = answer
        return result

    def end(self) -> None:
        """End it, and count its seconds among those of this process."""
        try:
            os.kill(self.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        except PermissionError:
            # A confined process signals no other; without a connection, the helper ends once it has nothing to do.
            self.connection.close()
        self._status()

    def _status(self) -> int:
        """Wait until it has ended, and return how: its exit code, negative for a signal."""
        try:
            return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])
        except ChildProcessError:
            return -signal.SIGKILL


def _become_helper(
    connection: Connection,
    not_mine: list[Connection],
    set_death_signal: Callable[[], None],
    prepare: Callable[[], object] | None,
) -> NoReturn:
    try:
        set_death_signal()
        # Ctrl-C reaches all processes in front of a terminal: the one that forked this one decides.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        for other in not_mine:
            other.close()
        if prepare is not None:
            prepare()
        shared_kib = _peak_kib()
        while True:
            connection.send_bytes(_answer(connection.recv_bytes(), shared_kib))
    except (EOFError, OSError):
        pass
    finally:
        # Not sys.exit: the exit handlers of the parent must not run in this process.
        os._exit(1)


def _answer(request: bytes, shared_kib: int) -> bytes:
    function, arguments = pickle.loads(request)
    try:
        return pickle.dumps((True, function(*arguments), _peak_kib() - shared_kib), _PICKLE_PROTOCOL)
    except Exception as error:  # noqa: BLE001  raised again where the function was asked for
        error.add_note(traceback.format_exc())
        return pickle.dumps((False, error, _peak_kib() - shared_kib), _PICKLE_PROTOCOL)


def _peak_kib() -> int:
    return getrusage(RUSAGE_SELF).ru_maxrss
