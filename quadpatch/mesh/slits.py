"""Slits: loops whose two sides lie close together along their whole length, such as cracks, seams and T-junctions.

Both sides of a slit look alike from far: what tells it from the border of a strip, or of a sheet that is folded
together, is where the surface lies. Across a slit it continues away from both sides; a strip lies between its sides,
and those of a folded sheet have it on the same side.

Tested in `tests/quadpatch/mesh/test_hole_kinds.py`.
"""

import numpy as np

from quadpatch.mesh.loop_shapes import LoopShapes
from quadpatch.mesh.rims import Rims
from quadpatch.types import BoolArray, FloatArray, IntArray

# A slit is at most this wide, in diameters.
SLIT_WIDTH = 0.05

# So much of the rim has to have the other side so close; the rest may be blunt tips and ragged corners. A ragged crack
# has 0.92, the most ragged border of a range scan 0.42.
SLIT_SHARE = 0.85

# The way along the rim to the other side: in each place this many times as long as the straight one, and in the mean
# this share of the perimeter: a straight slit has 0.25, a ragged one 0.13. The notches of a ragged border have two
# sides as well, but these are near along the rim: 0.03.
SLIT_DETOUR = 3.0
SLIT_WAY = 0.06

# A loop as narrow as that everywhere has at most this isoperimetric quotient: others need no closer look.
_MOST_ROUNDNESS = np.pi * SLIT_WIDTH

# Places along a rim at which the other side is looked for, and pairs of places and edges held at once.
_LEAST_SAMPLES, _MOST_SAMPLES = 16, 128
_MOST_PAIRS = 1_000_000

# The other side may overlap this share of the face that it is seen from: beyond, the surface lies between them.
_MOST_OVERLAP = 0.5


def slits(rims: Rims, shapes: LoopShapes, candidates: BoolArray) -> BoolArray:
    """Find the slits (n_loops,) among some loops.

    Parameters
    ----------
    rims : Rims
    shapes : LoopShapes
    candidates : (n_loops,) bool
    """
    found = np.zeros(rims.n_loops, bool)
    # A Python loop over thin loops only.
    for loop in np.flatnonzero(candidates & (shapes.roundness <= _MOST_ROUNDNESS)).tolist():
        found[loop] = _is_slit(rims, rims.slice_of(loop), float(shapes.diameters[loop]))
    return found


def _is_slit(rims: Rims, part: slice, diameter: float) -> bool:
    perimeter = float(rims.lengths[part].sum())
    if perimeter == 0:
        return False
    gap, way = _to_other_side(rims, part, *_samples(rims, part))
    is_close = gap <= SLIT_WIDTH * diameter
    return bool(is_close.mean() >= SLIT_SHARE and way[is_close].mean() >= SLIT_WAY * perimeter)


def _samples(rims: Rims, part: slice) -> tuple[IntArray, FloatArray]:
    """Pick places at equal steps along a rim: the edge (k,) that each lies on, and how far along it (k,)."""
    lengths = rims.lengths[part]
    count = int(np.clip(_MOST_PAIRS // len(lengths), _LEAST_SAMPLES, _MOST_SAMPLES))
    ends = np.cumsum(lengths)
    at = (np.arange(count) + 0.5) / count * ends[-1]
    edge = np.searchsorted(ends, at).clip(max=len(lengths) - 1)
    return part.start + edge, lengths[edge] - (ends[edge] - at)


def _to_other_side(rims: Rims, part: slice, edge: IntArray, along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Measure from places on a rim to its other side: distance (k,), infinite without one, and way along the rim."""
    lengths, edges = rims.lengths[part], rims.edges[part]
    starts = np.cumsum(lengths) - lengths
    place = rims.points[edge] + (along / np.maximum(rims.lengths[edge], 1e-300))[:, None] * rims.edges[edge]
    to_place = place[:, None] - rims.points[part]
    share = np.clip(np.einsum("ijk,jk->ij", to_place, edges) / np.maximum(lengths**2, 1e-300), 0, 1)
    across = share[..., None] * edges - to_place
    gap = np.linalg.norm(across, axis=2)
    way = np.abs(starts + share * lengths - (starts[edge - part.start] + along)[:, None])
    way = np.minimum(way, lengths.sum() - way)
    # The other side runs the other way, and its surface lies beyond it.
    is_opposite = (rims.edges[edge] @ edges.T < 0) & (rims.inward[edge] @ rims.inward[part].T <= 0)
    depth = np.einsum("ijk,ik->ij", across, rims.inward[edge])
    is_opposite &= (depth <= _MOST_OVERLAP * rims.heights[edge][:, None]) & (way >= SLIT_DETOUR * gap)
    gap = np.where(is_opposite, gap, np.inf)
    nearest = gap.argmin(axis=1)[:, None]
    return np.take_along_axis(gap, nearest, 1)[:, 0], np.take_along_axis(way, nearest, 1)[:, 0]
