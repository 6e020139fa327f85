"""Batches of jobs, and results that equal jobs take over. Jobs that are there are no source of results.

Tested in `tests/jobkit/database/test_session.py`.
"""

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"
branch_labels = None
depends_on = None

_INDEXES = (["batch_id", "state"], ["fingerprint"], ["cached_from"])


def upgrade() -> None:
    op.create_table(
        "batches",
        sa.Column("id", sa.String(40), nullable=False),
        sa.Column("n_jobs", sa.Integer(), nullable=False),
        sa.Column("counts", sa.JSON(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("label", sa.String(200), nullable=True),
        sa.Column("batch_metadata", sa.JSON(), nullable=False),
        sa.Column("callback_url", sa.String(2048), nullable=True),
        sa.Column("rerun_of", sa.String(40), nullable=True),
        sa.Column("cancel_requested_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("finished_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("tenant", sa.String(64), nullable=False, server_default="default"),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_batches")),
    )
    op.create_index(op.f("ix_batches_finished_at"), "batches", ["finished_at"])
    op.create_index(op.f("ix_batches_tenant_id"), "batches", ["tenant", "id"])
    op.create_table(
        "batch_events",
        sa.Column("batch_id", sa.String(40), nullable=False),
        sa.Column("sequence", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("type", sa.String(32), nullable=False),
        sa.Column("at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("data", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(
            ["batch_id"], ["batches.id"], name=op.f("fk_batch_events_batch_id"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("batch_id", "sequence", name=op.f("pk_batch_events")),
    )
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.add_column(sa.Column("batch_id", sa.String(40), nullable=True))
        batch_op.add_column(sa.Column("fingerprint", sa.String(64), nullable=True))
        batch_op.add_column(sa.Column("may_reuse", sa.Boolean(), nullable=False, server_default="0"))
        batch_op.add_column(sa.Column("cached_from", sa.String(40), nullable=True))
        batch_op.add_column(sa.Column("cached_attempt", sa.Integer(), nullable=True))
        batch_op.create_foreign_key(op.f("fk_jobs_batch_id"), "batches", ["batch_id"], ["id"])
    for columns in _INDEXES:
        op.create_index(op.f(f"ix_jobs_{'_'.join(columns)}"), "jobs", columns)


def downgrade() -> None:
    for columns in _INDEXES:
        op.drop_index(op.f(f"ix_jobs_{'_'.join(columns)}"), "jobs")
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.drop_constraint(op.f("fk_jobs_batch_id"), type_="foreignkey")
        for name in ("cached_attempt", "cached_from", "may_reuse", "fingerprint", "batch_id"):
            batch_op.drop_column(name)
    op.drop_table("batch_events")
    op.drop_table("batches")
