"""Jobs as a service writes them."""

import json
from typing import Any

JOB_ID = "job_" + "0" * 26
PATH = f"/v1/jobs/{JOB_ID}"


def body(state: str, revision: int, **more: Any) -> bytes:
    links = {"self": PATH, "events": f"{PATH}/events", "mesh": "/v1/meshes/0", "rerun": f"{PATH}/rerun"}
    job = {
        "id": JOB_ID,
        "state": state,
        "attempt": 1,
        "max_attempts": 3,
        "percent": 0.0,
        "created_at": "2026-11-22T09:15:02.250Z",
        "mesh_id": "0" * 64,
        "model": {"requested": "smooth", "kind": "none"},
        "spec": {"mesh_id": "0" * 64},
        "revision": revision,
        "links": links,
    }
    return json.dumps(job | more).encode()
