"""The one place where the wire schema of a job becomes a request to the method."""

from pathlib import PurePath
from typing import Any, TypeGuard, get_args

from jobkit.jobs.attempts import StartedAttempt
from jobkit.meshes import MeshSource
from quadpatch_client.schema import (
    SELF,
    AutoMethod,
    CnnMethod,
    Denoising,
    DictionaryMethod,
    Format,
    JobSpec,
    Method,
    OutputFormat,
    RegionBox,
    ResultFormat,
    SmoothMethod,
)
from quadpatch_rules.tasks import DONE
from worker.engine.limits import EngineLimits
from worker.engine.request import MESH_FOLDER, REFERENCE_FOLDER, EngineRequest
from worker.progress import FilledBy

# Formats that are read, but handed back as another one: a glTF with its side files is no single file.
_WRITTEN_AS: dict[str, OutputFormat] = {"gltf": "glb"}
_DEFAULT_OUTPUT: OutputFormat = "ply"
# Of a job's time; what fitting a network may take of it. The rest is for the repair itself.
_FITTING_SHARE = 2 / 3


def source_name(source: MeshSource, folder: str = MESH_FOLDER) -> str:
    """Name the mesh file so that its suffix states the format, which the reader goes by.

    It lies in a folder of its own: a glTF may name files beside it, and there must be none.
    """
    suffix = source.format or _suffix(source.filename)
    return f"{folder}/source.{suffix}" if suffix else f"{folder}/source"


def output_format(spec: JobSpec, source: MeshSource) -> ResultFormat:
    """Return the format that the job hands back: the one asked for, else that of the upload."""
    if spec.task == "encode":
        return "qpz"
    if spec.output.format is not None:
        return spec.output.format
    format_name = source.format or _suffix(source.filename)
    if format_name in _WRITTEN_AS:
        return _WRITTEN_AS[format_name]
    return next((form for form in get_args(OutputFormat) if form == format_name), _DEFAULT_OUTPUT)


def job_request(
    spec: JobSpec, source: MeshSource, model: str, limits: EngineLimits, reference: MeshSource | None = None
) -> EngineRequest:
    """Translate a job.

    Parameters
    ----------
    spec : JobSpec
    source : MeshSource
        The job's mesh.
    model : str
        `auto`, `smooth`, `self`, `self-network`, or the path of the pinned version's file.
    limits : EngineLimits
        Of the worker; the spec may only lower them.
    reference : MeshSource, optional
        The mesh that the job learns from.
    """
    tighter = tighter_limits(limits, spec)
    return EngineRequest(
        task="repair" if spec.task == "fill" else spec.task,
        source=source_name(source),
        output=f"{DONE[spec.task]}.{output_format(spec, source)}",
        model=model,
        options=method_options(spec, tighter.time_s) if spec.task == "fill" else task_options(spec),
        limits=tighter,
        with_preview=spec.output.preview,
        tint=spec.output.tint,
        with_close_ups=spec.output.closeups,
        reference="" if reference is None else source_name(reference, REFERENCE_FOLDER),
        missing=None if spec.restore is None else spec.restore.missing.model_dump(),
        scan=f"{source.sha256} {source_name(source)}" if spec.task == "fill" else "",
    )


def who_asked(started: StartedAttempt) -> dict[str, Any] | None:
    """Say for the HTML report who asked for a job, and what its mesh is called; None where it wants no such report."""
    job = started.job
    if not job.spec.output.html_report:
        return None
    return {
        "job_id": job.id,
        "tenant": started.tenant,
        **({} if started.asked_by is None else {"asked_by": started.asked_by}),
        "request_id": started.request_id,
        "label": job.spec.label,
        "metadata": job.spec.metadata,
        "rule": job.spec.rule,
        "acceptance": None if job.spec.acceptance is None else job.spec.acceptance.model_dump(),
        "mesh_name": job.mesh_name,
    }


def inspect_request(source: MeshSource, limits: EngineLimits) -> EngineRequest:
    """Translate the analysis of an upload."""
    return EngineRequest(task="inspect", source=source_name(source), limits=limits)


def method_options(spec: JobSpec, time_s: float) -> dict[str, Any]:
    """Return the options of a fill as `quadpatch.options.RepairOptions.from_dict` reads them.

    Parameters
    ----------
    spec : JobSpec
    time_s : float
        That the whole job may take.
    """
    patches = {} if isinstance(spec.method, SmoothMethod) else spec.method.patches.model_dump()
    recipe = "default" if isinstance(spec.method, SmoothMethod | AutoMethod) else spec.method.recipe
    options = {"holes": spec.holes.model_dump(), "patches": patches, "seed": spec.seed, "recipe": recipe}
    options |= {"weld_tolerance": spec.weld_tolerance, "colours": spec.colours}
    options |= {"length_unit": spec.length_unit, "attributes": spec.output.attributes}
    if isinstance(spec.method, DictionaryMethod):
        options["dictionary"] = spec.method.dictionary.model_dump()
    if isinstance(spec.method, AutoMethod):
        options["effort"] = spec.method.effort
    if fits_a_network(spec.method):
        fitting = spec.method.fitting
        most = _FITTING_SHARE * time_s
        options["network"] = {"steps": fitting.steps, "seconds": min(fitting.seconds or most, most)}
    return options


def filled_by(method: Method) -> FilledBy:
    """Say what fills the holes, as far as it matters for the time."""
    if isinstance(method, SmoothMethod) or (isinstance(method, AutoMethod) and method.effort == "fast"):
        return "geometry"
    return "fitting" if fits_a_network(method) else "model"


def fits_a_network(method: Method) -> TypeGuard[AutoMethod | CnnMethod]:
    """Say whether a network is fitted to the mesh."""
    if isinstance(method, AutoMethod):
        return method.effort == "best"
    return isinstance(method, CnnMethod) and method.model == SELF


def task_options(spec: JobSpec) -> dict[str, Any]:
    """Return the options of another task as `from_dict` of its options reads them; lengths are in mesh units."""
    options: dict[str, Any] = {"seed": spec.seed, "length_unit": spec.length_unit}
    if not isinstance(spec.method, SmoothMethod):
        options["patches"] = spec.method.patches.model_dump()
    if spec.task == "denoise":
        denoising = spec.denoise or Denoising()
        options |= denoising.model_dump(exclude={"reference"}) | {"region": _region(denoising)}
    if spec.restore is not None:
        options["base"] = spec.restore.base
    if spec.encode is not None:
        options |= spec.encode.model_dump()
    return options


def _region(denoising: Denoising) -> dict[str, Any] | str | None:
    """Say where vertices may move: in a box, or where a property says so."""
    if isinstance(denoising.region, RegionBox):
        return denoising.region.model_dump(exclude={"kind"})
    return None if denoising.region is None else denoising.region.name


def tighter_limits(limits: EngineLimits, spec: JobSpec) -> EngineLimits:
    """Return the tighter of the worker's limits and the job's."""
    return EngineLimits(
        time_s=min(limits.time_s, spec.limits.time_s or limits.time_s),
        memory_mb=min(limits.memory_mb, spec.limits.memory_mb or limits.memory_mb),
        file_mb=limits.file_mb,
        n_threads=limits.n_threads,
        n_processes=limits.n_processes,
    )


def _suffix(filename: str | None) -> str:
    suffix = PurePath(filename or "").suffix.lower().removeprefix(".")
    return suffix if suffix in get_args(Format) else ""
