"""Tell patches whose surface is a height map from those where it folds.

On thin or folded parts a ray along z meets a wall, an underside or nothing. Whatever is coded there is no surface,
however well it is completed, so later stages leave such patches out.
"""

import numpy as np

from quadpatch.types import BoolArray, Patches

# Between neighbouring bins a surface may climb this many bins; more is a step to another layer.
STEEPEST = 3.0
# A patch with a larger share of its seen bins at steps is no height map.
MOST_FOLDED = 0.2
# A patch that shows less than this share of its square has nothing to go by.
LEAST_SEEN = 0.4


def is_unfolded(patches: Patches) -> BoolArray:
    """Say which patches (n_patches,) show one connected surface, as far as they show any.

    What lies beyond the border of an open scan counts as unknown, not as folded.
    """
    n_seen = patches.seen.sum(axis=(1, 2))
    n_steps = (_at_step(patches) & patches.seen).sum(axis=(1, 2))
    unfolded: BoolArray = (n_steps <= MOST_FOLDED * n_seen) & (n_seen >= LEAST_SEEN * patches.resolution**2)
    return unfolded


def _at_step(patches: Patches) -> BoolArray:
    """Bins with a neighbour in the same row or column whose surface lies on another layer."""
    step = STEEPEST * patches.length / patches.resolution
    at_step = np.zeros(patches.seen.shape, dtype=bool)
    for axis in (1, 2):
        heights, seen, flags = (np.moveaxis(part, axis, 1) for part in (patches.heights, patches.seen, at_step))
        is_step = (np.abs(np.diff(heights, axis=1)) > step) & seen[:, 1:] & seen[:, :-1]
        flags[:, 1:] |= is_step
        flags[:, :-1] |= is_step
    return at_step
