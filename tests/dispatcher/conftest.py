"""Jobs that end, and subscriptions to their ends."""

from collections.abc import Callable
from functools import partial

import pytest

from jobkit.database.session import Database
from jobkit.egress import check_url, parse_networks
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.jobs import Jobs
from jobkit.jobs.new_jobs import NewJob
from jobkit.meshes import Meshes
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.webhooks.deliveries import Deliveries
from jobkit.webhooks.subscriptions import Webhooks
from quadpatch_client.schema import JobError, JobSpec, NewWebhook, ResolvedModel, WebhookWithSecret
from tests.dispatcher.receivers import LOOPBACK
from tests.jobkit.conftest import any_database, any_store, job, mesh, new_job

# Sweeps and scrubs start from the same meshes, jobs and stores.
__all__ = ["any_database", "any_store", "job", "mesh", "new_job"]

Subscribe = Callable[..., WebhookWithSecret]
FailJob = Callable[[], str]


@pytest.fixture
def settings(settings: Settings) -> Settings:
    """Settings that let messages go to this machine."""
    return settings.model_copy(update={"webhook_allowed_networks": LOOPBACK})


@pytest.fixture
def webhooks(database: Database) -> Webhooks:
    return Webhooks(database, partial(check_url, allowed=parse_networks(LOOPBACK)))


@pytest.fixture
def deliveries(database: Database) -> Deliveries:
    return Deliveries(database)


@pytest.fixture
def subscribe(webhooks: Webhooks) -> Subscribe:
    """Subscribe a URL to events, by default to all ends of jobs."""
    return lambda url, **values: webhooks.create(NewWebhook(url=url, **values))


@pytest.fixture
def fail_job(database: Database, store: ObjectStore) -> FailJob:
    """Make a job and let it fail at its first attempt; returns its id."""
    with store.writer("meshes") as writer:
        writer.write(b"ply\n")
        stored = writer.commit()
    mesh = Meshes(database).add(stored, "scan.ply", "ply")[0]
    new = NewJob(JobSpec(mesh_id=mesh.id), ResolvedModel(requested="self", kind="self"), max_attempts=2)

    def run() -> str:
        job_id = Jobs(database).create(new)[0].id
        attempts = Attempts(database)
        attempts.fail(attempts.start(job_id, "test", 30).attempt, JobError(code="no_quads", message="größer als 5 µm"))
        return job_id

    return run
