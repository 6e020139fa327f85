"""Also tests `quadpatch_rules.parent_death`."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from quadpatch.errors import OptionError, ProcessLostError
from quadpatch.processes import LEAST_BYTES, MOST_PROCESSES, ProcessPool, n_processes_for, usable_threads
from tests.waiting import wait_until

PREPARED: list[str] = []


@pytest.fixture(params=[1, 2, 4])
def pool(request: pytest.FixtureRequest) -> Iterator[ProcessPool]:
    with ProcessPool(request.param) as made:
        yield made


def squared(number: int) -> int:
    return number**2


def process_of(_: object) -> int:
    return os.getpid()


def refuse(number: int) -> int:
    raise OptionError(f"{number} is too much")


def give_what_is_not_pickled(_: int) -> object:
    return threading.Lock()


def kill_itself(number: signal.Signals) -> None:
    os.kill(os.getpid(), number)


def leave(code: int) -> None:
    os._exit(code)


def take(mib: int) -> int:
    return len(b"x" * (mib << 20))


def prepared(_: object) -> list[str]:
    return PREPARED


def is_at_work(pid: int) -> bool:
    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def test_results_come_in_the_order_of_the_items(pool: ProcessPool) -> None:
    reached: list[float] = []
    assert pool.map(squared, range(50), reached.append) == [number**2 for number in range(50)]
    assert reached == sorted(reached)
    assert reached[-1] == 1.0
    assert pool.map(squared, []) == []
    assert pool.map_in_threads(squared, range(5)) == [0, 1, 4, 9, 16]


def test_this_process_works_on_what_no_helper_has_begun() -> None:
    with ProcessPool(2) as pool:
        assert pool.submit(process_of, None).result() == pool.process_ids[0] != os.getpid()
        pool.submit(signal.pause)
        assert pool.map(process_of, range(5)) == [os.getpid()] * 5
    with ProcessPool(1) as alone:
        assert not alone.is_shared
        assert alone.map(process_of, range(3)) == [os.getpid()] * 3


def test_what_is_begun_goes_on_while_this_process_does_something_else() -> None:
    with ProcessPool(2) as pool:
        begun = pool.begin(squared, [3])
        assert begun.futures[0].result() == 9
        assert begun.finish() == [9]


def test_helpers_are_prepared_before_they_work() -> None:
    with ProcessPool(2, lambda: PREPARED.append("confined")) as pool:
        assert pool.submit(prepared, None).result() == ["confined"]
    assert PREPARED == []


def test_a_foreseen_error_is_raised_as_what_it_is(pool: ProcessPool) -> None:
    with pytest.raises(OptionError, match="is too much"):
        pool.map(refuse, range(8))
    assert pool.map(squared, range(8))[-1] == 49


def test_what_can_not_be_sent_is_an_error_and_no_end() -> None:
    with ProcessPool(2) as pool:
        with pytest.raises(TypeError):
            pool.submit(give_what_is_not_pickled, 1).result()
        assert pool.submit(squared, 2).result() == 4


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_a_helper_that_is_killed_is_an_error_with_a_stable_code(number: signal.Signals) -> None:
    with ProcessPool(2) as pool:
        with pytest.raises(ProcessLostError, match=number.name) as caught:
            pool.submit(kill_itself, number).result()
        assert (caught.value.code, caught.value.status) == ("process_lost", -number)
        with pytest.raises(ProcessLostError):
            pool.submit(squared, 2).result()


def test_a_helper_that_leaves_is_an_error_as_well() -> None:
    with ProcessPool(2) as pool, pytest.raises(ProcessLostError, match="exit code 3"):
        pool.submit(leave, 3).result()


def test_no_helper_outlives_its_pool() -> None:
    with ProcessPool(3) as pool:
        helpers = pool.process_ids
        pool.submit(signal.pause)
        assert all(is_at_work(pid) for pid in helpers)
    assert len(helpers) == 2
    assert not any(is_at_work(pid) for pid in helpers)


def test_no_helper_outlives_the_process_that_forked_it() -> None:
    program = (
        "import signal\n"
        "from quadpatch.processes import ProcessPool\n"
        "pool = ProcessPool(3)\n"
        "pool.submit(signal.pause)\n"
        "print(*pool.process_ids, flush=True)\n"
        "signal.pause()\n"
    )
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        helpers = [int(pid) for pid in parent.stdout.readline().split()]
        assert len(helpers) == 2
        parent.kill()
    wait_until(lambda: not any(is_at_work(pid) for pid in helpers))


def test_the_memory_of_helpers_counts_beyond_what_they_share() -> None:
    held = b"x" * (300 << 20)
    with ProcessPool(2) as pool:
        pool.submit(take, 100).result()
        assert 100 <= pool.extra_memory_mib < 200
    assert len(held) == 300 << 20


def test_a_small_file_is_worked_on_by_one_process(tmp_path: Path) -> None:
    small, large = tmp_path / "small.ply", tmp_path / "large.ply"
    small.write_bytes(bytes(LEAST_BYTES - 1))
    with large.open("wb") as file:
        file.truncate(100 * LEAST_BYTES)
    assert n_processes_for(small, 4) == 1
    assert n_processes_for(large, 1) == 1
    assert n_processes_for(large, 3) == 3
    assert n_processes_for(large, 1000) == MOST_PROCESSES
    assert n_processes_for(tmp_path / "missing.ply", 4) == 1


@pytest.mark.parametrize("stated", ["3", "0", "many", ""])
def test_as_many_threads_as_the_variable_says_else_one_for_each_core(
    stated: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", stated)
    assert usable_threads() == (3 if stated == "3" else len(os.sched_getaffinity(0)))
