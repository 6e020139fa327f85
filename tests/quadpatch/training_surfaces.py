"""Surface that training pairs are cut from."""

import numpy as np

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.training_pairs import TrainingSurface
from quadpatch.filling.fairing import THIN_PLATE
from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.options import PatchOptions
from quadpatch.patches.layout import lay_out
from quadpatch.patches.residual_input import RESOLUTION
from quadpatch.patches.scale import base_surface_iterations, choose_scale
from quadpatch.patches.seeds import Seeds
from quadpatch.types import Patches, TriangleMesh


def ground_of(mesh: TriangleMesh, diameter: float, overlap: int | None = None) -> TrainingSurface:
    """Prepare a whole mesh for holes of one diameter, as a repair would."""
    edge_length = mean_edge_length(mesh)
    scale = choose_scale([diameter], edge_length, PatchOptions(overlap=overlap), RESOLUTION)
    seeds = lay_out(laplacian_smooth(mesh, base_surface_iterations(scale.length, edge_length)), scale)
    return TrainingSurface(mesh, seeds, scale, EnergyBlend.of_one(THIN_PLATE), np.array([diameter]), edge_length)


def looking_down(*places: tuple[float, float, float]) -> Seeds:
    """Seeds whose frames are the axes of space."""
    return Seeds(np.array(places), np.tile(np.eye(3), (len(places), 1, 1)), np.zeros(len(places), np.int64))


def undamaged_surface(training_surface: TrainingSurface) -> UndamagedSurface:
    """What a model that is fitted by training pairs alone is given: no patch, and the ground."""
    none = np.zeros((0, RESOLUTION, RESOLUTION))
    is_none = none > 0
    patches = Patches(np.zeros((0, 3)), np.zeros((0, 3, 3)), 1.0, none, is_none, is_none, none.astype(np.int64))
    return UndamagedSurface(patches, none, lambda: training_surface)
