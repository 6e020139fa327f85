"""Tables. Portable types only: PostgreSQL and SQLite hold the same rows.

A mesh is named by its bytes and the tenant that it belongs to (`mesh_id_of`). The names of models and aliases of other
tenants than the default one begin with that of the tenant and a slash (`own_name`). A job's `revision` is the number of
its latest event; it is raised in the same statement that changes the job, which makes event numbers gapless without a
lock of their own.

Tested in `tests/jobkit/database/test_session.py`.
"""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, BigInteger, ForeignKey, ForeignKeyConstraint, Index, String, Text, UniqueConstraint
from sqlalchemy.engine.default import DefaultExecutionContext
from sqlalchemy.orm import Mapped, mapped_column

from jobkit.database import batch_tables  # noqa: F401 - jobs name batches
from jobkit.database.table_base import Base
from jobkit.database.tenancy import Owned, Shareable


def _own_id(context: DefaultExecutionContext) -> str:
    """Take the id of a row of the default tenant, which is the sha256."""
    return str(context.get_current_parameters()["id"])  # type: ignore[no-untyped-call]


class MeshRow(Owned, Base):
    """An uploaded mesh and its analysis.

    `filename` is that of its latest upload. `calibrations` is what repairs found out about it by calibration
    (`quadpatch_rules/calibration_records.py`), for the next one.
    `used_at` is when its bytes came last, or when the last job on it ended that retention has removed since.
    `checked_at`, here, of jobs and of models, is when the scrub last read the objects that the row names.
    """

    __tablename__ = "meshes"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    sha256: Mapped[str] = mapped_column(String(64), default=_own_id)
    key: Mapped[str] = mapped_column(String(200))
    size_bytes: Mapped[int] = mapped_column(BigInteger)
    filename: Mapped[str | None] = mapped_column(String(255))
    format: Mapped[str | None] = mapped_column(String(16))
    state: Mapped[str] = mapped_column(String(32))
    attempt: Mapped[int] = mapped_column(default=0)
    forgiven: Mapped[int] = mapped_column(default=0)
    worker: Mapped[str | None] = mapped_column(String(128))
    lease_until: Mapped[datetime | None]
    enqueued_at: Mapped[datetime | None]
    facts: Mapped[dict[str, Any] | None]
    problem: Mapped[dict[str, Any] | None]
    calibrations: Mapped[str | None] = mapped_column(Text, deferred=True)
    pinned: Mapped[bool] = mapped_column(default=False)
    used_at: Mapped[datetime]
    checked_at: Mapped[datetime | None]
    created_at: Mapped[datetime]
    updated_at: Mapped[datetime]
    __table_args__ = (
        Index(None, "state"),
        Index(None, "used_at"),
        Index(None, "checked_at", "created_at"),
        Index(None, "key"),
        Index(None, "tenant", "size_bytes"),
    )


class JobRow(Owned, Base):
    """A job. This row is authoritative; the queue is a hint.

    `attempt` fences and never falls; `forgiven` says how many attempts ended for reasons that lie outside of the job (a
    drained worker, a store that refused writes) and don't count towards `max_attempts`. A queued job that waits for
    such a reason to pass is not started before `not_before`. `queued_at` is when it last began to wait. `mesh_name` is
    the name of the file that was uploaded for this job: the mesh itself may have another one later. `task`,
    `priority` and `reference_id`, the mesh that it learns from, are those of the spec. A queued job that did not fit
    into the memory of a machine waits since `memory_wait_since` for `needed_memory_mb`, in MiB, and `memory_wait_at` is
    the machine that holds back others for it in the end. `result_bytes` is the size of all files of the result.

    `fingerprint` stands for all that decides about the bytes of the result (`jobkit/jobs/fingerprints.py`). Where
    `may_reuse` is set, the job takes over the result of another one with the same fingerprint. Then its files are those
    of the attempt `cached_attempt` of the job `cached_from`, whose row may be gone.

    `asked_by` names the key that the request came with, as the report does; null where none was needed.
    """

    __tablename__ = "jobs"
    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    mesh_id: Mapped[str] = mapped_column(String(64), ForeignKey("meshes.id"))
    mesh_name: Mapped[str | None] = mapped_column(String(255))
    task: Mapped[str] = mapped_column(String(16), default="fill", server_default="fill")
    reference_id: Mapped[str | None] = mapped_column(String(64), ForeignKey("meshes.id"))
    priority: Mapped[int] = mapped_column(default=1, server_default="1")
    state: Mapped[str] = mapped_column(String(32))
    attempt: Mapped[int] = mapped_column(default=0)
    max_attempts: Mapped[int]
    forgiven: Mapped[int] = mapped_column(default=0)
    revision: Mapped[int] = mapped_column(default=1)
    stage: Mapped[str | None] = mapped_column(String(64))
    percent: Mapped[float] = mapped_column(default=0.0)
    spec: Mapped[dict[str, Any]]
    model: Mapped[dict[str, Any]]
    error: Mapped[dict[str, Any] | None]
    result: Mapped[dict[str, Any] | None]
    result_bytes: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")
    rerun_of: Mapped[str | None] = mapped_column(String(40))
    worker: Mapped[str | None] = mapped_column(String(128))
    lease_until: Mapped[datetime | None]
    enqueued_at: Mapped[datetime | None]
    queued_at: Mapped[datetime]
    not_before: Mapped[datetime | None]
    needed_memory_mb: Mapped[int | None]
    memory_wait_since: Mapped[datetime | None]
    memory_wait_at: Mapped[str | None] = mapped_column(String(128))
    cancel_requested_at: Mapped[datetime | None]
    pinned: Mapped[bool] = mapped_column(default=False)
    batch_id: Mapped[str | None] = mapped_column(String(40), ForeignKey("batches.id"))
    fingerprint: Mapped[str | None] = mapped_column(String(64))
    may_reuse: Mapped[bool] = mapped_column(default=False, server_default="0")
    cached_from: Mapped[str | None] = mapped_column(String(40))
    cached_attempt: Mapped[int | None]
    request_id: Mapped[str | None] = mapped_column(String(64))
    asked_by: Mapped[str | None] = mapped_column(String(64))
    traceparent: Mapped[str | None] = mapped_column(String(64))
    created_at: Mapped[datetime]
    updated_at: Mapped[datetime]
    started_at: Mapped[datetime | None]
    finished_at: Mapped[datetime | None]
    checked_at: Mapped[datetime | None]
    __table_args__ = (
        Index(None, "state", "id"),
        Index(None, "tenant", "id"),
        Index(None, "tenant", "state"),
        Index(None, "tenant", "result_bytes"),
        Index(None, "mesh_id"),
        Index(None, "reference_id"),
        Index(None, "finished_at"),
        Index(None, "checked_at", "finished_at"),
        Index(None, "memory_wait_since"),
        Index(None, "batch_id", "state"),
        Index(None, "fingerprint"),
        Index(None, "cached_from"),
    )


class AttemptRow(Base):
    """One try at a job."""

    __tablename__ = "attempts"
    job_id: Mapped[str] = mapped_column(String(40), ForeignKey("jobs.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    worker: Mapped[str] = mapped_column(String(128))
    outcome: Mapped[str | None] = mapped_column(String(32))
    error: Mapped[dict[str, Any] | None]
    peak_memory_mb: Mapped[int | None]
    started_at: Mapped[datetime]
    finished_at: Mapped[datetime | None]


class EventRow(Base):
    """One change of a job, written in the transaction that made it."""

    __tablename__ = "events"
    job_id: Mapped[str] = mapped_column(String(40), ForeignKey("jobs.id"), primary_key=True)
    sequence: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    type: Mapped[str] = mapped_column(String(32))
    at: Mapped[datetime]
    attempt: Mapped[int]
    data: Mapped[dict[str, Any]]


class ModelRow(Shareable, Base):
    """One immutable version of a model, and its proof: `attempt` fences and `forgiven` forgives as in an analysis."""

    __tablename__ = "models"
    name: Mapped[str] = mapped_column(String(128), primary_key=True)
    version: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    kind: Mapped[str] = mapped_column(String(32))
    format: Mapped[str] = mapped_column(String(16))
    sha256: Mapped[str] = mapped_column(String(64))
    size_bytes: Mapped[int] = mapped_column(BigInteger)
    key: Mapped[str] = mapped_column(String(200))
    card: Mapped[dict[str, Any]]
    state: Mapped[str] = mapped_column(String(32), default="proving")
    problem: Mapped[dict[str, Any] | None]
    attempt: Mapped[int] = mapped_column(default=0)
    forgiven: Mapped[int] = mapped_column(default=0)
    worker: Mapped[str | None] = mapped_column(String(128))
    lease_until: Mapped[datetime | None]
    enqueued_at: Mapped[datetime | None]
    deprecated_at: Mapped[datetime | None]
    deprecation: Mapped[str | None] = mapped_column(String(500))
    created_at: Mapped[datetime]
    checked_at: Mapped[datetime | None]
    __table_args__ = (UniqueConstraint("name", "sha256"),)


class DeletedModelRow(Base):
    """The highest version of a name that was deleted: numbers up to it never come back."""

    __tablename__ = "deleted_models"
    name: Mapped[str] = mapped_column(String(128), primary_key=True)
    version: Mapped[int]


class AliasRow(Shareable, Base):
    """A name that points to a model version."""

    __tablename__ = "aliases"
    alias: Mapped[str] = mapped_column(String(128), primary_key=True)
    name: Mapped[str] = mapped_column(String(128))
    version: Mapped[int]
    updated_at: Mapped[datetime]
    __table_args__ = (ForeignKeyConstraint(["name", "version"], ["models.name", "models.version"]),)


class IdempotencyRow(Base):
    """A key that a client sent, and what the request made: a job, or something that `made` names."""

    __tablename__ = "idempotency_keys"
    principal: Mapped[str] = mapped_column(String(64), primary_key=True)
    key: Mapped[str] = mapped_column(String(255), primary_key=True)
    request_sha256: Mapped[str] = mapped_column(String(64))
    job_id: Mapped[str | None] = mapped_column(String(40), ForeignKey("jobs.id"))
    made: Mapped[str | None] = mapped_column(String(200))
    created_at: Mapped[datetime]


class RemovalRow(Base):
    """An object that a sweep is about to delete; no row may come to name it before `until`."""

    __tablename__ = "removals"
    key: Mapped[str] = mapped_column(String(1024), primary_key=True)
    until: Mapped[datetime]


class DamagedRow(Base):
    """An object whose bytes are not those that were stored, or can't be read; `checked_at` is its latest check."""

    __tablename__ = "damaged_objects"
    key: Mapped[str] = mapped_column(String(1024), primary_key=True)
    kind: Mapped[str] = mapped_column(String(16))
    sha256: Mapped[str] = mapped_column(String(64))
    found_at: Mapped[datetime]
    checked_at: Mapped[datetime]


class ScrubRow(Base):
    """How many objects of a kind the scrub has read, and how many bytes."""

    __tablename__ = "scrub_counts"
    kind: Mapped[str] = mapped_column(String(16), primary_key=True)
    objects: Mapped[int] = mapped_column(BigInteger)
    size_bytes: Mapped[int] = mapped_column(BigInteger)


class LeaderRow(Base):
    """Who leads among processes of one kind, and until when unless it says so again."""

    __tablename__ = "leaders"
    name: Mapped[str] = mapped_column(String(32), primary_key=True)
    holder: Mapped[str] = mapped_column(String(128))
    until: Mapped[datetime]
    since: Mapped[datetime]


class TurnRow(Base):
    """When a job of a tenant was started last."""

    __tablename__ = "turns"
    tenant: Mapped[str] = mapped_column(String(64), primary_key=True)
    at: Mapped[datetime]


class MachineRow(Base):
    """The memory of a machine with workers, in MiB, as one of them found it last."""

    __tablename__ = "machines"
    name: Mapped[str] = mapped_column(String(128), primary_key=True)
    limit_mb: Mapped[int]
    free_mb: Mapped[int]
    seen_at: Mapped[datetime]


class ReservationRow(Base):
    """The MiB that the engine of a worker is expected to need, and those that it has, as long as its lease lasts.

    `is_job` tells the engine of a job from that of an analysis or a proof.
    """

    __tablename__ = "reservations"
    worker: Mapped[str] = mapped_column(String(128), primary_key=True)
    machine: Mapped[str] = mapped_column(String(128))
    is_job: Mapped[bool]
    reserved_mb: Mapped[int]
    used_mb: Mapped[int]
    until: Mapped[datetime]
    __table_args__ = (Index(None, "machine"),)


class StageRow(Base):
    """How often a stage has run in published jobs of a task, and how long in all."""

    __tablename__ = "stages"
    stage: Mapped[str] = mapped_column(String(64), primary_key=True)
    method: Mapped[str] = mapped_column(String(32), primary_key=True)
    task: Mapped[str] = mapped_column(String(16), primary_key=True, default="fill")
    count: Mapped[int] = mapped_column(BigInteger)
    seconds: Mapped[float]


class AttemptCountRow(Base):
    """How many attempts have ended in one way; grows even where retention removes the attempts themselves."""

    __tablename__ = "attempt_counts"
    outcome: Mapped[str] = mapped_column(String(32), primary_key=True)
    code: Mapped[str] = mapped_column(String(64), primary_key=True)
    count: Mapped[int] = mapped_column(BigInteger)


class WebhookRow(Owned, Base):
    """A subscription: where to send which events. Messages are signed with the old secret as well for a while."""

    __tablename__ = "webhooks"
    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    url: Mapped[str] = mapped_column(String(2048))
    secret: Mapped[str] = mapped_column(String(128))
    old_secret: Mapped[str | None] = mapped_column(String(128))
    old_secret_until: Mapped[datetime | None]
    events: Mapped[list[str]] = mapped_column(JSON(none_as_null=True))
    description: Mapped[str | None] = mapped_column(String(255))
    enabled: Mapped[bool] = mapped_column(default=True)
    failing_since: Mapped[datetime | None]
    created_at: Mapped[datetime]
    updated_at: Mapped[datetime]


class DeliveryRow(Base):
    """A message to a subscriber or to a callback URL, written in the transaction of the change that it reports.

    `receiver` is the subscription, or the tenant and the host of the callback URL: to each of them only a few messages
    are sent at a time. A message to a callback URL is signed with the secret of `tenant`.
    """

    __tablename__ = "deliveries"
    id: Mapped[str] = mapped_column(String(40), primary_key=True)
    webhook_id: Mapped[str | None] = mapped_column(String(40), ForeignKey("webhooks.id", ondelete="CASCADE"))
    callback_url: Mapped[str | None] = mapped_column(String(2048))
    tenant: Mapped[str | None] = mapped_column(String(64))
    receiver: Mapped[str] = mapped_column(String(400))
    job_id: Mapped[str | None] = mapped_column(String(40))
    batch_id: Mapped[str | None] = mapped_column(String(40))
    type: Mapped[str] = mapped_column(String(64))
    payload: Mapped[dict[str, Any]]
    state: Mapped[str] = mapped_column(String(16))
    tries: Mapped[int] = mapped_column(default=0)
    next_try_at: Mapped[datetime | None]
    replay_of: Mapped[str | None] = mapped_column(String(40))
    created_at: Mapped[datetime]
    finished_at: Mapped[datetime | None]
    __table_args__ = (Index(None, "state", "next_try_at"), Index(None, "webhook_id", "id"), Index(None, "job_id"))


class CallbackSecretRow(Owned, Base):
    """What signs messages to callback URLs of a tenant; as that of a subscription, it goes on for a while."""

    __tablename__ = "callback_secrets"
    tenant: Mapped[str] = mapped_column(String(64), primary_key=True)
    secret: Mapped[str] = mapped_column(String(128))
    old_secret: Mapped[str | None] = mapped_column(String(128))
    old_secret_until: Mapped[datetime | None]
    updated_at: Mapped[datetime]


class DeliveryTryRow(Base):
    """One try at a delivery, and what came back."""

    __tablename__ = "delivery_tries"
    delivery_id: Mapped[str] = mapped_column(
        String(40), ForeignKey("deliveries.id", ondelete="CASCADE"), primary_key=True
    )
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    at: Mapped[datetime]
    status: Mapped[int | None]
    error: Mapped[str | None] = mapped_column(String(500))
    milliseconds: Mapped[int]
