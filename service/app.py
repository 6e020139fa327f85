"""The HTTP application.

Tested in `tests/service/test_handlers.py`.
"""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import anyio.to_thread
from fastapi import Depends, FastAPI

from jobkit.settings import Settings
from jobkit.telemetry import Telemetry
from jobkit.version import VERSION
from service.audit import AuditMiddleware
from service.auth import AuthMiddleware, check_exposure
from service.body_limit import BodyLimitMiddleware
from service.cached_answer import READINESS_CACHE_S, CachedAnswer
from service.contract.document import TITLE, install_document, operation_id
from service.handlers import install_handlers
from service.head_requests import HeadMiddleware
from service.metrics import StateCollector, new_registry
from service.pacing import Pacer, PacingMiddleware
from service.rate_limits import RateLimiter
from service.request_context import RequestContextMiddleware
from service.request_telemetry import RequestTelemetryMiddleware
from service.routes import (
    audit,
    batch_results,
    batches,
    callbacks,
    deliveries,
    documentation,
    events,
    health,
    jobs,
    keys,
    limits,
    meshes,
    metrics,
    model_lifetime,
    models,
    page,
    repairs,
    results,
    retention,
    rules,
    shadows,
    tenants,
    trainings,
    uploads,
    views,
    webhooks,
)
from service.scopes import check_scope
from service.services import open_services
from service.shares import SharesMiddleware
from service.tus import TusMiddleware


def create_app(settings: Settings, telemetry: Telemetry | None = None) -> FastAPI:
    """Build the application; connections are opened when it starts, not here.

    Parameters
    ----------
    settings : Settings
    telemetry : Telemetry, optional
        Takes a span of each request, and is closed with the app; none are made unless given.

    Raises
    ------
    SettingsError
        If it would listen to other machines without API keys.
    """
    check_exposure(settings)
    app = FastAPI(
        title=TITLE,
        version=VERSION,
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        redirect_slashes=False,
        generate_unique_id_function=operation_id,
        lifespan=_lifespan,
    )
    app.state.settings = settings
    app.state.max_json_bytes = settings.max_json_kb << 10
    app.state.registry = new_registry()
    app.state.rates = RateLimiter(settings, app.state.registry)
    app.state.readiness = CachedAnswer(READINESS_CACHE_S)
    app.state.documents = {}
    app.state.telemetry = telemetry or Telemetry()
    about_access = (keys, tenants, limits, audit)
    about_jobs = (meshes, uploads, jobs, events, results, views, repairs, retention, batches, batch_results)
    about_models = (models, model_lifetime, trainings, shadows)
    about_messages = (webhooks, callbacks, deliveries)
    about_service = (health, page, documentation, metrics)
    modules = (*about_jobs, *about_models, rules, *about_messages, *about_access, *about_service)
    routers = [module.router for module in modules]
    for router in routers:
        app.include_router(router, dependencies=[Depends(check_scope)])
    install_document(app)
    install_handlers(app, [route for router in routers for route in router.routes])
    # The last one added is the outermost: ids and headers also stand on the answers of the auth middleware.
    app.add_middleware(HeadMiddleware)
    app.add_middleware(BodyLimitMiddleware, most=settings.max_bodies)
    app.add_middleware(SharesMiddleware)
    app.add_middleware(AuthMiddleware, settings=settings)
    app.add_middleware(AuditMiddleware)
    app.add_middleware(TusMiddleware)
    app.add_middleware(RequestContextMiddleware)
    app.add_middleware(RequestTelemetryMiddleware, registry=app.state.registry, telemetry=app.state.telemetry)
    app.add_middleware(PacingMiddleware, pacer=Pacer())
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    services = await anyio.to_thread.run_sync(open_services, app.state.settings)
    app.state.services = services
    collector = StateCollector(services)
    app.state.registry.register(collector)
    try:
        async with services.streams.running(), services.audit.running():
            yield
            services.job_waiters.close()
            services.mesh_waiters.close()
            services.model_waiters.close()
            services.view_waiters.close()
    finally:
        app.state.registry.unregister(collector)
        services.close()
        await app.state.rates.close()
        # Here, since uvicorn ends the process by the signal that it got.
        app.state.telemetry.close()
