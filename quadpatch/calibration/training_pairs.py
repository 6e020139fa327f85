"""Training pairs for networks: fills of holes that were cut into undamaged surface, beside the surface that was there.

The holes are cut into the mesh and filled by the same code as the real ones, since a network can only learn to correct
the errors that it is shown.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from quadpatch.calibration.energy_selection import EnergyBlend
from quadpatch.calibration.synthetic_holes import MeshWithHoles, Spacing, UncutSurface, cut_holes
from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.normals import triangle_normals
from quadpatch.mesh.raycast import RayScene
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.height_map import REACH, bin_centres, sample_height_maps
from quadpatch.patches.layout import Sampled, joined_patches, pick, pick_patches, seeds_near, take
from quadpatch.patches.ray_visibility import nearest_facing
from quadpatch.patches.residual_input import network_input, standardise
from quadpatch.patches.scale import PatchScale, base_surface_iterations
from quadpatch.patches.seeds import Seeds
from quadpatch.types import BoolArray, FloatArray, IntArray, Patches, TriangleMesh

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
    surface, truth = UncutSurface(training_surface.mesh), _Truth(training_surface)
    while True:
        width = float(rng.choice(training_surface.diameters)) * rng.uniform(*WIDTHS)
        yield _round(training_surface, surface, truth, width, rng)


def pairs_of(sampled: Sampled, truth: TriangleMesh) -> TrainingPairs:
    """Make pairs of patches that show fills, and of the surface that was there."""
    patches, measured = sampled.patches, np.zeros(len(truth.triangles), bool)
    there = sample_height_maps(RayScene(truth), truth, measured, _places(patches), patches.length, patches.resolution)
    return _compared(sampled, there, patches.seen & ~patches.known)


def _compared(sampled: Sampled, truth: Patches, invented: BoolArray) -> TrainingPairs:
    patches, loss_mask = sampled.patches, truth.seen & invented
    seen = network_input(patches, sampled.base_heights)
    correction = standardise(np.where(loss_mask, truth.heights - patches.heights, 0.0), seen.deviation)
    return TrainingPairs(seen.channels, correction.astype(np.float32), loss_mask.astype(np.float32))


class _Truth:
    """The undamaged surface in patches: every seed is sampled once for all rounds.

    Parameters
    ----------
    training_surface : TrainingSurface
    """

    def __init__(self, training_surface: TrainingSurface) -> None:
        self._surface, self._scene = training_surface, RayScene(training_surface.mesh)
        self._row = np.full(len(training_surface.seeds), -1)
        self._patches = self._sampled(np.zeros(0, np.int64))

    def at(self, near: BoolArray) -> Patches:
        """Give the patches of some seeds (n_seeds,)."""
        missing = np.flatnonzero(near & (self._row < 0))
        self._row[missing] = len(self._patches) + np.arange(len(missing))
        self._patches = joined_patches(self._patches, self._sampled(missing))
        return pick_patches(self._patches, self._row[near])

    def _sampled(self, which: IntArray) -> Patches:
        mesh, seeds, scale = self._surface.mesh, self._surface.seeds, self._surface.scale
        measured = np.zeros(len(mesh.triangles), bool)
        return sample_height_maps(self._scene, mesh, measured, take(seeds, which), scale.length, scale.resolution)


def _round(
    training_surface: TrainingSurface, surface: UncutSurface, truth: _Truth, diameter: float, rng: np.random.Generator
) -> TrainingPairs:
    scale, edge_length = training_surface.scale, training_surface.edge_length
    cut = cut_holes(surface, diameter, Spacing(edge_length, _MARGIN_EDGES * edge_length), rng)
    filled = training_surface.blend.fill(cut.mesh, cut.loops)
    new_vertices = filled.mesh.vertices[filled.n_measured_vertices :]
    there = truth.at(seeds_near(training_surface.seeds, new_vertices, scale.length))
    patches = _with_fills(there, filled, cut)
    sampled = _over_base(patches, laplacian_smooth(filled.mesh, base_surface_iterations(scale.length, edge_length)))
    unfolded = is_unfolded(sampled.patches)
    # Where no base surface is seen nothing is known either, and nothing invented.
    invented = patches.seen & ~patches.known
    return _compared(pick(sampled, unfolded), pick_patches(there, unfolded), invented[unfolded])


def _with_fills(there: Patches, filled: FilledMesh, cut: MeshWithHoles) -> Patches:
    """Show the fills in patches of the undamaged surface: only bins whose triangle was cut away are cast again."""
    is_cut = (there.triangle >= 0) & cut.cut_away[there.triangle]
    at_rim = np.zeros(len(filled.mesh.vertices), bool)
    at_rim[np.concatenate([np.zeros(0, np.int64), *cut.loops])] = True
    shown = filled.invented_triangles | at_rim[filled.mesh.triangles].any(axis=1)
    fills = TriangleMesh(filled.mesh.vertices, filled.mesh.triangles[shown])
    patch, *_ = np.nonzero(is_cut)
    points = bin_centres(there.origins, there.frames, there.length, there.resolution)[is_cut]
    normals, z = triangle_normals(fills.vertices, fills.triangles), there.frames[patch, 2]
    triangle, height = nearest_facing(RayScene(fills), normals, points, z, REACH * there.length)
    is_seen = triangle >= 0
    is_known = is_seen.copy()
    is_known[is_seen] = ~filled.invented_triangles[shown][triangle[is_seen]]
    heights, known, seen = there.heights.copy(), there.known.copy(), there.seen.copy()
    heights[is_cut], known[is_cut], seen[is_cut] = height, is_known, is_seen
    return replace(there, heights=heights, known=known, seen=seen)


def _over_base(patches: Patches, base_surface: TriangleMesh) -> Sampled:
    """Sample the base surface under patches: in every other bin, for it is smooth, and linearly in between."""
    measured = np.zeros(len(base_surface.triangles), bool)
    coarse = sample_height_maps(
        RayScene(base_surface), base_surface, measured, _places(patches), patches.length, patches.resolution // 2
    )
    is_seen = _twice_as_fine(coarse.seen.astype(np.float64)) == 1.0
    base_heights = np.where(is_seen, _twice_as_fine(coarse.heights), patches.heights)
    return Sampled(replace(patches, known=patches.known & is_seen), base_heights)


def _places(patches: Patches) -> Seeds:
    return Seeds(patches.origins, patches.frames, np.zeros(len(patches), np.int64))


def _twice_as_fine(values: FloatArray) -> FloatArray:
    """Interpolate values at the centres of bins (n, N, N) at those of bins half as wide (n, 2 N, 2 N)."""
    for axis in (1, 2):
        rows = np.moveaxis(values, axis, 0)
        around = np.concatenate([2 * rows[:1] - rows[1:2], rows, 2 * rows[-1:] - rows[-2:-1]])
        fine = np.stack([0.25 * around[:-2] + 0.75 * rows, 0.75 * rows + 0.25 * around[2:]], axis=1)
        values = np.moveaxis(fine.reshape(2 * len(rows), *rows.shape[1:]), 0, axis)
    return values
