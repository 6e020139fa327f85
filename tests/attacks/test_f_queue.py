"""Letter F: what stands in the queue is a task and an id; a worker calls nothing else that is written there."""

import json
import threading
import zlib
from pathlib import Path
from typing import Any

import pytest
from redis import Redis
from redis.typing import EncodableT, FieldT
from rq import Queue
from rq.job import Job
from rq.registry import StartedJobRegistry
from rq.serializers import JSONSerializer

from jobkit.queue import RUN_JOB, TaskQueue
from worker import entries
from worker.executor import Executor

ID = "job_0123456789abcdefghjkmnpqrs"
MARK = "tests.attacks.test_f_queue.leave_a_mark"
WAS_CALLED = threading.Event()


def leave_a_mark(*_: object) -> None:
    """Stand in for `os.system`: tells that a worker called what an entry names."""
    WAS_CALLED.set()


@pytest.fixture
def queue(valkey_url: str, tmp_path: Path) -> TaskQueue:
    WAS_CALLED.clear()
    return TaskQueue(valkey_url, f"attack-{tmp_path.name.replace('_', '-').lower()}", 60)


@pytest.fixture
def called(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Ids that reached the task `run_job`."""
    ids: list[str] = []
    monkeypatch.setitem(entries.TASKS, RUN_JOB, ids.append)
    return ids


def plant(connection: Redis, name: str, data: list[Any], **fields: str) -> str:
    """Write an entry as one does who may write to Valkey, and no more."""
    entry = f"entry-{len(connection.lrange(f'rq:queue:{name}', 0, -1))}"
    compressed = zlib.compress(json.dumps(data).encode())
    values: dict[FieldT, EncodableT] = {"data": compressed, "origin": name, "status": "queued"}
    values.update(fields.items())
    connection.hset(f"rq:job:{entry}", mapping=values)
    connection.rpush(f"rq:queue:{name}", entry)
    return entry


def work_off(queue: TaskQueue) -> None:
    name = queue._queue.name
    Executor(queue, name, "worker", threading.Event()).work(burst=True)
    assert queue.depth() == 0


@pytest.mark.parametrize(
    "data",
    [
        [MARK, None, [ID], {}],
        [RUN_JOB, MARK, [ID], {}],
        [RUN_JOB, None, [ID], {"more": 1}],
        [RUN_JOB, None, [ID, ID], {}],
        [RUN_JOB, None, ["../../etc"], {}],
        [RUN_JOB, None, [[ID]], {}],
        [[MARK], None, [ID], {}],
        ["worker.jobs.current_context", None, [], {}],
        [],
    ],
)
def test_an_entry_that_is_no_task_calls_nothing(queue: TaskQueue, called: list[str], data: list[Any]) -> None:
    plant(queue.connection, queue._queue.name, data)
    plant(queue.connection, queue._queue.name, [RUN_JOB, None, [ID], {}])
    work_off(queue)
    assert not WAS_CALLED.is_set()
    assert called == [ID]


@pytest.mark.parametrize("kind", ["success", "failure", "stopped"])
@pytest.mark.parametrize("function", [RUN_JOB, "nothing.at.all"])
def test_callbacks_of_an_entry_are_not_called(queue: TaskQueue, called: list[str], kind: str, function: str) -> None:
    plant(queue.connection, queue._queue.name, [function, None, [ID], {}], **{f"{kind}_callback_name": MARK})
    work_off(queue)
    assert not WAS_CALLED.is_set()


def test_the_callback_of_an_entry_that_its_worker_left_is_not_called(queue: TaskQueue) -> None:
    name, connection = queue._queue.name, queue.connection
    plant(connection, name, [RUN_JOB, None, [ID], {}], failure_callback_name=MARK)
    connection.delete(f"rq:queue:{name}")
    connection.hset("rq:job:entry-0", "status", "started")
    connection.zadd(StartedJobRegistry(name, connection=connection).key, {"entry-0:gone": 1.0})
    Executor(queue, name, "worker", threading.Event()).clean_registries()
    assert not WAS_CALLED.is_set()


def test_an_entry_that_cannot_be_read_does_not_end_the_worker(queue: TaskQueue, called: list[str]) -> None:
    for field, value in (("status", "unheard-of"), ("timeout", "soon"), ("dependency_ids", "{"), ("created_at", "x")):
        plant(queue.connection, queue._queue.name, [RUN_JOB, None, [ID], {}], **{field: value})
    plant(queue.connection, queue._queue.name, [RUN_JOB, None, [ID], {}])
    work_off(queue)
    assert called == [ID]


def test_rq_by_itself_would_call_what_an_entry_names(queue: TaskQueue) -> None:
    """Without this the tests above could not fail."""
    name = queue._queue.name
    plant(queue.connection, name, [MARK, None, [ID], {}])
    (entry,) = Queue(name, connection=queue.connection, serializer=JSONSerializer).get_job_ids()
    Job.fetch(entry, connection=queue.connection, serializer=JSONSerializer).perform()
    assert WAS_CALLED.is_set()
