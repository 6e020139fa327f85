"""What decides about the bytes of a result, as one number: two jobs that agree in it make the same.

The version of the software stands in the result itself (`JobResult.version`): the worker decides about it.

Tested in `tests/jobkit/jobs/test_reuse.py`.
"""

import hashlib
import json
from typing import Any

from quadpatch_client.schema import JobSpec, ResolvedModel

# What a sender says for other reasons than the result; of these, what stands in the report as a page all the same.
_UNRELATED = frozenset({"label", "metadata", "priority", "mesh_name", "callback_url"})
_IN_PAGES = frozenset({"label", "metadata", "mesh_name"})


def fingerprint_of(spec: JobSpec, model: ResolvedModel, asked_by: str | None = None) -> str:
    """Return the sha256, in hex, over a job's options, the bytes of its meshes and those of its model.

    Of a job with a page also over the name of the key that asked for it, `asked_by`.
    """
    unrelated = _UNRELATED - _IN_PAGES if spec.output.html_report else _UNRELATED
    facts: dict[str, Any] = {
        "spec": spec.model_dump(mode="json", exclude=set(unrelated)),
        "model": [model.kind, model.name, model.version, model.sha256],
    }
    if spec.output.html_report and asked_by is not None:
        facts["asked_by"] = asked_by
    return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()
