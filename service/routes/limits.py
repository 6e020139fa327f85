"""What limits the one who asks, and what runs here.

Tested in `tests/service/routes/test_tenants.py`.
"""

import platform
from typing import get_args

from fastapi import APIRouter

from jobkit.access.tenants import Tenants
from jobkit.errors import QueueUnavailableError
from jobkit.queue import NETWORKS
from jobkit.settings import Settings
from jobkit.version import VERSION
from quadpatch_client.schema import (
    BodyLimits,
    CallerLimits,
    Format,
    JobLimits,
    OutputFormat,
    RatePolicy,
    TrainedKind,
    Version,
)
from service.rate_limits import WINDOW_S
from service.routes.common import problems
from service.services import AllServicesDep, PrincipalDep, Services
from service.strict_validation import StrictRoute

router = APIRouter(tags=["service"], route_class=StrictRoute)


@router.get("/v1/limits", response_model=CallerLimits, responses=problems())
def get_limits(services: AllServicesDep, principal: PrincipalDep) -> CallerLimits:
    """Show what limits the caller: quotas of the tenant and what it has of them, rates, sizes, formats, jobs."""
    quotas, use = Tenants(services.database).usage(principal.tenant)
    settings, requests = services.settings, quotas.requests_per_minute
    return CallerLimits(
        tenant=principal.tenant,
        quotas=quotas,
        use=use,
        rate=RatePolicy(name="tenant", requests=requests, window_s=WINDOW_S) if requests else None,
        bodies=BodyLimits(mesh=settings.max_upload_mb << 20, json_body=settings.max_json_kb << 10),
        jobs=_job_limits(settings),
        wait_s=settings.max_wait_s,
        formats_read=list(get_args(Format)),
        formats_written=list(get_args(OutputFormat)),
        trainings=_trainings(services),
        pdf_reports=bool(settings.pdf_renderer),
    )


@router.get("/v1/version", response_model=Version, responses=problems())
async def get_version() -> Version:
    """Show what runs here."""
    return Version(version=VERSION, api="v1", python=platform.python_version())


def _trainings(services: Services) -> list[TrainedKind]:
    """Say what running workers can learn; while the queue is away, of networks it is not known."""
    try:
        return ["dictionary", "network"] if NETWORKS in services.queue.abilities() else ["dictionary"]
    except QueueUnavailableError:
        return ["dictionary"]


def _job_limits(settings: Settings) -> JobLimits:
    return JobLimits(
        time_s=settings.job_time_limit_s,
        memory_mb=settings.job_memory_limit_mb,
        attempts=settings.max_attempts,
        queue_time_s=settings.queue_time_limit_s,
        total_time_s=settings.total_time_limit_s,
    )
