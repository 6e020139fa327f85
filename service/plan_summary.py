"""What a job would do besides filling holes, in a sentence for people. Lengths are in mesh units.

Tested in `tests/service/routes/test_tasks.py`.
"""

from collections.abc import Callable, Mapping

from quadpatch_client.schema import (
    Denoising,
    JobSpec,
    MissingAsNan,
    MissingByProperty,
    RegionBox,
    RegionByProperty,
    Task,
)


def summary_of(spec: JobSpec) -> str:
    """Say what the job would do to its mesh."""
    return _SUMMARIES[spec.task](spec)


def _restoring(spec: JobSpec) -> str:
    missing = None if spec.restore is None else spec.restore.missing
    if missing is None or isinstance(missing, MissingAsNan):
        which = "the vertices whose coordinates are NaN"
    elif isinstance(missing, MissingByProperty):
        which = f"the vertices that the property {missing.name} marks"
    else:
        which = f"the {len(set(missing.indices)):,} vertices of the list"
    return f"give {which} a position, and keep all others"


def _denoising(spec: JobSpec) -> str:
    options = spec.denoise or Denoising()
    noise = "noise that is estimated" if options.noise is None else f"noise of {options.noise:g}"
    bound = "by no more than that noise allows" if options.max_shift is None else f"by {options.max_shift:g} at most"
    where = "" if options.region is None else _region(options.region)
    source = "" if options.reference is None else f", as learned from mesh {options.reference[:12]}"
    return f"take {noise} from the vertices{where}, moving each {bound}{source}"


def _region(region: RegionBox | RegionByProperty) -> str:
    return " in the box" if isinstance(region, RegionBox) else f" that the property {region.name} marks"


def _encoding(spec: JobSpec) -> str:
    if spec.encode is None:
        return "encode the surface"
    kept = "with its triangles" if spec.encode.keep_connectivity else "as a regular mesh"
    return f"encode the surface {kept}, no farther than {spec.encode.max_error:g} from the scan"


_SUMMARIES: Mapping[Task, Callable[[JobSpec], str]] = {
    "fill": lambda _: "fill holes",
    "restore": _restoring,
    "denoise": _denoising,
    "encode": _encoding,
    "decode": lambda _: "decode the surface of a .qpz file",
}
