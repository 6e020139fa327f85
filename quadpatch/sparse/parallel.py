"""Independent batches of matrix work on all processors.

Each batch runs in a thread of its own with a single-threaded BLAS. A BLAS that splits every product over its own
threads makes them wait for each other many times a millisecond: on a machine that does anything else besides, that
made the same work ten times slower. Batches that never wait also give the same bits on any number of processors.
"""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

from threadpoolctl import threadpool_limits

Item = TypeVar("Item")
Result = TypeVar("Result")


def map_batches(function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
    """Apply a function to every item, several at a time; results in the order of the items."""
    with single_threaded_blas(), ThreadPoolExecutor(n_processors()) as threads:
        return list(threads.map(function, items))


@contextmanager
def single_threaded_blas() -> Iterator[None]:
    """Let no matrix product start threads of its own."""
    with threadpool_limits(limits=1, user_api="blas"):
        yield


def n_processors() -> int:
    """Count of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
