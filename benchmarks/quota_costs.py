"""What quotas cost: `python -m benchmarks.quota_costs URL` fills an empty database and counts what a tenant has."""

import sys
import time
from collections.abc import Callable

from sqlalchemy import insert, text

from jobkit.database.clock import utc_now
from jobkit.database.quotas import admit_jobs, stored_bytes
from jobkit.database.session import Database
from jobkit.database.tables import JobRow, MeshRow
from quadpatch_client.schema import Quotas

N, N_WAITING, TENANT, BATCH = 100_000, 10_000, "plant-north", 1000


def main(url: str) -> None:
    """Print milliseconds."""
    database = Database(url).limited(Quotas(stored_bytes=1 << 60, jobs_waiting=2 * N_WAITING))
    database.migrate()
    now = utc_now()
    moments = {"created_at": now, "updated_at": now}
    for start in range(0, N, BATCH):
        ids = range(start, start + BATCH)
        meshes = [{"id": f"{i:064x}", "sha256": f"{i:064x}", "key": f"k{i}", "size_bytes": 5 << 20} for i in ids]
        mesh_rest = {"state": "ready", "used_at": now, "tenant": TENANT, **moments}
        job_rest = {"max_attempts": 3, "spec": {}, "model": {}, "queued_at": now, "tenant": TENANT, **moments}
        states = ["queued" if i < N_WAITING else "succeeded" for i in ids]
        sizes = {"queued": 0, "succeeded": 5 << 20}
        jobs = [
            {"id": f"job_{i}", "mesh_id": f"{i:064x}", "state": state, "result_bytes": sizes[state], **job_rest}
            for i, state in zip(ids, states, strict=True)
        ]
        with database.write() as session:
            session.execute(insert(MeshRow), [{**mesh, **mesh_rest} for mesh in meshes])
            session.execute(insert(JobRow), jobs)
    if database.engine.dialect.name == "postgresql":
        with database.engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.execute(text("VACUUM ANALYZE"))
    own = database.of(TENANT)
    with own.write() as session:
        print(f"sum of the bytes of {2 * N} rows: {_ms(lambda: stored_bytes(session, TENANT)):.1f} ms")  # noqa: T201
        print(f"admission of a job beside {N_WAITING}: {_ms(lambda: admit_jobs(session)):.1f} ms")  # noqa: T201
    database.close()


def _ms(call: Callable[[], object]) -> float:
    times = []
    for _ in range(50):
        started = time.perf_counter()
        call()
        times.append(1000 * (time.perf_counter() - started))
    # The least: other work on the machine only adds to it.
    return min(times)


if __name__ == "__main__":
    main(sys.argv[1])
