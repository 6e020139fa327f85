"""What a worker asks of its engine child: a folder with the request in it, and names of files in that folder.

::

    request.json     this request
    mesh/source.ply  the mesh, under a name that states its format, and nothing beside it
    mesh-0/source.ply  meshes that a training learns from, numbered, each likewise
    reference/source.ply  the clean scan that denoising learns from, likewise
    missing.json     numbers of the vertices to restore, where a list names them
    repaired.ply     the repaired mesh; restored.ply, denoised.ply, encoded.qpz, decoded.ply of other tasks
    learned.safetensors   the dictionary of a training; learned.onnx, the network of one
    corpus/          training pairs that the network learns from
    report.json      what was done to every hole, or what else was done
    preview.png      the before/after picture
    closeups.zip     a picture of each chosen hole
    report.html      the report as a page; report.pdf, printed
    calibration.json what repairs of this mesh found out by calibration; the engine adds what it finds out
    facts.json       what an inspection found
    result/, report/ the result and the report of a job that is to be viewed
    view.bin         what a viewer asked for: GLB, JSON or PNG
    engine.log       all that the child prints

Tested in `tests/worker/engine/test_main.py`.
"""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal, Self

from quadpatch_rules.option_words import Tint
from worker.engine.limits import EngineLimits

REQUEST_NAME = "request.json"
MESH_FOLDER = "mesh"
REFERENCE_FOLDER = "reference"
MISSING_NAME = "missing.json"
REPORT_NAME = "report.json"
FACTS_NAME = "facts.json"
PREVIEW_NAME = "preview.png"
CLOSE_UPS_NAME = "closeups.zip"
PAGE_NAME = "report.html"
PDF_NAME = "report.pdf"
CALIBRATION_NAME = "calibration.json"
VIEW_NAME = "view.bin"
LOG_NAME = "engine.log"

EngineTask = Literal["repair", "restore", "denoise", "encode", "decode", "train", "inspect", "prove", "view"]


@dataclass(frozen=True)
class EngineRequest:
    """One task of the engine.

    Attributes
    ----------
    task : str
        "repair" fills holes; the other tasks of a job have their own names; "inspect", "prove" and "view" are no jobs.
    source : str
        Path of the mesh file in the request's folder; empty where a model is proven.
    limits : EngineLimits
    output : str
        Name of the file to write.
    model : str
        As `quadpatch.repair.repair_file` takes it: `smooth`, `self` or the path of a model file.
    options : dict
        As `from_dict` of the task's options takes it, for a repair `quadpatch.options.RepairOptions`. Of a view its
        `kind` and `level`, as `jobkit.views.ViewOrder` has them.
    model_card : dict or None
        Of a network, in place of the one in its file.
    with_preview : bool
        Whether to draw a before/after picture.
    with_close_ups : bool
        Whether to draw each chosen hole.
    tint : str
        What the colours of invented surface say in pictures.
    html_report : dict or None
        Who asked, for the report as a page; None where none is wanted.
    reference : str
        Path of the clean scan in the request's folder; empty where nothing is learned from another mesh.
    missing : dict or None
        Which vertices to restore, as `quadpatch_client.schema.Missing` says it.
    scan : str
        Names the bytes of the mesh and how they are read, for what is kept of a calibration; empty where nothing is.
    meshes : dict
        Of a training: paths of its mesh files in the request's folder by the ids of the meshes. Of the view of a job:
        those of its files by their roles.
    """

    task: EngineTask
    source: str
    limits: EngineLimits
    output: str = ""
    model: str = ""
    options: dict[str, Any] = field(default_factory=dict)
    with_preview: bool = False
    with_close_ups: bool = False
    tint: Tint = "invented"
    html_report: dict[str, Any] | None = None
    model_card: dict[str, Any] | None = None
    reference: str = ""
    missing: dict[str, Any] | None = None
    scan: str = ""
    meshes: dict[str, str] = field(default_factory=dict)

    def save(self, folder: Path) -> None:
        """Write the request into its folder."""
        (folder / REQUEST_NAME).write_text(json.dumps(asdict(self)), encoding="utf-8")

    @classmethod
    def load(cls, folder: Path) -> Self:
        """Read back what `save` wrote."""
        values = json.loads((folder / REQUEST_NAME).read_text(encoding="utf-8"))
        return cls(**{**values, "limits": EngineLimits(**values["limits"])})
