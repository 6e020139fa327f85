"""Everything that routes need, opened once per process.

Tested in `tests/service/routes/test_health.py`.
"""

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Annotated, cast

from fastapi import Depends, Request

from jobkit.access.audit import AuditLog
from jobkit.access.keys import Holder
from jobkit.batches.batches import Batches
from jobkit.database.quotas import default_quotas
from jobkit.database.session import Database
from jobkit.egress import check_url
from jobkit.jobs.attempts import Attempts
from jobkit.jobs.estimates import Estimates
from jobkit.jobs.jobs import Jobs
from jobkit.meshes import Meshes
from jobkit.models.proofs import Proofs
from jobkit.models.registry import Registry
from jobkit.models.shipped import seed_shipped
from jobkit.queue import TaskQueue
from jobkit.settings import Settings
from jobkit.storage.base import ObjectStore
from jobkit.storage.open import open_store
from jobkit.uploads.uploads import Uploads
from jobkit.views import Views
from jobkit.webhooks.callbacks import Callbacks
from jobkit.webhooks.deliveries import Deliveries
from jobkit.webhooks.subscriptions import Webhooks
from service.audit import AuditTrail
from service.full_tenants import FullTenants
from service.job_cache import JobCache, OwnJobs
from service.room import DiskRoom
from service.single_flight import SingleFlight
from service.streams import EventStreams
from service.waiting import Waiters


@dataclass(frozen=True)
class Services:
    """Open connections of one process."""

    settings: Settings
    database: Database
    store: ObjectStore
    queue: TaskQueue
    jobs: Jobs
    attempts: Attempts
    meshes: Meshes
    uploads: Uploads
    room: DiskRoom
    full_tenants: FullTenants
    completions: SingleFlight
    registry: Registry
    proofs: Proofs
    batches: Batches
    webhooks: Webhooks
    callbacks: Callbacks
    deliveries: Deliveries
    estimates: Estimates
    streams: EventStreams
    job_cache: OwnJobs
    job_waiters: Waiters
    mesh_waiters: Waiters
    model_waiters: Waiters
    views: Views
    view_waiters: Waiters
    audit: AuditTrail

    def of(self, tenant: str) -> "Services":
        """Return the same connections, as one tenant sees them."""
        database, settings = self.database.of(tenant), self.settings
        return replace(
            self,
            database=database,
            jobs=Jobs(database, settings.job_retention_days),
            meshes=Meshes(database, settings.mesh_retention_days),
            uploads=self.uploads.of(database),
            registry=Registry(database, self.store),
            batches=Batches(database, settings.job_retention_days),
            webhooks=self.webhooks.of(database),
            callbacks=self.callbacks.of(database),
            deliveries=Deliveries(database),
            views=Views(database),
            job_cache=replace(self.job_cache, tenant=tenant),
        )

    def close(self) -> None:
        """Close all connections."""
        self.queue.close()
        self.database.close()


def open_services(settings: Settings) -> Services:
    """Open database, store and queue, bring the tables up to date, register the models that ship.

    Raises
    ------
    SettingsError
        If a URL names something that is not supported.
    """
    database = Database(settings.effective_database_url).limited(default_quotas(settings))
    database.migrate()
    store = open_store(settings.effective_object_store_url, settings.scratch_dir)
    registry = Registry(database, store)
    seed_shipped(registry, settings.models_dir or shipped_models_folder())
    redis_url = settings.redis_url.get_secret_value()
    queue = TaskQueue(redis_url, settings.queue_name, settings.job_time_limit_s)
    proofs = Proofs(database)
    jobs, meshes = Jobs(database, settings.job_retention_days), Meshes(database, settings.mesh_retention_days)
    views = Views(database)
    estimates, check = Estimates(database), partial(check_url, allowed=settings.webhook_networks)
    return Services(
        settings,
        database,
        store,
        queue,
        jobs,
        Attempts(database),
        meshes,
        Uploads(database, settings.upload_hours, settings.max_uploads, settings.max_upload_mb << 20),
        DiskRoom(store, database, settings.disk_reserve_mb << 20),
        FullTenants(),
        SingleFlight(),
        registry,
        proofs,
        Batches(database, settings.job_retention_days),
        Webhooks(database, check),
        Callbacks(database, check),
        Deliveries(database),
        estimates,
        EventStreams(database, settings.max_streams),
        OwnJobs(JobCache(jobs, estimates)),
        Waiters(jobs.unfinished, settings.max_waiters),
        Waiters(meshes.unfinished, settings.max_waiters),
        Waiters(proofs.unfinished, settings.max_waiters),
        views,
        Waiters(views.unfinished, settings.max_waiters),
        AuditTrail(AuditLog(database)),
    )


def shipped_models_folder() -> Path:
    """Return the folder of the models that ship beside this package; the service reads files there, not code."""
    return Path(__file__).resolve().parent.parent / "quadpatch" / "shipped_models"


async def get_principal(request: Request) -> Holder:
    """Return who is calling, as the auth middleware found out."""
    return cast(Holder, request.state.principal)


async def get_all_services(request: Request) -> Services:
    """Return what the app's lifespan has opened, for all tenants."""
    return cast(Services, request.app.state.services)


async def get_services(request: Request) -> Services:
    """Return what the app's lifespan has opened, as the tenant of the caller sees it."""
    services, principal = await get_all_services(request), await get_principal(request)
    return services.of(principal.tenant)


ServicesDep = Annotated[Services, Depends(get_services)]
AllServicesDep = Annotated[Services, Depends(get_all_services)]
PrincipalDep = Annotated[Holder, Depends(get_principal)]
