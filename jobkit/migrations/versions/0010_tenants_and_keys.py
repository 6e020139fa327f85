"""Owners of meshes, jobs, models, aliases and subscriptions; keys, and the audit log.

What is there belongs to the tenant `default`. Models and aliases that are there were seen by all, and go on to be.

Tested in `tests/jobkit/database/test_session.py`.
"""

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None

_OWNED = ("meshes", "jobs", "webhooks", "models", "aliases")
_SHAREABLE = ("models", "aliases")
_NAMES = {"models": ("name",), "deleted_models": ("name",), "aliases": ("alias", "name")}
DEFAULT = "default"


def upgrade() -> None:
    for table in _OWNED:
        with op.batch_alter_table(table, schema=None) as batch_op:
            batch_op.add_column(sa.Column("tenant", sa.String(length=64), nullable=False, server_default=DEFAULT))
            if table in _SHAREABLE:
                batch_op.add_column(sa.Column("shared", sa.Boolean(), nullable=False, server_default=sa.true()))
            if table == "meshes":
                batch_op.add_column(sa.Column("sha256", sa.String(length=64), nullable=True))
    op.execute("UPDATE meshes SET sha256 = id")
    with op.batch_alter_table("meshes", schema=None) as batch_op:
        batch_op.alter_column("sha256", existing_type=sa.String(length=64), nullable=False)
        batch_op.create_index(batch_op.f("ix_meshes_key"), ["key"])
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_jobs_tenant_id"), ["tenant", "id"])
    for table in _SHAREABLE:
        with op.batch_alter_table(table, schema=None) as batch_op:
            batch_op.alter_column("shared", existing_type=sa.Boolean(), server_default=sa.false())
    _set_lengths(64, 128)
    op.create_table(
        "keys",
        sa.Column("id", sa.String(length=40), nullable=False),
        sa.Column("name", sa.String(length=64), nullable=False),
        sa.Column("scopes", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("old_sha256", sa.String(length=64), nullable=True),
        sa.Column("old_until", sa.DateTime(timezone=True), nullable=True),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("revoked_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("used_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("tenant", sa.String(length=64), nullable=False, server_default=DEFAULT),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_keys")),
    )
    with op.batch_alter_table("keys", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_keys_sha256"), ["sha256"], unique=True)
        batch_op.create_index(batch_op.f("ix_keys_old_sha256"), ["old_sha256"], unique=True)
    op.create_table(
        "audit",
        sa.Column("id", sa.String(length=40), nullable=False),
        sa.Column("at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("principal", sa.String(length=64), nullable=False),
        sa.Column("name", sa.String(length=64), nullable=True),
        sa.Column("operation", sa.String(length=64), nullable=False),
        sa.Column("path", sa.String(length=512), nullable=False),
        sa.Column("status", sa.Integer(), nullable=False),
        sa.Column("address", sa.String(length=64), nullable=True),
        sa.Column("request_id", sa.String(length=64), nullable=True),
        sa.Column("tenant", sa.String(length=64), nullable=False, server_default=DEFAULT),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_audit")),
    )
    with op.batch_alter_table("audit", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_audit_at"), ["at"])
        batch_op.create_index(batch_op.f("ix_audit_tenant_id"), ["tenant", "id"])


def downgrade() -> None:
    op.drop_table("audit")
    op.drop_table("keys")
    # What belongs to other tenants has no place in the tables of before.
    owned_jobs = f"(SELECT id FROM jobs WHERE tenant <> '{DEFAULT}')"
    for table in ("events", "attempts", "idempotency_keys"):
        op.execute(f"DELETE FROM {table} WHERE job_id IN {owned_jobs}")
    for table in ("jobs", "meshes", "webhooks", "aliases", "models"):
        op.execute(f"DELETE FROM {table} WHERE tenant <> '{DEFAULT}'")
    op.execute("DELETE FROM deleted_models WHERE name LIKE '%/%'")
    _set_lengths(128, 64)
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_jobs_tenant_id"))
    with op.batch_alter_table("meshes", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_meshes_key"))
        batch_op.drop_column("sha256")
    for table in _OWNED:
        with op.batch_alter_table(table, schema=None) as batch_op:
            if table in _SHAREABLE:
                batch_op.drop_column("shared")
            batch_op.drop_column("tenant")


def _set_lengths(before: int, after: int) -> None:
    for table, columns in _NAMES.items():
        with op.batch_alter_table(table, schema=None) as batch_op:
            for column in columns:
                batch_op.alter_column(column, existing_type=sa.String(before), type_=sa.String(after), nullable=False)
