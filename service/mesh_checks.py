"""Whether a mesh can be what a job asks for, as far as its analysis tells.

A job may come before the analysis: then the engine finds out.

Tested in `tests/service/routes/test_tasks.py`.
"""

from jobkit.batches.meshes import MeshOutline
from jobkit.errors import MeshEncodedError, MeshNotEncodedError, MeshRejectedError
from quadpatch_client.schema import JobSpec, Mesh, MissingAsNan

# What `quadpatch.errors` calls a mesh with coordinates that are no numbers.
_NOT_FINITE = "not_finite"
_ENCODED = "qpz"


def check_mesh(mesh: MeshOutline, spec: JobSpec) -> None:
    """Raise where the job's task can't be done on the mesh.

    Raises
    ------
    MeshRejectedError
        If the analysis refused it. Coordinates that are no numbers are no reason where these are what to restore.
    MeshEncodedError
        If it is a `.qpz` file, and the task is not to decode it.
    MeshNotEncodedError
        If it is none, and the task is to decode it.
    """
    if not (_restores_nan(spec) and mesh.problem is not None and mesh.problem.code == _NOT_FINITE):
        _refuse_rejected(mesh, "mesh")
    if mesh.format is None:
        return
    is_encoded = mesh.format == _ENCODED
    if is_encoded and spec.task != "decode":
        raise MeshEncodedError(f"mesh {mesh.id} is a .qpz file: decode it first, with a job of the task decode")
    if spec.task == "decode" and not is_encoded:
        raise MeshNotEncodedError(f"mesh {mesh.id} is a {mesh.format} file; only .qpz files can be decoded")


def check_reference(reference: Mesh, name: str = "the reference") -> None:
    """Raise where nothing can be learned from the mesh; `name` is for people.

    Raises
    ------
    MeshRejectedError, MeshEncodedError
    """
    _refuse_rejected(MeshOutline.of(reference), name)
    if reference.facts is not None and reference.facts.format == _ENCODED:
        raise MeshEncodedError(f"{name} {reference.id} is a .qpz file: decode it first")


def _restores_nan(spec: JobSpec) -> bool:
    return spec.task == "restore" and spec.restore is not None and isinstance(spec.restore.missing, MissingAsNan)


def _refuse_rejected(mesh: MeshOutline, name: str) -> None:
    if mesh.problem is not None:
        raise MeshRejectedError(f"{name} {mesh.id} was rejected ({mesh.problem.code}): {mesh.problem.message}")
