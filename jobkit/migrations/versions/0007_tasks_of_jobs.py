"""Tasks of jobs, and the reference meshes that denoising learns from.

Jobs and stages that are there filled holes.
"""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None

FILL = "fill"


def upgrade() -> None:
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.add_column(sa.Column("task", sa.String(length=16), nullable=False, server_default=FILL))
        batch_op.add_column(sa.Column("reference_id", sa.String(length=64), nullable=True))
        batch_op.create_foreign_key(op.f("fk_jobs_reference_id"), "meshes", ["reference_id"], ["id"])
        batch_op.create_index(batch_op.f("ix_jobs_reference_id"), ["reference_id"])
    _rebuild_stages(["stage", "method", "task"], "stage, method, 'fill', count, seconds")


def downgrade() -> None:
    op.execute("DELETE FROM stages WHERE task <> 'fill'")
    _rebuild_stages(["stage", "method"], "stage, method, count, seconds")
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_jobs_reference_id"))
        batch_op.drop_constraint(op.f("fk_jobs_reference_id"), type_="foreignkey")
        batch_op.drop_column("reference_id")
        batch_op.drop_column("task")


def _rebuild_stages(keys: list[str], values: str) -> None:
    """Give the table another primary key: SQLite can't change it in place."""
    lengths = {"stage": 64, "method": 32, "task": 16}
    op.rename_table("stages", "old_stages")
    if op.get_bind().dialect.name == "postgresql":
        op.execute("ALTER TABLE old_stages RENAME CONSTRAINT pk_stages TO pk_old_stages")
    op.create_table(
        "stages",
        *(sa.Column(name, sa.String(length=lengths[name]), nullable=False) for name in keys),
        sa.Column("count", sa.BigInteger(), nullable=False),
        sa.Column("seconds", sa.Double(), nullable=False),
        sa.PrimaryKeyConstraint(*keys, name=op.f("pk_stages")),
    )
    op.execute(f"INSERT INTO stages ({', '.join([*keys, 'count', 'seconds'])}) SELECT {values} FROM old_stages")
    op.drop_table("old_stages")
