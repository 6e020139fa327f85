"""What learning adds to the geometric fill (sections 3 to 5 of the paper)."""

from dataclasses import dataclass

import numpy as np

from quadpatch.filling.fill import FilledMesh
from quadpatch.inpainters.dictionary import learn_from_patches
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.judge import Evidence, gather, trusted
from quadpatch.mesh.holes import Hole
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.options import RepairOptions
from quadpatch.patches.layout import lay_out, patchify, seeds_near, take
from quadpatch.patches.scale import PatchScale, choose_scale
from quadpatch.patches.seeds import Seeds
from quadpatch.practice import Practice, believed_share, error_per_hole, practise
from quadpatch.reconstruction.displacement import displace, join_at_rim, rim_vertices
from quadpatch.stages import Stages
from quadpatch.types import BoolArray, FloatArray, Patches, TriangleMesh

SMOOTHING_ITERATIONS = 30

# Patches that a self-similar dictionary is learned from.
_MAX_SEEDS_TO_LEARN_FROM = 2000


@dataclass(frozen=True)
class Completion:
    """The fill, displaced by what the model says.

    Attributes
    ----------
    filled : FilledMesh
    evidence : Evidence
    trust : (n_holes,) bool
        Holes that were displaced.
    believed : float
        Share of the displacement that was applied, 0..1, as practice on this mesh advised.
    error_per_gap : float or None
        Mean error of practice holes in units of their gap (see `FilledMesh`); None without practice.
    scale : PatchScale
    n_patches : int
    """

    filled: FilledMesh
    evidence: Evidence
    trust: BoolArray
    believed: float
    error_per_gap: float | None
    scale: PatchScale
    n_patches: int


@dataclass(frozen=True)
class _Ground:
    """What completion of the real and of the practice holes share."""

    inpainter: Inpainter
    seeds: Seeds
    scale: PatchScale


def complete(
    mesh: TriangleMesh,
    filled: FilledMesh,
    holes: list[Hole],
    inpainter: Inpainter | None,
    options: RepairOptions,
    stages: Stages,
) -> Completion | None:
    """Displace the fill of every hole by what a model makes of the patches around it.

    Parameters
    ----------
    mesh : TriangleMesh
        With its holes open.
    filled : FilledMesh
    holes : list of Hole
        In the order of the filled loops.
    inpainter : Inpainter or None
        None: learn a dictionary from the mesh's own patches.
    options : RepairOptions
    stages : Stages

    Returns
    -------
    Completion or None
        None where the mesh shows too little surface to learn from.

    Raises
    ------
    NoQuadsError
        If the outline can't carry one quad.
    """
    rng = np.random.default_rng(options.seed)
    diameters = [hole.diameter for hole in holes]
    edge = mean_edge_length(mesh)
    scale = choose_scale(diameters, edge, options.patches, inpainter.resolution if inpainter else None)
    with stages.stage("smooth"):
        outline = laplacian_smooth(filled.mesh, SMOOTHING_ITERATIONS)
    with stages.stage("quadrangulate"):
        seeds = lay_out(outline, scale)
    with stages.stage("patchify"):
        new = filled.mesh.vertices[filled.n_measured_vertices :]
        near = take(seeds, seeds_near(seeds, new, scale.length))
        sampled = patchify(filled, outline, near, scale)
    with stages.stage("learn"):
        if inpainter is None:
            some = _some(seeds, rng)
            everywhere = patchify(filled, outline, some, scale)
            inpainter = learn_from_patches(everywhere.patches, everywhere.outline, rng, stages.progress)
        if inpainter is None:
            return None
        ground = _Ground(inpainter, seeds, scale)
        practice = practise(mesh, float(np.median(diameters)), edge, rng)
        believed, error_per_gap = (1.0, None) if practice is None else _rehearse(practice, ground)
    with stages.stage("inpaint"):
        predicted = inpainter.predict(sampled.patches, sampled.outline)
    with stages.stage("reconstruct"):
        joined, evidence = _displacements(filled, sampled.patches, predicted, len(holes))
        trust = trusted(evidence) & (believed > 0)
        moved = new + believed * np.where(trust[filled.vertex_hole][:, None], joined, 0.0)
    return Completion(
        filled.with_vertices(moved), evidence, trust, believed, error_per_gap, scale, len(sampled.patches)
    )


def _some(seeds: Seeds, rng: np.random.Generator) -> Seeds:
    count = len(seeds.origins)
    if count <= _MAX_SEEDS_TO_LEARN_FROM:
        return seeds
    return take(seeds, np.sort(rng.choice(count, _MAX_SEEDS_TO_LEARN_FROM, replace=False)))


def _rehearse(practice: Practice, ground: _Ground) -> tuple[float, float]:
    """Complete the practice holes: the share of the displacement to believe, and the error per gap that is left."""
    filled = practice.filled
    outline = laplacian_smooth(filled.mesh, SMOOTHING_ITERATIONS)
    new = filled.mesh.vertices[filled.n_measured_vertices :]
    near = take(ground.seeds, seeds_near(ground.seeds, new, ground.scale.length))
    sampled = patchify(filled, outline, near, ground.scale)
    predicted = ground.inpainter.predict(sampled.patches, sampled.outline)
    n_holes = len(filled.gap)
    joined, evidence = _displacements(filled, sampled.patches, predicted, n_holes)
    joined = np.where(trusted(evidence)[filled.vertex_hole][:, None], joined, 0.0)
    share = believed_share(practice, joined)
    present, errors = error_per_hole(practice, joined, share)
    gap = filled.gap[present]
    return share, float(errors.sum() / gap.sum()) if gap.sum() > 0 else 0.0


def _displacements(
    filled: FilledMesh, patches: Patches, predicted: FloatArray, n_holes: int
) -> tuple[FloatArray, Evidence]:
    """Displacements (n_invented, 3), zero at the rims, and the evidence behind them."""
    rim, rim_hole = rim_vertices(filled)
    inside = displace(filled, np.flatnonzero(filled.invented_vertices), patches, predicted)
    at_rim = displace(filled, rim, patches, predicted)
    joined = join_at_rim(filled, inside.mean, rim, at_rim.mean)
    return joined, gather(filled, n_holes, inside, joined, rim_hole, at_rim)
