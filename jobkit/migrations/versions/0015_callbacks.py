"""Deliveries to callback URLs, which belong to no subscription, and the secrets that sign them.

Tested in `tests/jobkit/database/test_session.py`.
"""

import sqlalchemy as sa
from alembic import op

revision = "0015"
down_revision = "0014"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "callback_secrets",
        sa.Column("tenant", sa.String(64), nullable=False, server_default="default"),
        sa.Column("secret", sa.String(128), nullable=False),
        sa.Column("old_secret", sa.String(128), nullable=True),
        sa.Column("old_secret_until", sa.DateTime(timezone=True), nullable=True),
        sa.Column("updated_at", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("tenant", name=op.f("pk_callback_secrets")),
    )
    with op.batch_alter_table("deliveries", schema=None) as batch_op:
        batch_op.alter_column("webhook_id", existing_type=sa.String(40), nullable=True)
        batch_op.add_column(sa.Column("callback_url", sa.String(2048), nullable=True))
        batch_op.add_column(sa.Column("tenant", sa.String(64), nullable=True))
        batch_op.add_column(sa.Column("batch_id", sa.String(40), nullable=True))
        batch_op.add_column(sa.Column("receiver", sa.String(400), nullable=False, server_default=""))
    op.execute("UPDATE deliveries SET receiver = webhook_id")
    with op.batch_alter_table("deliveries", schema=None) as batch_op:
        batch_op.alter_column("receiver", existing_type=sa.String(400), existing_nullable=False, server_default=None)
    op.create_index(op.f("ix_deliveries_job_id"), "deliveries", ["job_id"])


def downgrade() -> None:
    op.execute("DELETE FROM deliveries WHERE webhook_id IS NULL")
    op.drop_index(op.f("ix_deliveries_job_id"), "deliveries")
    with op.batch_alter_table("deliveries", schema=None) as batch_op:
        for name in ("receiver", "batch_id", "tenant", "callback_url"):
            batch_op.drop_column(name)
        batch_op.alter_column("webhook_id", existing_type=sa.String(40), nullable=False)
    op.drop_table("callback_secrets")
