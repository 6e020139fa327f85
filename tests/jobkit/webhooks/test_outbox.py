import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import get_args

import pytest
from sqlalchemy import event, select

from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import DeliveryRow
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.endings import end_attempt, failure
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.webhooks.outbox import OMITTED_FIELDS
from jobkit.webhooks.subscriptions import Webhooks
from quadpatch_client.schema import Job, JobError, JobResult, JobState, NewWebhook
from quadpatch_client.schema.webhooks import WebhookEvent

ERROR = JobError(code="no_quads", message="the outline is too small")


@pytest.fixture
def subscribe(database: Database) -> Callable[..., str]:
    """Subscribe to events, all of those that there are by default; returns the id of the subscription."""
    webhooks = Webhooks(database, lambda _: None)

    def act(events: list[WebhookEvent] | None = None) -> str:
        chosen = events or list(get_args(WebhookEvent))
        return webhooks.create(NewWebhook(url="https://a.example/", events=chosen)).id

    return act


def messages(database: Database) -> list[DeliveryRow]:
    with database.read() as session:
        return list(session.scalars(select(DeliveryRow).order_by(DeliveryRow.id)))


def test_every_change_that_is_subscribed_to_leaves_a_message_with_the_job_as_it_then_is(
    database: Database, job: Job, subscribe: Callable[..., str]
) -> None:
    webhook_id = subscribe()
    attempts = Attempts(database)
    attempts.requeue(attempts.start(job.id, "w", 30).attempt, ERROR)
    attempts.publish(attempts.start(job.id, "w", 30).attempt, JobResult(format="ply", warnings=["one hole is open"]))
    found = sorted(messages(database), key=lambda row: row.payload["data"]["job"]["revision"])
    assert [row.type for row in found] == ["job.started", "job.requeued", "job.started", "job.succeeded"]
    assert {(row.webhook_id, row.job_id, row.state, row.tries) for row in found} == {(webhook_id, job.id, "pending", 0)}
    told = [row.payload["data"]["job"] for row in found]
    assert [job["state"] for job in told] == ["running", "queued", "running", "succeeded_with_warnings"]
    assert told[-1] == Jobs(database).get(job.id).model_dump(mode="json", exclude=set(OMITTED_FIELDS))
    assert len({row.id for row in found}) == 4


def test_a_subscriber_hears_of_what_it_asked_for_alone(
    database: Database, job: Job, subscribe: Callable[..., str]
) -> None:
    subscribe(["job.succeeded"])
    canceled = subscribe(["job.canceled"])
    Jobs(database).request_cancel(job.id)
    assert [(row.webhook_id, row.type) for row in messages(database)] == [(canceled, "job.canceled")]


def test_two_subscribers_get_messages_of_their_own(database: Database, job: Job, subscribe: Callable[..., str]) -> None:
    subscribers = {subscribe(), subscribe()}
    Jobs(database).request_cancel(job.id)
    found = messages(database)
    assert {row.webhook_id for row in found} == subscribers
    assert len({row.id for row in found}) == 2


def test_a_change_that_is_rolled_back_leaves_no_message(
    database: Database, job: Job, subscribe: Callable[..., str]
) -> None:
    subscribe(["job.failed"])
    attempt = Attempts(database).start(job.id, "w", 30).attempt

    def fail_and_break() -> None:
        with database.write() as session:
            assert end_attempt(session, attempt, failure(ERROR), utc_now()) is JobState.FAILED
            assert session.scalars(select(DeliveryRow)).all()
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail_and_break()
    assert Jobs(database).get(job.id).state is JobState.RUNNING
    assert messages(database) == []
    Attempts(database).fail(attempt, ERROR)
    assert [row.type for row in messages(database)] == ["job.failed"]


def test_without_subscribers_a_change_costs_one_query_more_and_progress_none(database: Database, job: Job) -> None:
    attempts = Attempts(database)
    attempt = attempts.start(job.id, "w", 30).attempt
    statements: list[str] = []

    def note(_connection: object, _cursor: object, statement: str, *_: object) -> None:
        statements.append(statement)

    event.listen(database.engine, "before_cursor_execute", note)
    attempts.report_progress(attempt, "fill", 20.0)
    assert not [statement for statement in statements if "webhooks" in statement]
    attempts.fail(attempt, ERROR)
    event.remove(database.engine, "before_cursor_execute", note)
    assert len([statement for statement in statements if "webhooks" in statement]) == 1
    assert not [statement for statement in statements if "deliveries" in statement]


def test_a_subscription_that_is_deleted_at_the_same_moment_never_undoes_the_end_of_a_job(
    database: Database, new_job: NewJob, subscribe: Callable[..., str]
) -> None:
    jobs, webhooks = Jobs(database), Webhooks(database, lambda _: None)
    created = [jobs.create(new_job)[0].id for _ in range(24)]
    over = threading.Event()

    def come_and_go() -> None:
        while not over.is_set():
            webhooks.delete(subscribe(["job.canceled"]))

    with ThreadPoolExecutor(6) as pool:
        churn = [pool.submit(come_and_go) for _ in range(3)]
        try:
            ended = [job.state for job in pool.map(jobs.request_cancel, created)]
        finally:
            over.set()
        for turn in churn:
            turn.result()
    assert ended == [JobState.CANCELED] * len(created)
    assert messages(database) == []
