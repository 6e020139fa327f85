"""The name of the key that asked for a job, for its report; earlier jobs have none."""

import sqlalchemy as sa
from alembic import op

revision = "0021"
down_revision = "0020"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("jobs", sa.Column("asked_by", sa.String(64), nullable=True))


def downgrade() -> None:
    op.drop_column("jobs", "asked_by")
