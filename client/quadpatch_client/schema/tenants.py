"""Tenants, what they may have, and what a caller is told about limits.

Tested in `tests/service/routes/test_tenants.py`.
"""

from typing import Annotated

from pydantic import Field

from quadpatch_client.schema.base import WHOLE, Moment, Request, Response
from quadpatch_client.schema.keys import Tenant as TenantName
from quadpatch_client.schema.learning import TrainedKind

_LARGEST = 2**53 - 1
# Of what a client sends: the description of a quota is that of `Quotas`.
SentQuota = Annotated[int | None, Field(ge=0, le=_LARGEST), WHOLE]
_SENT = "; null: the default of the service; 0: no limit."


class Quotas(Response):
    """What a tenant may have; 0: no limit."""

    stored_bytes: int = Field(
        default=0, description="Bytes of meshes, results, models, views and open uploads together."
    )
    jobs_waiting: int = Field(default=0, description="Jobs that wait for a worker.")
    jobs_at_once: int = Field(default=0, description="Jobs at work at the same time; others wait.")
    streams: int = Field(default=0, description="Event streams that are open at the same time.")
    requests_per_minute: int = Field(default=0, description="Requests within a minute, of all keys together.")


class Usage(Response):
    """What a tenant has."""

    stored_bytes: int = Field(description="Bytes of meshes, results, models, views and open uploads together.")
    jobs_waiting: int = Field(description="Jobs that wait for a worker.")
    jobs_at_work: int = Field(description="Jobs that workers are at.")
    streams: int = Field(description="Event streams that are open and count: where their number has a limit.")


class TenantChanges(Request):
    """What to change; fields that are left out stay as they are."""

    stored_bytes: SentQuota = Field(default=None, description=f"Bytes stored{_SENT}", examples=[100 << 30])
    jobs_waiting: SentQuota = Field(default=None, description=f"Jobs that wait{_SENT}", examples=[10_000])
    jobs_at_once: SentQuota = Field(default=None, description=f"Jobs at work at the same time{_SENT}", examples=[4])
    streams: SentQuota = Field(default=None, description=f"Event streams at the same time{_SENT}", examples=[100])
    requests_per_minute: SentQuota = Field(
        default=None, description=f"Requests within a minute{_SENT}", examples=[6_000]
    )
    disabled: bool = Field(default=False, description="Whether its keys and tokens are refused; its jobs go on.")


class Tenant(Response):
    """A tenant."""

    name: TenantName
    disabled: bool = Field(description="Whether its keys and tokens are refused.")
    quotas: Quotas = Field(description="What holds for it.")
    own_quotas: list[str] = Field(
        description="Those that were set for it; the others are defaults of the service.", examples=[["jobs_at_once"]]
    )
    created_at: Moment = Field(description="When it was first named, RFC 3339.")


class TenantWithUse(Tenant):
    """A tenant, and what it has."""

    use: Usage = Field(description="What it has now.")


class TenantList(Response):
    """Tenants by name."""

    items: list[Tenant] = Field(description="Those that keys name, and those for which something was set.")


class RatePolicy(Response):
    """How many requests are answered; the fields `RateLimit` and `RateLimit-Policy` name it."""

    name: str = Field(description="As in these fields.", examples=["tenant"])
    requests: int = Field(description="Within the window, all processes together.", examples=[6_000])
    window_s: int = Field(description="The window, in seconds.", examples=[60])


class BodyLimits(Response):
    """How large a body may be, in bytes."""

    mesh: int = Field(description="A mesh or model, unpacked.", examples=[1 << 30])
    json_body: int = Field(description="A JSON body.", examples=[1 << 20])


class JobLimits(Response):
    """What one job may take."""

    time_s: float = Field(description="Seconds of one attempt.", examples=[900.0])
    memory_mb: int = Field(description="Memory of one attempt, in MiB.", examples=[4096])
    attempts: int = Field(description="Attempts before it is given up.", examples=[3])
    queue_time_s: float = Field(description="Seconds that it waits until it is given up.", examples=[604_800.0])
    total_time_s: float = Field(description="Seconds from its acceptance to its end.", examples=[1_209_600.0])


class CallerLimits(Response):
    """What limits the one who asks."""

    tenant: TenantName
    quotas: Quotas = Field(description="What the tenant may have.")
    use: Usage = Field(description="What it has now.")
    rate: RatePolicy | None = Field(description="null: requests are not limited.")
    bodies: BodyLimits = Field(description="Sizes of bodies.")
    jobs: JobLimits = Field(description="Of each job.")
    wait_s: float = Field(description="Longest that `Prefer: wait` lets a request wait, in seconds.", examples=[30.0])
    formats_read: list[str] = Field(description="Formats of meshes that are read.", examples=[["ply", "stl"]])
    formats_written: list[str] = Field(description="Formats of results.", examples=[["ply", "stl"]])
    trainings: list[TrainedKind] = Field(
        default_factory=list,
        description="What `POST /v1/trainings` can learn now; `network` where a worker runs that has torch.",
        examples=[["dictionary", "network"]],
    )
    pdf_reports: bool = Field(
        default=False,
        description="Whether a job with `output.html_report` leaves a `report.pdf` too: a renderer is installed.",
        examples=[False],
    )


class Version(Response):
    """What runs here."""

    version: str = Field(description="Of the service.", examples=["0.2.0"])
    api: str = Field(description="Of the contract; it stands in the paths.", examples=["v1"])
    python: str = Field(description="Of Python.", examples=["3.11.9"])
