"""The tasks of a job besides filling holes, as an engine child does them: from file to file in its folder."""

from collections.abc import Callable, Mapping
from pathlib import Path

from quadpatch.compression.encode import EncodeOptions
from quadpatch.model_choice import SELF
from quadpatch.tasks.decode import decode_file
from quadpatch.tasks.encode import encode_file
from quadpatch.tasks.result import TaskResult
from quadpatch.types import Progress
from worker.engine.request import EngineRequest, EngineTask


def _encode(folder: Path, request: EngineRequest, progress: Progress) -> TaskResult:
    options = EncodeOptions.from_dict(request.options)
    return encode_file(folder / request.source, folder / request.output, request.model, options, progress)


def _decode(folder: Path, request: EngineRequest, progress: Progress) -> TaskResult:
    # The file holds its dictionary, or names one that ships, unless the job is pinned to another one.
    model = None if request.model == SELF else request.model
    return decode_file(folder / request.source, folder / request.output, model, progress)


MESH_TASKS: Mapping[EngineTask, Callable[[Path, EngineRequest, Progress], TaskResult]] = {
    "encode": _encode,
    "decode": _decode,
}
