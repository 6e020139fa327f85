import threading

import numpy as np
import pytest
from threadpoolctl import threadpool_info

from quadpatch.sparse.parallel import map_batches, n_processors
from tests.waiting import GUARD_S


def test_results_come_in_the_order_of_the_items() -> None:
    assert map_batches(lambda i: i * i, iter(range(50))) == [i * i for i in range(50)]


def test_blas_has_one_thread_inside_and_its_own_number_after() -> None:
    before = [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]
    inside = map_batches(lambda _: [p["num_threads"] for p in threadpool_info() if p["user_api"] == "blas"], range(3))
    after = [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]
    assert inside == [[1] * len(before)] * 3
    assert after == before


def test_an_error_in_a_batch_reaches_the_caller() -> None:
    def fail(i: int) -> float:
        return float(np.ones(2)[i])

    with pytest.raises(IndexError):
        map_batches(fail, range(5))


@pytest.mark.skipif(n_processors() < 2, reason="needs two processors")
def test_two_batches_run_at_the_same_time() -> None:
    both = threading.Barrier(2, timeout=GUARD_S)
    assert len(map_batches(lambda _: both.wait(), range(2))) == 2
