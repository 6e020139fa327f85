"""Also tests `worker.abilities`."""

import threading

import pytest

from jobkit.queue import NETWORKS, TaskQueue
from jobkit.settings import Settings
from worker.abilities import abilities
from worker.context import worker_name
from worker.executor import Executor


@pytest.fixture
def queue(settings: Settings) -> TaskQueue:
    return TaskQueue(settings.redis_url.get_secret_value(), settings.queue_name, 60)


def test_a_killed_worker_starts_again_under_its_process_id(queue: TaskQueue, settings: Settings) -> None:
    keys = set()
    for _ in range(2):
        executor = Executor(queue, settings.queue_name, worker_name(1), threading.Event())
        executor.register_birth()  # and no death: it was killed
        keys.add(executor.key)
    assert len(keys) == 2
    assert queue.connection.exists(*keys) == 2


def test_a_worker_whose_executor_is_replaced_registers_again(queue: TaskQueue, settings: Settings) -> None:
    """RQ refuses a name that is still registered, as that of an executor that lost its Valkey."""
    name = worker_name(1)
    first, second = (Executor(queue, settings.queue_name, name, threading.Event()) for _ in range(2))
    first.register_birth()
    second.register_birth()
    second.name = first.name
    with pytest.raises(ValueError, match="active worker"):
        second.register_birth()


def test_the_service_knows_what_workers_can_do_as_long_as_they_run(queue: TaskQueue, settings: Settings) -> None:
    def start(*able: str) -> str:
        executor = Executor(queue, settings.queue_name, worker_name(1), threading.Event(), able)
        executor.register_birth()
        return str(executor.key)

    assert queue.abilities() == set()
    start()
    assert queue.abilities() == set()
    key = start(NETWORKS)
    assert queue.abilities() == {NETWORKS}
    queue.connection.delete(key)  # as when the entry of a killed worker expires
    assert queue.abilities() == set()
    start(NETWORKS)
    assert queue.abilities() == {NETWORKS}


def test_this_machine_has_the_extra_that_the_tests_install() -> None:
    assert abilities() == {NETWORKS}
