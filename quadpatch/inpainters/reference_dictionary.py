"""A dictionary that is learned from another mesh: one of the same kind that is whole, or less worn."""

from dataclasses import dataclass

import numpy as np

from quadpatch.errors import NoQuadsError
from quadpatch.inpainters.dictionary import DictionaryInpainter, learned_from
from quadpatch.inpainters.inpainter import UndamagedSurface
from quadpatch.mesh.measures import mean_edge_length
from quadpatch.mesh.smoothing import laplacian_smooth
from quadpatch.patches.folding import is_unfolded
from quadpatch.patches.layout import lay_out, pick, sample_over_base, take
from quadpatch.patches.scale import PatchScale, base_surface_iterations
from quadpatch.types import TriangleMesh

_OVERLAP = 1
_MAX_SEEDS = 2000


@dataclass(frozen=True)
class ReferenceDictionary:
    """A dictionary of the known bins of another mesh's patches.

    Attributes
    ----------
    mesh : TriangleMesh
        In the same unit as the mesh that is repaired.
    seed : int
        Draws the patches, where there are more than 2,000.
    """

    mesh: TriangleMesh
    seed: int = 0

    @property
    def resolution(self) -> None:
        """See `Inpainter`."""

    def fitted_to(self, undamaged: UndamagedSurface) -> DictionaryInpainter | None:
        """See `Inpainter`: patches of the other mesh, as wide as those of the mesh at hand."""
        patches = undamaged.patches
        scale = PatchScale(patches.length, patches.resolution, _OVERLAP)
        base_surface = laplacian_smooth(self.mesh, base_surface_iterations(scale.length, mean_edge_length(self.mesh)))
        try:
            seeds = lay_out(base_surface, scale)
        except NoQuadsError:
            return None
        chosen = np.zeros(len(seeds), bool)
        chosen[np.random.default_rng([self.seed, 5]).permutation(len(seeds))[:_MAX_SEEDS]] = True
        nothing = np.zeros(len(self.mesh.triangles), bool)
        sampled = sample_over_base(self.mesh, nothing, base_surface, take(seeds, chosen), scale)
        usable = pick(sampled, is_unfolded(sampled.patches))
        return learned_from(usable.patches, usable.base_heights)
