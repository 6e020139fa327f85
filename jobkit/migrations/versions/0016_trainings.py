"""The meshes of trainings."""

import sqlalchemy as sa
from alembic import op

revision = "0016"
down_revision = "0015"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "training_meshes",
        sa.Column("job_id", sa.String(40), nullable=False),
        sa.Column("mesh_id", sa.String(64), nullable=False),
        sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], name=op.f("fk_training_meshes_job_id")),
        sa.ForeignKeyConstraint(["mesh_id"], ["meshes.id"], name=op.f("fk_training_meshes_mesh_id")),
        sa.PrimaryKeyConstraint("job_id", "mesh_id", name=op.f("pk_training_meshes")),
    )
    op.create_index(op.f("ix_training_meshes_mesh_id"), "training_meshes", ["mesh_id"])


def downgrade() -> None:
    op.drop_table("training_meshes")
