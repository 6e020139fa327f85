"""The method: a mesh with holes in, a mesh without them out.

The stages are those of Sarkar, Varanasi and Stricker, "Learning Quadrangulated Patches For 3D Shape Processing": holes,
geometric fill, outline, quads, patches, learning, completion, reconstruction, verdicts.
"""

from dataclasses import dataclass

import numpy as np

from quadpatch.completion import Completion, Problem, complete
from quadpatch.errors import NoQuadsError
from quadpatch.expectation import UNTRIED, Expectation
from quadpatch.fill_rule import FillRule, learn_fill_rule
from quadpatch.filling.fairing import THIN_PLATE, Energy
from quadpatch.filling.fill import FilledMesh
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.judge import HoleResult, judge
from quadpatch.mesh.holes import Hole, find_holes, select_holes
from quadpatch.mesh.measures import diagonal, mean_edge_length
from quadpatch.options import RepairOptions
from quadpatch.practice import Practice, expect, practise
from quadpatch.stages import Stages
from quadpatch.types import TriangleMesh

# From rough to smooth: a noisy or sharp-edged surface is continued best by the first, a smooth one by the last.
ENERGIES = (
    Energy(membrane=0.3, plate=1.0),
    THIN_PLATE,
    *(Energy(plate=1.0, variation=weight) for weight in (0.4, 2.0, 40.0)),
)

# For surfaces on which practice can't tell the energies apart.
USUAL_ENERGY = ENERGIES[2]
# For surfaces without room for practice: they are coarse for their holes, and a rim of few edges shows no curvature to
# carry on.
UNTRIED_ENERGY = THIN_PLATE


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
    rule : FillRule
        What the fill was faired by.
    completion : Completion or None
        None where geometry alone filled the holes.
    warnings : list of str
    """

    filled: FilledMesh
    chosen: list[Hole]
    results: list[HoleResult]
    rule: FillRule
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
    rng = np.random.default_rng(options.seed)
    with stages.stage("holes"):
        holes = find_holes(mesh)
        selection = select_holes(holes, options.holes, diagonal(mesh))
    with stages.stage("fill"):
        problem, expectation = _fill(mesh, selection.chosen, rng)
    completion, warnings = None, []
    if (inpainter is not None or learn) and len(problem.filled.vertex_hole):
        try:
            completion = complete(problem, inpainter, options, rng, stages)
            if completion is None:
                warnings.append("too little undamaged surface to learn from; the holes were filled by geometry alone")
        except NoQuadsError as error:
            warnings.append(f"{error}; the holes were filled by geometry alone")
    with stages.stage("judge"):
        if completion and completion.expectation is not None:
            expectation = completion.expectation
        results = judge(holes, selection, problem.filled, completion, expectation)
    filled = completion.filled if completion else problem.filled
    return Repair(filled, selection.chosen, results, problem.rule, completion, warnings)


def _fill(mesh: TriangleMesh, chosen: list[Hole], rng: np.random.Generator) -> tuple[Problem, Expectation]:
    """Fill the holes as suits this surface; also the error to expect of that."""
    edge = mean_edge_length(mesh)
    diameters = [hole.diameter for hole in chosen]
    practice = practise(mesh, float(np.median(diameters)), edge, rng) if chosen else None
    rule, filled_again = suitable_rule(practice)
    expectation = UNTRIED
    if practice is not None and filled_again is not None:
        expectation = expect(practice, filled_again)
    filled = rule.fill(mesh, [hole.loop for hole in chosen])
    return Problem(filled, rule, diameters, edge, practice, filled_again), expectation


def suitable_rule(practice: Practice | None) -> tuple[FillRule, FilledMesh | None]:
    """Learn how this surface is continued best, as far as practice on it can tell; also the practice holes, filled."""
    if practice is None:
        return FillRule.of_one(UNTRIED_ENERGY), None
    return learn_fill_rule(practice, ENERGIES, USUAL_ENERGY)
