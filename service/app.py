"""The HTTP application."""

import asyncio
import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

import anyio.to_thread
from fastapi import FastAPI

from jobkit.errors import JobkitError
from jobkit.reconcile import reconcile
from jobkit.settings import Settings
from service.auth import AuthMiddleware, check_exposure
from service.document import TITLE, VERSION, install_document, operation_id
from service.frame import FrameMiddleware
from service.handlers import install_handlers
from service.routes import health, jobs, meshes, models, repairs, results
from service.services import Services, open_services

_logger = logging.getLogger("service")


def create_app(settings: Settings) -> FastAPI:
    """Build the application; connections are opened when it starts, not here.

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
        openapi_url="/openapi.json",
        redirect_slashes=False,
        generate_unique_id_function=operation_id,
        lifespan=_lifespan,
    )
    app.state.settings = settings
    app.state.max_json_bytes = settings.max_json_kb << 10
    routers = [module.router for module in (meshes, jobs, results, repairs, models, health)]
    for router in routers:
        app.include_router(router)
    install_document(app)
    install_handlers(app, [route for router in routers for route in router.routes])
    # The last one added is the outermost: ids and headers also stand on the answers of the auth middleware.
    app.add_middleware(AuthMiddleware, settings=settings)
    app.add_middleware(FrameMiddleware)
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    services = await anyio.to_thread.run_sync(open_services, app.state.settings)
    app.state.services = services
    task = asyncio.create_task(_keep_reconciling(services))
    try:
        yield
    finally:
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task
        services.close()


async def _keep_reconciling(services: Services) -> None:
    """Look for lost jobs again and again; an outage of the queue or the database is waited out."""
    while True:
        try:
            await anyio.to_thread.run_sync(reconcile, services.database, services.queue)
        except JobkitError as error:
            _logger.warning("lost jobs can't be looked for now: %s", error)
        await asyncio.sleep(services.settings.reconcile_s)
