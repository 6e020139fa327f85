"""Training pairs for networks: fills of holes that were cut into undamaged surface, beside the surface that was there.

The holes are cut into the mesh and filled by the same code as the real ones, since a network can only learn to correct
the errors that it is shown.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.synthetic_holes import Spacing, UncutSurface, cut_holes
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.layout import patchify, pick, seeds_near, take
from quadpatch.patches.residual_input import network_input, standardise
from quadpatch.patches.scale import PatchScale, base_surface_iterations
from quadpatch.patches.seeds import Seeds
from quadpatch.types import FloatArray, TriangleMesh

# Surface left between the holes of one round, in mean edge lengths: closer than in calibration, for the sake of many.
_MARGIN_EDGES = 2.0
# Holes are cut from this much narrower to this much wider than those that are asked for.
WIDTHS = (0.8, 1.15)


@dataclass(frozen=True)
class TrainingSurface:
    """Surface that training pairs are cut from.

    Attributes
    ----------
    mesh : TriangleMesh
        Real holes, and what else must stay unseen, are open in it.
    seeds : Seeds
        Where patches may lie.
    scale : PatchScale
    blend : EnergyBlend
        That the holes are filled by.
    diameters : (k,) float64
        Of the holes to prepare for, in mesh units.
    edge_length : float
        Mean of the mesh, in mesh units.
    """

    mesh: TriangleMesh
    seeds: Seeds
    scale: PatchScale
    blend: EnergyBlend
    diameters: FloatArray
    edge_length: float


@dataclass(frozen=True)
class TrainingPairs:
    """Pairs of question and answer, float32 each.

    Attributes
    ----------
    channels : (n, 2, N, N)
        As `network_input` gives them.
    correction : (n, N, N)
        How much higher the true surface lies, in standard deviations of the patch; 0 where `loss_mask` is 0.
    loss_mask : (n, N, N)
        1 for invented bins whose truth is known.
    """

    channels: "np.ndarray[tuple[int, ...], np.dtype[np.float32]]"
    correction: "np.ndarray[tuple[int, ...], np.dtype[np.float32]]"
    loss_mask: "np.ndarray[tuple[int, ...], np.dtype[np.float32]]"

    def __len__(self) -> int:
        """Count of pairs."""
        return len(self.channels)

    @staticmethod
    def joined(parts: "list[TrainingPairs]", resolution: int) -> "TrainingPairs":
        """Join the training pairs of several rounds."""
        none = np.zeros((0, resolution, resolution), np.float32)
        return TrainingPairs(
            np.concatenate([np.zeros((0, 2, resolution, resolution), np.float32), *(p.channels for p in parts)]),
            np.concatenate([none, *(part.correction for part in parts)]),
            np.concatenate([none, *(part.loss_mask for part in parts)]),
        )


def make_training_pairs(training_surface: TrainingSurface, rng: np.random.Generator) -> Iterator[TrainingPairs]:
    """Cut, fill and compare, round after round, at other places each time.

    Parameters
    ----------
    training_surface : TrainingSurface
    rng : numpy.random.Generator

    Yields
    ------
    TrainingPairs
        None where the surface has no room for a hole.
    """
    while True:
        width = float(rng.choice(training_surface.diameters)) * rng.uniform(*WIDTHS)
        yield _round(training_surface, width, rng)


def _round(training_surface: TrainingSurface, diameter: float, rng: np.random.Generator) -> TrainingPairs:
    scale = training_surface.scale
    spacing = Spacing(training_surface.edge_length, _MARGIN_EDGES * training_surface.edge_length)
    cut = cut_holes(UncutSurface(training_surface.mesh), diameter, spacing, rng)
    filled = training_surface.blend.fill(cut.mesh, cut.loops)
    base_surface = laplacian_smooth(filled.mesh, base_surface_iterations(scale.length, training_surface.edge_length))
    invented = filled.mesh.vertices[filled.n_measured_vertices :]
    near = take(training_surface.seeds, seeds_near(training_surface.seeds, invented, scale.length))
    sampled = patchify(filled, base_surface, near, scale)
    sampled = pick(sampled, is_unfolded(sampled.patches))
    patches = sampled.patches
    places = Seeds(patches.origins, patches.frames, np.zeros(len(patches), np.int64))
    nothing = np.zeros(len(training_surface.mesh.triangles), bool)
    truth = sample_height_maps(
        RayScene(training_surface.mesh), training_surface.mesh, nothing, places, scale.length, scale.resolution
    )
    loss_mask = truth.seen & patches.seen & ~patches.known
    seen = network_input(patches, sampled.base_heights)
    correction = standardise(np.where(loss_mask, truth.heights - patches.heights, 0.0), seen.deviation)
    return TrainingPairs(seen.channels, correction.astype(np.float32), loss_mask.astype(np.float32))
