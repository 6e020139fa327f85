"""What the scrub of the object store has read, and what it found damaged."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

# The moment from which an object counts that was never checked.
SINCE = {"meshes": "created_at", "jobs": "finished_at", "models": None}


def upgrade() -> None:
    for table, since in SINCE.items():
        with op.batch_alter_table(table, schema=None) as batch_op:
            batch_op.add_column(sa.Column("checked_at", sa.DateTime(timezone=True), nullable=True))
            if since is not None:
                batch_op.create_index(batch_op.f(f"ix_{table}_checked_at_{since}"), ["checked_at", since])
    op.create_table(
        "damaged_objects",
        sa.Column("key", sa.String(length=1024), nullable=False),
        sa.Column("kind", sa.String(length=16), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("found_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("checked_at", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("key", name=op.f("pk_damaged_objects")),
    )
    op.create_table(
        "scrub_counts",
        sa.Column("kind", sa.String(length=16), nullable=False),
        sa.Column("objects", sa.BigInteger(), nullable=False),
        sa.Column("size_bytes", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("kind", name=op.f("pk_scrub_counts")),
    )


def downgrade() -> None:
    op.drop_table("scrub_counts")
    op.drop_table("damaged_objects")
    for table, since in SINCE.items():
        with op.batch_alter_table(table, schema=None) as batch_op:
            if since is not None:
                batch_op.drop_index(batch_op.f(f"ix_{table}_checked_at_{since}"))
            batch_op.drop_column("checked_at")
