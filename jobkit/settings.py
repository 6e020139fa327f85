"""Settings from environment variables, all with the prefix QUADPATCH_.

Those that hold secrets may be read from files: `QUADPATCH_API_KEYS_FILE` names one with the keys.

An unknown name with that prefix stops the start: a mistyped limit that is silently ignored is worse than none.
Names that start with QUADPATCH_CLIENT_ belong to the client and are ignored.
"""

import difflib
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from pydantic import Field, SecretStr, ValidationError, field_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from jobkit.egress import Networks, parse_networks
from jobkit.errors import SettingsError

PREFIX = "QUADPATCH_"
CLIENT_PREFIX = "QUADPATCH_CLIENT_"
MIN_KEY_LENGTH = 16


class Settings(BaseSettings):
    """Every setting of the service and of the workers."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, extra="forbid", frozen=True)

    data_dir: Path = Field(
        default=Path("data"), description="Folder for everything that has no place of its own below."
    )
    database_url: SecretStr = Field(
        default=SecretStr(""),
        description="`postgresql+psycopg://user:password@host/name` or `sqlite:////a/file`; empty: SQLite in "
        "DATA_DIR/quadpatch.db.",
    )
    redis_url: SecretStr = Field(
        default=SecretStr("redis://127.0.0.1:6379/0"), description="Redis or Valkey of the queue; may hold a password."
    )
    object_store_url: str = Field(
        default="",
        description="Store of meshes, results, models and views: `s3://bucket/prefix`, with credentials, region and "
        "endpoint from the AWS_ variables, or `file:///a/folder`; empty: file://DATA_DIR/objects.",
    )
    queue_name: str = Field(
        default="quadpatch", pattern=r"^[a-z0-9-]+$", description="Queue that all tasks go through."
    )
    host: str = Field(default="127.0.0.1", description="Address to listen on; any but loopback needs api_keys.")
    port: int = Field(default=8000, ge=0, le=65_535, description="Port to listen on; 0: any free one.")
    api_keys: SecretStr = Field(
        default=SecretStr(""),
        description=f"Keys of the tenant `default` for everything, comma-separated, {MIN_KEY_LENGTH} characters or "
        "more each. Others are made by `python -m service keys create`.",
    )
    oidc_issuer: str = Field(
        default="",
        pattern=r"^(https?://[^\s?#]+)?$",
        description="Issuer of OIDC tokens that are taken besides keys, as they name it in `iss`; empty: none are.",
    )
    oidc_audience: str = Field(default="", description="What tokens have to name in `aud`; needed with an issuer.")
    oidc_tenant_claim: str = Field(
        default="tenant", min_length=1, description="Claim of a token that names the tenant."
    )
    oidc_scope_claim: str = Field(
        default="scope",
        min_length=1,
        description="Claim of a token that names its scopes: a list, or a text with spaces in between.",
    )
    oidc_allowed_networks: str = Field(
        default="",
        description="Networks in CIDR notation, comma-separated, where the issuer may be although they are not "
        "reachable from the whole internet; within them by http, too.",
    )
    tenant_stored_mb: int = Field(
        default=102_400,
        ge=0,
        le=2**32,
        description="Most MiB that a tenant stores, meshes, results, models, views and open uploads together; 0: no "
        "limit. This and the next four hold for tenants for which nothing else was set, and never for the tenant "
        "`default`.",
    )
    tenant_jobs_waiting: int = Field(
        default=10_000, ge=0, le=2**31, description="Most jobs of a tenant that wait for a worker; 0: no limit."
    )
    tenant_jobs_at_once: int = Field(
        default=0, ge=0, le=2**31, description="Most jobs of a tenant at work at the same time; 0: no limit."
    )
    tenant_streams: int = Field(
        default=100, ge=0, le=2**31, description="Most event streams of a tenant at the same time; 0: no limit."
    )
    tenant_requests_per_minute: int = Field(
        default=6_000, ge=0, le=2**31, description="Most requests of a tenant within a minute; 0: no limit."
    )
    address_requests_per_minute: int = Field(
        default=600,
        ge=0,
        le=2**31,
        description="Most requests without a valid key within a minute from one address; 0: no limit.",
    )
    health_requests_per_minute: int = Field(
        default=1_200,
        ge=0,
        le=2**31,
        description="The same for `/healthz` and `/readyz`, which are counted apart; 0: no limit.",
    )
    disk_reserve_mb: int = Field(
        default=512,
        ge=0,
        description="MiB of the disk that uploads leave free for jobs; one that would take of them is refused.",
    )
    max_upload_mb: int = Field(default=1024, ge=1, description="Largest mesh or model, in MiB.")
    max_json_kb: int = Field(default=1024, ge=1, description="Largest JSON body, in KiB.")
    max_wait_s: float = Field(default=30.0, ge=0, le=300, description="Longest that a request may wait, in seconds.")
    max_streams: int = Field(
        default=500, ge=0, description="Most event streams at the same time, of each process of the API."
    )
    max_waiters: int = Field(
        default=1000,
        ge=0,
        description="Most requests that wait for an end at the same time, of each process of the API; others are "
        "answered at once.",
    )
    max_connections: int = Field(
        default=4096, ge=16, description="Most connections at the same time, of each process of the API."
    )
    max_bodies: int = Field(
        default=256, ge=1, description="Most bodies of requests under way at the same time, of each process of the API."
    )
    max_uploads: int = Field(default=1000, ge=0, description="Most open resumable uploads at the same time.")
    upload_hours: float = Field(
        default=24.0, gt=0, le=8_760, description="Hours that a resumable upload is kept after its last bytes came."
    )
    job_time_limit_s: float = Field(default=900.0, ge=1, description="Most wall-clock seconds of one attempt.")
    job_memory_limit_mb: int = Field(default=4096, ge=256, description="Most memory of one attempt, in MiB.")
    pdf_renderer: str = Field(
        default="",
        pattern=r"^(/.*)?$",
        description="Path of a Chromium or a browser that takes its options: workers print the page of a report with "
        "it, `report.pdf`; empty: there are no PDFs.",
    )
    job_processes: int = Field(
        default=0,
        ge=0,
        le=64,
        description="Processes that share the repair of a large scan; 0: as many as OMP_NUM_THREADS says, else one for "
        "each core.",
    )
    machine: str = Field(
        default="",
        max_length=128,
        description="Name of the machine whose memory this worker shares with others; empty: its host name.",
    )
    machine_memory_mb: int = Field(
        default=0,
        ge=0,
        description="Most memory that all engines of one machine may take together, in MiB; 0: what the machine has.",
    )
    memory_wait_s: float = Field(
        default=60.0,
        ge=0,
        description="Seconds that a job waits for memory until its machine starts no other job before it.",
    )
    max_attempts: int = Field(default=3, ge=1, le=20, description="Attempts before a job is given up.")
    queue_time_limit_s: float = Field(
        default=604_800.0, ge=1, description="Most seconds that a job waits for a worker until it is given up."
    )
    total_time_limit_s: float = Field(
        default=1_209_600.0, ge=1, description="Most seconds from the acceptance of a job to its end."
    )
    lease_s: float = Field(default=15.0, ge=1, description="Seconds without a heartbeat until an attempt is lost.")
    heartbeat_s: float = Field(default=5.0, gt=0, description="Seconds between two heartbeats of an attempt.")
    dispatch_s: float = Field(
        default=1.0, gt=0, le=60, description="Seconds between two looks of the dispatcher for what is due."
    )
    leader_lease_s: float = Field(
        default=6.0, ge=1, description="Seconds without a sign from the leading dispatcher until another one leads."
    )
    job_retention_days: float = Field(
        default=30.0, ge=0, le=36_500, description="Days that a finished job is kept with all it left; 0: for ever."
    )
    mesh_retention_days: float = Field(
        default=30.0,
        ge=0,
        le=36_500,
        description="Days that a mesh is kept after its upload and after the end of the last job on it; 0: for ever.",
    )
    sweep_s: float = Field(
        default=600.0, gt=0, le=86_400, description="Seconds between two sweeps for what is past its retention."
    )
    scrub_days: float = Field(
        default=30.0,
        ge=0,
        le=36_500,
        description="Days within which all stored objects are read and checked; 0: never.",
    )
    scrub_mb_s: float = Field(default=8.0, ge=1, description="Most MiB a second that this check reads.")
    webhook_allowed_networks: str = Field(
        default="",
        description="Networks in CIDR notation, comma-separated, that webhooks may be sent to although they are not "
        "reachable from the whole internet; within them by http, too.",
    )
    webhook_timeout_s: float = Field(
        default=15.0, gt=0, le=60, description="Most seconds of one try to deliver a webhook."
    )
    webhook_log_days: float = Field(
        default=30.0, ge=1, le=36_500, description="Days that a delivery of a webhook is kept after its end."
    )
    audit_log_days: float = Field(
        default=365.0, ge=1, le=36_500, description="Days that an entry of the audit log is kept."
    )
    models_dir: Path | None = Field(
        default=None, description="Folder of models to register at start; empty: those that ship with the project."
    )
    log_level: str = Field(
        default="info", pattern="^(debug|info|warning|error)$", description="Least level that is logged."
    )

    log_format: str = Field(
        default="text", pattern="^(text|json)$", description="`text`: lines for people; `json`: one object a line."
    )
    metrics_open: bool = Field(default=False, description="Whether `/metrics` answers without a key.")

    @field_validator("webhook_allowed_networks", "oidc_allowed_networks")
    @classmethod
    def _are_networks(cls, text: str) -> str:
        parse_networks(text)
        return text

    @property
    def webhook_networks(self) -> Networks:
        """The networks that webhooks may be sent to besides the internet."""
        return parse_networks(self.webhook_allowed_networks)

    @property
    def oidc_networks(self) -> Networks:
        """The networks where the issuer of tokens may be besides the internet."""
        return parse_networks(self.oidc_allowed_networks)

    @property
    def effective_database_url(self) -> str:
        """The database URL with its default filled in."""
        return self.database_url.get_secret_value() or f"sqlite:///{self.data_dir.resolve() / 'quadpatch.db'}"

    @property
    def effective_object_store_url(self) -> str:
        """The object store URL with its default filled in."""
        return self.object_store_url or f"file://{self.data_dir.resolve() / 'objects'}"

    @property
    def scratch_dir(self) -> Path:
        """Folder for what comes from a remote object store or goes there."""
        return self.data_dir.resolve() / "scratch"

    @property
    def key_list(self) -> list[str]:
        """The API keys, one by one."""
        return [key.strip() for key in self.api_keys.get_secret_value().split(",") if key.strip()]


def load_settings() -> Settings:
    """Read the settings from the environment.

    Raises
    ------
    SettingsError
        If a value is wrong, a QUADPATCH_ name is unknown, a key is short, or the lease is shorter than two heartbeats.
    """
    refuse_unknown_names(os.environ)
    try:
        settings = Settings(**_secrets_of_files(os.environ))
    except ValidationError as error:
        # Only the place and the kind of the error: a value may be a secret.
        lines = [f"{PREFIX}{str(e['loc'][0]).upper()}: {e['msg']}" for e in error.errors(include_input=False)]
        raise SettingsError("; ".join(lines)) from None
    if any(len(key) < MIN_KEY_LENGTH for key in settings.key_list):
        raise SettingsError(f"{PREFIX}API_KEYS: every key needs at least {MIN_KEY_LENGTH} characters")
    if settings.oidc_issuer and not settings.oidc_audience:
        raise SettingsError(
            f"{PREFIX}OIDC_AUDIENCE: an issuer needs one, or its tokens for other services would be taken"
        )
    if settings.lease_s < 2 * settings.heartbeat_s:
        raise SettingsError(
            f"{PREFIX}LEASE_S: {settings.lease_s} s is less than two heartbeats of {settings.heartbeat_s} s"
        )
    return settings


def _secret_names() -> list[str]:
    return [name for name, field in Settings.model_fields.items() if field.annotation is SecretStr]


def _secrets_of_files(environment: Mapping[str, str]) -> dict[str, Any]:
    """Read the settings that come in files, as container platforms hand secrets out."""
    found = {}
    for name in _secret_names():
        variable = PREFIX + name.upper()
        path = environment.get(f"{variable}_FILE")
        if path is None:
            continue
        if variable in environment:
            raise SettingsError(f"{variable} and {variable}_FILE are both set; keep one of them")
        try:
            found[name] = SecretStr(Path(path).read_text("utf-8").strip())
        except (OSError, UnicodeDecodeError) as error:
            raise SettingsError(f"{variable}_FILE can't be read: {type(error).__name__}") from None
    return found


def refuse_unknown_names(names: Iterable[str]) -> None:
    """Raise SettingsError for the first name with the prefix that is no setting."""
    names_of_settings = [PREFIX + name.upper() for name in Settings.model_fields]
    names_of_settings += [f"{PREFIX}{name.upper()}_FILE" for name in _secret_names()]
    for name in sorted(names):
        if not name.startswith(PREFIX) or name.startswith(CLIENT_PREFIX) or name in names_of_settings:
            continue
        closest = difflib.get_close_matches(name, names_of_settings, n=1, cutoff=0.0)
        raise SettingsError(f"{name} is no setting; the closest one is {closest[0]}")


def settings_table() -> str:
    """Return all settings as a Markdown table: name, default, meaning."""
    lines = ["| variable | default | meaning |", "| --- | --- | --- |"]
    for name, field in Settings.model_fields.items():
        default = field.default.get_secret_value() if isinstance(field.default, SecretStr) else field.default
        default_text = "" if default in (None, "") else f"`{default}`"
        lines.append(f"| `{PREFIX}{name.upper()}` | {default_text} | {field.description} |")
    return "\n".join(lines) + "\n"
