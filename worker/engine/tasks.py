"""The tasks of a job besides filling holes, as an engine child does them: from file to file in its folder."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from quadpatch.compression.encode import EncodeOptions
from quadpatch.denoising.denoise import DenoiseOptions
from quadpatch.errors import TorchMissingError
from quadpatch.model_choice import SELF
from quadpatch.progress import Progress
from quadpatch.restoration.restore import RestoreOptions
from quadpatch.tasks.decode import decode_file
from quadpatch.tasks.denoise import denoise_file
from quadpatch.tasks.encode import encode_file
from quadpatch.tasks.restore import restore_file
from quadpatch.tasks.result import TaskResult
from worker.engine.request import MISSING_NAME, EngineRequest, EngineTask


def _restore(folder: Path, request: EngineRequest, progress: Progress) -> TaskResult:
    return restore_file(
        folder / request.source,
        folder / request.output,
        _missing(folder, request.missing or {"kind": "nan"}),
        request.model,
        RestoreOptions.from_dict(request.options),
        progress,
        request.model_card,
    )


def _missing(folder: Path, missing: Mapping[str, Any]) -> str | Path:
    """Say which vertices are missing, as `restore_file` takes it: a list goes into a file."""
    if missing["kind"] == "property":
        return f"property:{missing['name']}"
    if missing["kind"] == "nan":
        return "nan"
    path = folder / MISSING_NAME
    path.write_text(json.dumps(missing["indices"]), encoding="utf-8")
    return path


def _denoise(folder: Path, request: EngineRequest, progress: Progress) -> TaskResult:
    return denoise_file(
        folder / request.source,
        folder / request.output,
        request.model,
        DenoiseOptions.from_dict(request.options),
        progress,
        folder / request.reference if request.reference else None,
    )


def _encode(folder: Path, request: EngineRequest, progress: Progress) -> TaskResult:
    options = EncodeOptions.from_dict(request.options)
    return encode_file(folder / request.source, folder / request.output, request.model, options, progress)


def _decode(folder: Path, request: EngineRequest, progress: Progress) -> TaskResult:
    # The file holds its dictionary, or names one that ships, unless the job is pinned to another one.
    model = None if request.model == SELF else request.model
    return decode_file(folder / request.source, folder / request.output, model, progress)


def train(folder: Path, request: EngineRequest, progress: Progress) -> dict[str, Any]:
    """Learn what the output is to hold, a dictionary or a network, from the meshes of a request; return the report."""
    from training.sources import Source  # noqa: PLC0415  few engines need it

    meshes, output = [Source(id_, folder / name, id_) for id_, name in request.meshes.items()], folder / request.output
    if output.suffix == ".onnx":
        try:
            from training.requested_network import NetworkTrainingOptions, train_network  # noqa: PLC0415  an extra
        except ModuleNotFoundError as error:
            raise TorchMissingError(f"fitting a network needs {error.name}, which this worker does not have") from error
        return train_network(meshes, output, NetworkTrainingOptions(**request.options), progress)
    from training.requested import TrainingOptions, train_dictionary  # noqa: PLC0415

    return train_dictionary(meshes, output, TrainingOptions(**request.options), progress)


MESH_TASKS: Mapping[EngineTask, Callable[[Path, EngineRequest, Progress], TaskResult]] = {
    "restore": _restore,
    "denoise": _denoise,
    "encode": _encode,
    "decode": _decode,
}
