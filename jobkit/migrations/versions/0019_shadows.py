"""Shadows: candidates that run beside what jobs ask for."""

import sqlalchemy as sa
from alembic import op

revision = "0019"
down_revision = "0018"
branch_labels = None
depends_on = None


def upgrade() -> None:
    moment = sa.DateTime(timezone=True)
    op.create_table(
        "shadows",
        sa.Column("name", sa.String(128), nullable=False),
        sa.Column("candidate", sa.String(128), nullable=False),
        sa.Column("version", sa.Integer(), nullable=False),
        sa.Column("share", sa.Double(), nullable=False),
        sa.Column("created_at", moment, nullable=False),
        sa.Column("tenant", sa.String(64), nullable=False, server_default="default"),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_shadows")),
    )
    op.create_table(
        "shadow_runs",
        sa.Column("job_id", sa.String(40), nullable=False),
        sa.Column("shadow", sa.String(128), nullable=False),
        sa.Column("candidate", sa.String(160), nullable=False),
        sa.Column("baseline", sa.String(160), nullable=False),
        sa.Column("state", sa.String(32), nullable=False),
        sa.Column("attempt", sa.Integer(), nullable=False),
        sa.Column("forgiven", sa.Integer(), nullable=False),
        sa.Column("worker", sa.String(128), nullable=True),
        sa.Column("lease_until", moment, nullable=True),
        sa.Column("enqueued_at", moment, nullable=True),
        sa.Column("not_before", moment, nullable=True),
        sa.Column("holes", sa.Integer(), nullable=True),
        sa.Column("ratio", sa.Double(), nullable=True),
        sa.Column("code", sa.String(64), nullable=True),
        sa.Column("message", sa.String(1000), nullable=True),
        sa.Column("created_at", moment, nullable=False),
        sa.Column("finished_at", moment, nullable=True),
        sa.Column("tenant", sa.String(64), nullable=False, server_default="default"),
        sa.ForeignKeyConstraint(["shadow"], ["shadows.name"], name=op.f("fk_shadow_runs_shadow"), ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("job_id", name=op.f("pk_shadow_runs")),
    )
    op.create_index(op.f("ix_shadow_runs_state_created_at"), "shadow_runs", ["state", "created_at"])
    op.create_index(op.f("ix_shadow_runs_shadow_state"), "shadow_runs", ["shadow", "state"])


def downgrade() -> None:
    op.drop_table("shadow_runs")
    op.drop_table("shadows")
