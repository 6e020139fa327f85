"""Cutting the training pairs of the network `residual` out of training meshes, as a repair would.

See `quadpatch.calibration.training_pairs`.

Arrays: `channels` and `correction`, float16 (both in standard deviations of the patch, where its steps of a thousandth
are less than any scanner's noise), and `asked`, bool: the loss mask.
"""

from itertools import islice

import numpy as np

from quadpatch.calibration.calibration_set import cut_calibration_set
from quadpatch.calibration.training_pairs import TrainingPairs, TrainingSurface, make_training_pairs
from quadpatch.errors import NoQuadsError
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.options import PatchOptions
from quadpatch.patches.layout import lay_out
from quadpatch.patches.residual_input import RESOLUTION
from quadpatch.patches.scale import base_surface_iterations, choose_scale
from quadpatch.recipes.fairing_energies import suitable_blend
from quadpatch.types import TriangleMesh
from training.shards import Arrays

# Diameters of the holes, in mean edges, from scratches to the widest that leave a scan room for calibration.
HOLE_EDGES = (6.0, 9.0, 13.0, 18.0)
# Rounds of cutting for each diameter, so that a small mesh doesn't show the same places over and over.
ROUNDS = 4
LENGTH_RULE = f"as wide as for a repair of holes {', '.join(f'{edges:g}' for edges in HOLE_EDGES)} mean edges wide"


def cut_training_pairs(mesh: TriangleMesh, most: int, rng: np.random.Generator) -> Arrays:
    """Cut training pairs with holes of several diameters.

    Parameters
    ----------
    mesh : TriangleMesh
    most : int
        Training pairs of one diameter, at most.
    rng : numpy.random.Generator

    Returns
    -------
    dict of str to array
        See the head of this module; no row where the mesh is too small.
    """
    parts = [_of_diameter(mesh, edges * mean_edge_length(mesh), most, rng) for edges in HOLE_EDGES]
    pairs = TrainingPairs.joined(parts, RESOLUTION)
    return {
        "channels": pairs.channels.astype(np.float16),
        "correction": pairs.correction.astype(np.float16),
        "asked": pairs.loss_mask > 0,
    }


def _of_diameter(mesh: TriangleMesh, diameter: float, most: int, rng: np.random.Generator) -> TrainingPairs:
    edge_length = mean_edge_length(mesh)
    scale = choose_scale([diameter], edge_length, PatchOptions(), RESOLUTION)
    blend, _ = suitable_blend(cut_calibration_set(mesh, diameter, edge_length, rng))
    try:
        seeds = lay_out(laplacian_smooth(mesh, base_surface_iterations(scale.length, edge_length)), scale)
    except NoQuadsError:
        return TrainingPairs.joined([], RESOLUTION)
    training_surface = TrainingSurface(mesh, seeds, scale, blend, np.array([diameter]), edge_length)
    parts: list[TrainingPairs] = []
    for part in islice(make_training_pairs(training_surface, rng), ROUNDS):
        parts.append(part)
        if sum(len(part) for part in parts) >= most:
            break
    pairs = TrainingPairs.joined(parts, RESOLUTION)
    chosen = np.sort(rng.permutation(len(pairs))[:most])
    return TrainingPairs(pairs.channels[chosen], pairs.correction[chosen], pairs.loss_mask[chosen])
