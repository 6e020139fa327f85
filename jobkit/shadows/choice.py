"""On which jobs a candidate runs, and what it is asked there.

Tested in `tests/jobkit/shadows/test_runs.py`.
"""

import hashlib

from jobkit.models.registry import Registry
from jobkit.models.resolution import resolve_method
from quadpatch_client.schema import (
    AutoMethod,
    CnnMethod,
    DictionaryMethod,
    Job,
    Method,
    ModelKind,
    ResolvedModel,
    SmoothMethod,
)
from quadpatch_rules.tasks import FILL

AUTO = "auto"


def is_chosen(shadow: str, job_id: str, share: float) -> bool:
    """Tell whether a job is among the share: by a hash of its id, so that the choice is the same wherever it is made.

    A larger share holds all jobs of a smaller one.
    """
    digest = hashlib.sha256(f"{shadow}\n{job_id}".encode()).digest()
    return int.from_bytes(digest[:8]) < share * 2**64


def is_comparable(job: Job) -> bool:
    """Tell whether a job has a result of its own with holes that a candidate can be compared on."""
    if job.spec.task != FILL or not job.state.has_result or job.cached_from is not None or job.result is None:
        return False
    holes = job.result.holes
    return holes.found > holes.skipped + holes.refused


def beside(method: Method, reference: str, kind: ModelKind) -> Method:
    """Return the method of a job with the candidate, of that kind, in place of its model."""
    if isinstance(method, AutoMethod):
        if kind == "dictionary":
            return DictionaryMethod(method="dictionary", model=reference, patches=method.patches)
        return CnnMethod(method="cnn", model=reference, patches=method.patches)
    if isinstance(method, SmoothMethod):
        return method
    return method.model_copy(update={"model": reference})


def pinned_beside(registry: Registry, method: Method, reference: str) -> tuple[Method, ResolvedModel]:
    """Return the method of a job with the candidate as its model, and its version; raises as `resolve_method`."""
    candidate = beside(method, reference, registry.resolve(reference).kind)
    return candidate, resolve_method(registry, candidate)


def made_by(model: ResolvedModel) -> str:
    """Say what a result was made by: `name@version`, or the kind of what is no version."""
    return model.kind if model.name is None else f"{model.name}@{model.version}"
