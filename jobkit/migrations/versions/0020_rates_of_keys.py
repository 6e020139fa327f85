"""Rate limits of keys."""

import sqlalchemy as sa
from alembic import op

revision = "0020"
down_revision = "0019"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("keys", sa.Column("requests_per_minute", sa.BigInteger(), nullable=True))


def downgrade() -> None:
    op.drop_column("keys", "requests_per_minute")
