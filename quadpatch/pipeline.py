"""The method: a mesh with holes in, a mesh without them out.

The stages are those of Sarkar, Varanasi and Stricker, "Learning Quadrangulated Patches For 3D Shape Processing": holes,
geometric fill, outline, quads, patches, learning, completion, reconstruction, verdicts.
"""

from dataclasses import dataclass

from quadpatch.completion import Completion, complete
from quadpatch.errors import NoQuadsError
from quadpatch.filling.fill import FilledMesh, fill_holes
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.judge import HoleResult, judge
from quadpatch.mesh.holes import Hole, find_holes, select_holes
from quadpatch.mesh.measures import diagonal
from quadpatch.options import RepairOptions
from quadpatch.stages import Stages
from quadpatch.types import TriangleMesh


@dataclass(frozen=True)
class Repair:
    """The repaired mesh, and how it came to be.

    Attributes
    ----------
    filled : FilledMesh
        Measured vertices and triangles first, bit for bit.
    chosen : list of Hole
        In the order of the filled loops.
    results : list of HoleResult
        One per hole, by id.
    completion : Completion or None
        None where geometry alone filled the holes.
    warnings : list of str
    """

    filled: FilledMesh
    chosen: list[Hole]
    results: list[HoleResult]
    completion: Completion | None
    warnings: list[str]


def inpaint(
    mesh: TriangleMesh,
    inpainter: Inpainter | None,
    options: RepairOptions,
    stages: Stages | None = None,
    *,
    learn: bool = False,
) -> Repair:
    """Repair the holes of a mesh.

    Parameters
    ----------
    mesh : TriangleMesh
    inpainter : Inpainter or None
        None fills by geometry alone, unless `learn` is set.
    options : RepairOptions
    stages : Stages, optional
        Gets progress and seconds.
    learn : bool
        Learn a dictionary from the mesh's own surface.

    Returns
    -------
    Repair

    Raises
    ------
    OptionError
        If the options don't fit the mesh.
    """
    stages = stages or Stages()
    with stages.stage("holes"):
        holes = find_holes(mesh)
        selection = select_holes(holes, options.holes, diagonal(mesh))
    with stages.stage("fill"):
        filled = fill_holes(mesh, [hole.loop for hole in selection.chosen])
    completion, warnings = None, []
    if (inpainter is not None or learn) and len(filled.vertex_hole):
        try:
            completion = complete(mesh, filled, selection.chosen, inpainter, options, stages)
            if completion is None:
                warnings.append("too little undamaged surface to learn from; the holes were filled by geometry alone")
        except NoQuadsError as error:
            warnings.append(f"{error}; the holes were filled by geometry alone")
    with stages.stage("judge"):
        results = judge(holes, selection, filled, completion)
    return Repair(completion.filled if completion else filled, selection.chosen, results, completion, warnings)
