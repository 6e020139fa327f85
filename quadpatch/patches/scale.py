"""How large patches are: the automatic rule, and what the user or the model overrides."""

from dataclasses import dataclass, replace

import numpy as np

from quadpatch.options import PatchOptions
from quadpatch_rules.option_words import Preset

# A patch must see about as much known surface around a hole as the hole is wide, also when its seed lies off centre.
HOLES_PER_LENGTH = 1.8

# Bins a little finer than the mesh lose no detail and invent none.
EDGES_PER_BIN = 0.65

RESOLUTION_RANGE = (16, 32)

# k of the paper: with 4 k = 8 offset patches besides the centre, a vertex is seen by about nine patches.
OVERLAP = 2

# A copy of the surface pays off where its edges are so many times as long.
_LEAST_COARSENING = 1.5

# The base surface carries what is too wide for a patch to show: each of its points is a mean over about this share of
# the patch length (one standard deviation).
BASE_SURFACE_SHARE = 0.37
BASE_SURFACE_ITERATIONS_RANGE = (30, 300)


@dataclass(frozen=True)
class PatchScale:
    """Side of a patch in mesh units, bins along it, and the count k of offsets along each direction."""

    length: float
    resolution: int
    overlap: int


def choose_scale(
    hole_diameters: list[float], edge_length: float, options: PatchOptions, model_resolution: int | None = None
) -> PatchScale:
    """Choose the patch length from the holes, and the resolution from the mesh's edges.

    Parameters
    ----------
    hole_diameters : list of float
        Of the holes that will be filled, in mesh units.
    edge_length : float
        Mean edge length of the mesh, in mesh units.
    options : PatchOptions
        What is set there is taken as it is.
    model_resolution : int, optional
        A learned model fits patches of this resolution only.
    """
    typical = float(np.percentile(hole_diameters, 75)) if hole_diameters else 0.0
    low, high = RESOLUTION_RANGE
    least = EDGES_PER_BIN * edge_length * (model_resolution or low)
    length = options.length or max(HOLES_PER_LENGTH * typical, least)
    wanted = round(length / (EDGES_PER_BIN * edge_length))
    resolution = model_resolution or options.resolution or min(max(wanted, low), high)
    overlap = OVERLAP if options.overlap is None else options.overlap
    return PatchScale(float(length), int(resolution), overlap)


def coarse_edge_length(scale: PatchScale, edge_length: float) -> float | None:
    """Say how long edges may be so that patches show as much: mesh units; None where the mesh's own are about so."""
    wanted = scale.length / scale.resolution / EDGES_PER_BIN
    return wanted if wanted >= _LEAST_COARSENING * edge_length else None


# The paper's two kinds of patches: their side as a share of the object's longest side, and their bins.
PRESETS: dict[Preset, tuple[float, int]] = {"type1": (0.03, 16), "type2": (0.06, 24)}


def preset_scale(options: PatchOptions, longest_side: float) -> PatchOptions:
    """Write out what a preset stands for on an object of a longest side (mesh units); without one, change nothing."""
    if options.preset is None:
        return options
    share, resolution = PRESETS[options.preset]
    return replace(options, length=share * longest_side, resolution=resolution, preset=None)


def asked_resolution(options: PatchOptions) -> int | None:
    """Return the bins along a patch that options ask for; None where they ask for none."""
    return options.resolution if options.preset is None else PRESETS[options.preset][1]


def base_surface_iterations(length: float, edge_length: float) -> int:
    """Count the iterations under patches of a length; one of them moves a point by an edge over sqrt(2)."""
    wanted = round(2 * (BASE_SURFACE_SHARE * length / edge_length) ** 2)
    low, high = BASE_SURFACE_ITERATIONS_RANGE
    return min(max(wanted, low), high)
