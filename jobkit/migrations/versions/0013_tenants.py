"""Tenants and their quotas, open event streams, and how large results are.

Tenants that keys name are there from now on.

Tested in `tests/jobkit/database/test_session.py`.
"""

from collections.abc import Iterator
from datetime import UTC, datetime

import sqlalchemy as sa
from alembic import op

revision = "0013"
down_revision = "0012"
branch_labels = None
depends_on = None

_QUOTAS = ("stored_bytes", "jobs_waiting", "jobs_at_once", "streams", "requests_per_minute")
_BATCH = 1000


def upgrade() -> None:
    tenants = op.create_table(
        "tenants",
        sa.Column("name", sa.String(length=64), nullable=False),
        *(sa.Column(name, sa.BigInteger(), nullable=True) for name in _QUOTAS),
        sa.Column("disabled", sa.Boolean(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_tenants")),
    )
    now = datetime.now(UTC)
    names = {"default", *op.get_bind().scalars(sa.text("SELECT DISTINCT tenant FROM keys"))}
    op.bulk_insert(tenants, [{"name": name, "disabled": False, "created_at": now} for name in sorted(names)])
    op.create_table(
        "streams",
        sa.Column("id", sa.String(length=40), nullable=False),
        sa.Column("process", sa.String(length=40), nullable=False),
        sa.Column("until", sa.DateTime(timezone=True), nullable=False),
        sa.Column("tenant", sa.String(length=64), nullable=False, server_default="default"),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_streams")),
    )
    op.create_index(op.f("ix_streams_tenant"), "streams", ["tenant"])
    op.create_index(op.f("ix_streams_process"), "streams", ["process"])
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.add_column(sa.Column("result_bytes", sa.BigInteger(), nullable=False, server_default="0"))
    _measure_results()
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_jobs_tenant_state"), ["tenant", "state"])
        batch_op.create_index(batch_op.f("ix_jobs_tenant_result_bytes"), ["tenant", "result_bytes"])
    op.create_index(op.f("ix_meshes_tenant_size_bytes"), "meshes", ["tenant", "size_bytes"])
    op.create_index(op.f("ix_uploads_tenant"), "uploads", ["tenant"])


def downgrade() -> None:
    op.drop_index(op.f("ix_uploads_tenant"), "uploads")
    op.drop_index(op.f("ix_meshes_tenant_size_bytes"), "meshes")
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_jobs_tenant_result_bytes"))
        batch_op.drop_index(batch_op.f("ix_jobs_tenant_state"))
        batch_op.drop_column("result_bytes")
    op.drop_table("streams")
    op.drop_table("tenants")


def _measure_results() -> None:
    jobs = sa.table("jobs", sa.column("id"), sa.column("result", sa.JSON()), sa.column("result_bytes"))
    by_id = sa.update(jobs).where(jobs.c.id == sa.bindparam("job")).values(result_bytes=sa.bindparam("size"))
    for rows in _batches(jobs):
        sizes = [{"job": id_, "size": _size_of(result)} for id_, result in rows]
        op.get_bind().execute(by_id, sizes)


def _batches(jobs: sa.TableClause) -> Iterator[list[tuple[str, object]]]:
    last = ""
    while True:
        query = sa.select(jobs.c.id, jobs.c.result).where(jobs.c.id > last, jobs.c.result.is_not(None))
        rows = [(row.id, row.result) for row in op.get_bind().execute(query.order_by(jobs.c.id).limit(_BATCH))]
        if not rows:
            return
        yield rows
        last = rows[-1][0]


def _size_of(result: object) -> int:
    files = result.get("files", ()) if isinstance(result, dict) else ()
    return sum(int(file.get("size_bytes", 0)) for file in files)
