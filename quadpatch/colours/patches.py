"""Patches with colours: the colours that a surface has over the bins of height-map patches."""

from dataclasses import dataclass
from functools import reduce

import numpy as np

from quadpatch.colours.cells import frames_along
from quadpatch.colours.surface import ColouredSurface
from quadpatch.mesh.normals import area_vectors, length
from quadpatch.mesh.raycast import RayScene
from quadpatch.patches.height_map import sample_height_maps
from quadpatch.patches.layout import joined_patches, pick_patches
from quadpatch.patches.seeds import Seeds
from quadpatch.types import BoolArray, FloatArray, IntArray, Patches

# Bins along one side. Patches are compared bin by bin, and vertices take their colours from vertices, not from bins: so
# bins may be about as wide as edges.
RESOLUTION = 24
# A window of a source may lie off its centre by so many bins.
SHIFTS = (-2, 0, 2)
# Sources with less measured colour than this show too little.
_LEAST_MEASURED = 0.9
# Places that are looked at for each source.
_TRIES = 3
# Vertices whose normals are averaged for the frame of a source.
_SURROUNDINGS = 200


@dataclass(frozen=True)
class ColouredPatches:
    """Patches, and the colours over their bins.

    Attributes
    ----------
    patches : Patches
        `known` are the bins whose colour was measured.
    colours : (n_patches, N, N, c) float64
        0 where nothing was seen.
    """

    patches: Patches
    colours: FloatArray

    def __len__(self) -> int:
        """Count of patches."""
        return len(self.patches)

    def pick(self, which: BoolArray) -> "ColouredPatches":
        """Pick some of the patches (n_patches,)."""
        return ColouredPatches(pick_patches(self.patches, which), self.colours[which])


class PatchSampler:
    """Cuts patches of one length out of a surface.

    Parameters
    ----------
    surface : ColouredSurface
    length : float
        Of the patches of gaps, in mesh units.
    """

    def __init__(self, surface: ColouredSurface, length: float) -> None:
        self.surface, self.length = surface, length
        self._scene = RayScene(surface.mesh)
        self._triangle_colours = surface.colours[surface.mesh.triangles].mean(axis=1)

    def cut(self, seeds: Seeds, beyond: int = 0) -> ColouredPatches:
        """Cut patches at some seeds, with so many bins more on each side."""
        resolution = RESOLUTION + 2 * beyond
        length = self.length * resolution / RESOLUTION
        not_measured = ~self.surface.is_measured
        patches = sample_height_maps(self._scene, self.surface.mesh, not_measured, seeds, length, resolution)
        colours = np.where(patches.seen[..., np.newaxis], self._triangle_colours[patches.triangle], 0.0)
        return ColouredPatches(patches, colours)

    def sources(self, most: int, rng: np.random.Generator) -> ColouredPatches:
        """Cut patches that may serve as examples: anywhere on measured colours, turned at random."""
        triangles = self.surface.mesh.triangles[self.surface.is_measured]
        areas = length(area_vectors(self.surface.mesh.vertices, triangles))
        places = triangles[rng.choice(len(triangles), _TRIES * most, p=areas / areas.sum()), 0]
        found: list[ColouredPatches] = []
        for start in range(0, len(places), most):
            found.append(self._measured_at(places[start : start + most], rng))
            if sum(map(len, found)) >= most:
                break
        return _joined(found).pick(np.arange(sum(map(len, found))) < most)

    def _measured_at(self, vertices: IntArray, rng: np.random.Generator) -> ColouredPatches:
        """Cut patches at some vertices (k,), and keep those that show enough measured colour."""
        frames = frames_along(self._mean_normals(vertices), rng.uniform(0.0, 2 * np.pi, len(vertices)))
        patches = self.cut(Seeds(self.surface.mesh.vertices[vertices], frames, vertices), max(SHIFTS))
        return patches.pick(patches.patches.known.mean(axis=(1, 2)) >= _LEAST_MEASURED)

    def _mean_normals(self, vertices: IntArray) -> FloatArray:
        """Mean normals (k, 3) over the surroundings of some vertices (k,), about as wide as a patch."""
        surface = self.surface
        count = min(_SURROUNDINGS, len(surface.measured_vertices))
        _, near = surface.measured_tree.query(surface.mesh.vertices[vertices], count)
        return np.asarray(surface.normals[surface.measured_vertices[near.reshape(len(vertices), -1)]].sum(axis=1))


def _joined(parts: list[ColouredPatches]) -> ColouredPatches:
    patches = reduce(joined_patches, [part.patches for part in parts])
    return ColouredPatches(patches, np.concatenate([part.colours for part in parts]))
