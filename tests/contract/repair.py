"""A scan is uploaded, repaired and fetched by the client that openapi-python-client makes of openapi.yaml.

`python repair.py URL SCAN REPAIRED`, beside the package `quadpatch_api`.
"""

import json
import sys
from io import BytesIO
from pathlib import Path

from quadpatch_api import Client
from quadpatch_api.api.jobs import create_job, get_job
from quadpatch_api.api.meshes import get_mesh, upload_mesh
from quadpatch_api.api.results import get_report, get_result
from quadpatch_api.models import FillReport, Job, JobSpec, Mesh, Problem, SmoothMethod
from quadpatch_api.types import File


def repair(url: str, scan: Path, repaired: Path) -> dict[str, object]:
    """Repair one scan; return the state of the job, the verdicts on its holes, and the code of a refusal."""
    with Client(base_url=url) as client:
        body = File(payload=BytesIO(scan.read_bytes()))
        mesh = upload_mesh.sync(client=client, body=body, filename=scan.name)
        assert isinstance(mesh, Mesh), mesh
        spec = JobSpec(mesh_id=mesh.id, method=SmoothMethod(method="smooth"))
        job = create_job.sync(client=client, body=spec)
        while isinstance(job, Job) and job.state.value in {"queued", "running"}:
            job = get_job.sync(job.id, client=client, prefer="wait=5")
        assert isinstance(job, Job), job
        report = get_report.sync(job.id, client=client)
        assert isinstance(report, FillReport), report
        result = get_result.sync(job.id, client=client)
        assert isinstance(result, File), result
        repaired.write_bytes(result.payload.read())
        refused = get_mesh.sync("0" * 64, client=client)
        assert isinstance(refused, Problem), refused
        return {
            "state": job.state.value,
            "holes": [hole.verdict.value for hole in report.holes],
            "code": str(refused.code),
        }


if __name__ == "__main__":
    address, source, target = sys.argv[1:]
    sys.stdout.write(json.dumps(repair(address, Path(source), Path(target))))
