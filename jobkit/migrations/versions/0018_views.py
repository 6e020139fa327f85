"""Views."""

import sqlalchemy as sa
from alembic import op

revision = "0018"
down_revision = "0017"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "views",
        sa.Column("id", sa.String(64), nullable=False),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("level", sa.String(16), nullable=True),
        sa.Column("mesh_id", sa.String(64), nullable=True),
        sa.Column("job_id", sa.String(40), nullable=True),
        sa.Column("reference_id", sa.String(64), nullable=True),
        sa.Column("model_name", sa.String(128), nullable=True),
        sa.Column("model_version", sa.Integer(), nullable=True),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("attempt", sa.Integer(), nullable=False),
        sa.Column("forgiven", sa.Integer(), nullable=False),
        sa.Column("worker", sa.String(128), nullable=True),
        sa.Column("lease_until", sa.DateTime(timezone=True), nullable=True),
        sa.Column("enqueued_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("key", sa.String(200), nullable=True),
        sa.Column("sha256", sa.String(64), nullable=True),
        sa.Column("size_bytes", sa.BigInteger(), nullable=False),
        sa.Column("problem", sa.JSON(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("tenant", sa.String(64), nullable=False, server_default="default"),
        sa.ForeignKeyConstraint(["mesh_id"], ["meshes.id"], name=op.f("fk_views_mesh_id"), ondelete="CASCADE"),
        sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], name=op.f("fk_views_job_id"), ondelete="CASCADE"),
        sa.ForeignKeyConstraint(
            ["reference_id"], ["meshes.id"], name=op.f("fk_views_reference_id"), ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(
            ["model_name", "model_version"],
            ["models.name", "models.version"],
            name=op.f("fk_views_model_name"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_views")),
    )
    op.create_index(op.f("ix_views_mesh_id"), "views", ["mesh_id"])
    op.create_index(op.f("ix_views_job_id"), "views", ["job_id"])
    op.create_index(op.f("ix_views_reference_id"), "views", ["reference_id"])
    op.create_index(op.f("ix_views_model_name_model_version"), "views", ["model_name", "model_version"])
    op.create_index(op.f("ix_views_key"), "views", ["key"])
    op.create_index(op.f("ix_views_tenant_size_bytes"), "views", ["tenant", "size_bytes"])


def downgrade() -> None:
    op.drop_table("views")
