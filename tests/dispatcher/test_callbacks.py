"""Also tests `jobkit/webhooks/callbacks.py`."""

from functools import partial

import pytest
from sqlalchemy import select, update
from standardwebhooks import Webhook, WebhookVerificationError

from dispatcher.outbox import MAX_PER_RECEIVER, claim_due
from dispatcher.webhooks import deliver_webhooks
from jobkit.batches.batches import Batches, BatchFacts
from jobkit.batches.progress import note_progress
from jobkit.database.clock import utc_now
from jobkit.database.session import Database
from jobkit.database.tables import DeliveryRow
from jobkit.egress import check_url, parse_networks
from jobkit.errors import AddressRefusedError, CallbackSecretMissingError
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.settings import Settings
from jobkit.webhooks.callbacks import Callbacks
from jobkit.webhooks.deliveries import Deliveries
from jobkit.webhooks.outbox import Receiver
from quadpatch_client.schema import DeliveryState, JobError, JobSpec, Mesh, ResolvedModel
from tests.dispatcher.receivers import LOOPBACK, receiving

SELF = ResolvedModel(requested="self", kind="self")


def never() -> bool:
    return False


@pytest.fixture
def callbacks(database: Database) -> Callbacks:
    return Callbacks(database, partial(check_url, allowed=parse_networks(LOOPBACK)))


def fail(database: Database, mesh: Mesh, url: str | None) -> str:
    spec = JobSpec(mesh_id=mesh.id, callback_url=url)
    job_id = Jobs(database).create(NewJob(spec, SELF, max_attempts=1))[0].id
    attempts = Attempts(database)
    attempts.fail(attempts.start(job_id, "test", 30).attempt, JobError(code="no_quads", message="x"))
    return job_id


def test_the_end_of_a_job_is_told_to_its_callback_url_signed_with_the_secret_of_the_tenant(
    database: Database, settings: Settings, callbacks: Callbacks, mesh: Mesh
) -> None:
    old = callbacks.renew_secret_once(None)[0].secret
    with receiving() as receiver:
        job_id = fail(database, mesh, receiver.url(path="/part/1187?token=x"))
        fail(database, mesh, None)
        new = callbacks.renew_secret_once(None)[0].secret
        assert deliver_webhooks(database, settings, never) == "{'delivered': 1}"
    (told,) = Deliveries(database).of_job(job_id).items
    assert (told.type, told.state, told.tries) == ("job.failed", DeliveryState.DELIVERED, 1)
    assert [(entry.number, entry.status) for entry in told.log] == [(1, 204)]
    (request,) = receiver.received
    assert request.path == "/part/1187?token=x"
    for secret in (old, new):
        message = Webhook(secret).verify(request.body, request.headers)
        assert (message["type"], message["data"]["job"]["id"]) == ("job.failed", job_id)
    with pytest.raises(WebhookVerificationError):
        Webhook("whsec_" + "A" * 43 + "=").verify(request.body, request.headers)


def test_the_end_of_a_batch_is_told_to_its_callback_url(
    database: Database, settings: Settings, callbacks: Callbacks, mesh: Mesh
) -> None:
    callbacks.renew_secret_once(None)
    with receiving() as receiver:
        facts = BatchFacts(callback_url=receiver.url())
        batch, _ = Batches(database).create(facts, lambda: [NewJob(JobSpec(mesh_id=mesh.id), SELF, 1)])
        Jobs(database).request_cancel(Batches(database).job_ids(batch.id)[0])
        assert note_progress(database) == 1
        assert deliver_webhooks(database, settings, never) == "{'delivered': 1}"
    assert b'"batch.ended"' in receiver.received[0].body


def test_a_receiver_that_wants_none_is_asked_once_and_others_of_the_tenant_go_on(
    database: Database, settings: Settings, callbacks: Callbacks, mesh: Mesh
) -> None:
    callbacks.renew_secret_once(None)
    with receiving(answers=[(410, {})]) as gone, receiving() as other:
        for receiver in (gone, other):
            fail(database, mesh, receiver.url())
        deliver_webhooks(database, settings, never)
        fail(database, mesh, other.url())
        deliver_webhooks(database, settings, never)
    assert (len(gone.received), len(other.received)) == (1, 2)
    with database.read() as session:
        states = sorted(session.scalars(select(DeliveryRow.state)))
    assert states == [DeliveryState.DEAD, DeliveryState.DELIVERED, DeliveryState.DELIVERED]


def test_an_address_that_is_refused_by_now_gets_nothing(
    database: Database, settings: Settings, callbacks: Callbacks, mesh: Mesh
) -> None:
    callbacks.renew_secret_once(None)
    with receiving() as receiver:
        fail(database, mesh, receiver.url())
        closed = settings.model_copy(update={"webhook_allowed_networks": ""})
        assert deliver_webhooks(database, closed, never) == "{'failed': 1}"
        with database.write() as session:
            session.execute(update(DeliveryRow).values(next_try_at=utc_now()))
        assert deliver_webhooks(database, settings, never) == "{'delivered': 1}"
    assert len(receiver.received) == 1


def test_a_host_gets_few_messages_at_a_time_whatever_the_paths(
    database: Database, callbacks: Callbacks, mesh: Mesh
) -> None:
    callbacks.renew_secret_once(None)
    for number in range(MAX_PER_RECEIVER + 2):
        fail(database, mesh, f"http://127.0.0.1:9/{number}")
    claims = claim_due(database, 100, {}, 60.0)
    assert len(claims) == MAX_PER_RECEIVER
    assert {claim.receiver for claim in claims} == {"default http://127.0.0.1:9"}
    assert Receiver(None, "https://a.example/x?y", "north").name == "north https://a.example"


def test_no_callback_without_a_secret_or_to_an_inner_address(database: Database, callbacks: Callbacks) -> None:
    callbacks.check(None)
    with pytest.raises(CallbackSecretMissingError):
        callbacks.check("http://127.0.0.1:9/")
    callbacks.renew_secret_once(None)
    callbacks.check("http://127.0.0.1:9/")
    with pytest.raises(AddressRefusedError):
        Callbacks(database, partial(check_url, allowed=())).check("http://127.0.0.1:9/")


def test_each_tenant_has_a_secret_of_its_own(database: Database, callbacks: Callbacks) -> None:
    north, south = (callbacks.of(database.of(tenant)) for tenant in ("north", "south"))
    secret = north.renew_secret_once(None)[0].secret
    with pytest.raises(CallbackSecretMissingError):
        south.check("http://127.0.0.1:9/")
    assert south.renew_secret_once(None)[0].secret != secret
