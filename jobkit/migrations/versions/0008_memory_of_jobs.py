"""Memory of jobs: machines, what their engines are expected to need, and jobs that wait for it."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "machines",
        sa.Column("name", sa.String(length=128), nullable=False),
        sa.Column("limit_mb", sa.Integer(), nullable=False),
        sa.Column("free_mb", sa.Integer(), nullable=False),
        sa.Column("seen_at", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_machines")),
    )
    op.create_table(
        "reservations",
        sa.Column("worker", sa.String(length=128), nullable=False),
        sa.Column("machine", sa.String(length=128), nullable=False),
        sa.Column("is_job", sa.Boolean(), nullable=False),
        sa.Column("reserved_mb", sa.Integer(), nullable=False),
        sa.Column("used_mb", sa.Integer(), nullable=False),
        sa.Column("until", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("worker", name=op.f("pk_reservations")),
    )
    op.create_index(op.f("ix_reservations_machine"), "reservations", ["machine"])
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.add_column(sa.Column("needed_memory_mb", sa.Integer(), nullable=True))
        batch_op.add_column(sa.Column("memory_wait_since", sa.DateTime(timezone=True), nullable=True))
        batch_op.add_column(sa.Column("memory_wait_at", sa.String(length=128), nullable=True))
        batch_op.create_index(batch_op.f("ix_jobs_memory_wait_since"), ["memory_wait_since"])


def downgrade() -> None:
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_jobs_memory_wait_since"))
        batch_op.drop_column("memory_wait_at")
        batch_op.drop_column("memory_wait_since")
        batch_op.drop_column("needed_memory_mb")
    op.drop_table("reservations")
    op.drop_table("machines")
