"""What a viewer shows, as an engine child makes it: from the files of a request to one file."""

from pathlib import Path

from quadpatch.views.model_pictures import draw_model
from quadpatch.views.outlines import write_outlines
from quadpatch.views.surfaces import Repaired, write_mesh_view, write_repair_view
from worker.engine.request import EngineRequest


def write_view(folder: Path, request: EngineRequest) -> None:
    """Write the view that a request asks for.

    Raises
    ------
    QuadpatchError
        If there is none of that mesh or model.
    """
    source, output, kind = folder / request.source, folder / request.output, request.options["kind"]
    if kind == "model":
        draw_model(Path(request.model), output)
    elif kind == "outlines":
        write_outlines(source, output)
    elif kind == "mesh":
        write_mesh_view(source, output, request.options["level"])
    else:
        reference = folder / request.reference if request.reference else None
        repaired = Repaired(folder / request.meshes["result"], folder / request.meshes["report"], source)
        write_repair_view(repaired, output, request.options["level"], reference)
