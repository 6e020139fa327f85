"""Names of meshes: each job keeps that of the file it was made for."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.add_column(sa.Column("mesh_name", sa.String(length=255), nullable=True))

    op.execute("UPDATE jobs SET mesh_name = (SELECT filename FROM meshes WHERE meshes.id = jobs.mesh_id)")


def downgrade() -> None:
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.drop_column("mesh_name")
