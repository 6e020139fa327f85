"""Letter F: a dispatcher with nothing to do costs next to nothing, since it looks every second for years.

Seconds of a processor depend on the machine; what a look asks of the database does not.
"""

from collections.abc import Iterator
from typing import cast

import pytest
from sqlalchemy import event
from sqlalchemy.engine import Engine

from dispatcher.webhooks import deliver_webhooks
from jobkit.database.session import Database
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.jobs.timeouts import TimeLimits
from jobkit.meshes import Meshes
from jobkit.queue import TaskQueue
from jobkit.requeue import Reconciled, reconcile
from jobkit.settings import Settings
from jobkit.storage.base import StoredObject
from quadpatch_client.schema import JobSpec, ResolvedModel

LIMITS = TimeLimits(60.0, 60.0, 1024)
# Raises as soon as the queue is asked for anything.
NO_QUEUE = cast(TaskQueue, None)


@pytest.fixture
def statements() -> Iterator[list[str]]:
    """What databases are asked, as it happens."""
    seen: list[str] = []

    def note(_connection: object, _cursor: object, statement: str, *_: object) -> None:
        if statement != "BEGIN" and "clock_timestamp" not in statement:
            seen.append(statement)

    event.listen(Engine, "before_cursor_execute", note)
    yield seen
    event.remove(Engine, "before_cursor_execute", note)


def test_a_look_at_nothing_asks_one_question_and_leaves_the_queue_alone(
    database: Database, statements: list[str]
) -> None:
    assert reconcile(database, NO_QUEUE, LIMITS) == Reconciled(0, 0, 0)
    assert len(statements) == 1


def test_a_look_for_webhooks_asks_one_question(database: Database, settings: Settings, statements: list[str]) -> None:
    assert deliver_webhooks(database, settings, lambda: False) == ""
    assert len(statements) == 1


def test_work_is_still_seen(database: Database) -> None:
    mesh = Meshes(database).add(StoredObject("meshes/aa/bb", 3, "ab" * 32), "scan.ply", "ply")[0]
    spec = JobSpec.model_validate({"mesh_id": mesh.id, "method": {"method": "smooth"}})
    Jobs(database).create(NewJob(spec, ResolvedModel(requested="smooth", kind="none"), 3))
    with pytest.raises(AttributeError):
        reconcile(database, NO_QUEUE, LIMITS)
