"""Calibration holes in colours: disks of measured vertices whose colours are hidden. The shape stays."""

import numpy as np

from quadpatch.calibration.calibration_set import MARGIN_EDGES, MAX_HOLES
from quadpatch.calibration.synthetic_holes import Spacing, UncutSurface, cut_holes
from quadpatch.mesh.topology import components, directed_edges
from quadpatch.types import BoolArray, IntArray, TriangleMesh

# Disks are at most so wide, in mean edges; diameters that are tried, in diameters of the real holes.
_WIDEST = 32.0
_SIZES = (1.0, 0.7, 0.5, 0.35)
_ENOUGH = 16
# A disk through a thin or crumpled part comes in pieces: smaller ones than this share of the largest are no holes.
_LEAST_PIECE = 0.25


def hide_disks(
    mesh: TriangleMesh, gap: IntArray, n_gaps: int, edge_length: float, rng: np.random.Generator
) -> IntArray:
    """Hide measured colours in disks as wide as the gaps are, clear of them and of each other.

    Parameters
    ----------
    mesh : TriangleMesh
    gap : (n_vertices,) int64
        Gap that each vertex lies in, -1 where the colour was measured.
    n_gaps : int
    edge_length : float
        Mean of the mesh, in mesh units.
    rng : numpy.random.Generator
        Picks the places.

    Returns
    -------
    (n_vertices,) int64
        The same, with disks as gaps from number `n_gaps` on.
    """
    measured = TriangleMesh(mesh.vertices, mesh.triangles[(gap[mesh.triangles] < 0).all(axis=1)])
    surface, spacing = UncutSurface(measured), Spacing(edge_length, MARGIN_EDGES * edge_length, MAX_HOLES)
    diameter = min(_typical_diameter(mesh, gap, n_gaps), _WIDEST * edge_length)
    best = gap
    for size in _SIZES:
        cut = cut_holes(surface, size * diameter, spacing, rng)
        numbered = _numbered(measured, cut.removed, gap, n_gaps)
        if numbered.max() > best.max():
            best = numbered
        if best.max() + 1 - n_gaps >= _ENOUGH:
            break
    return best


def _numbered(measured: TriangleMesh, removed: BoolArray, gap: IntArray, first: int) -> IntArray:
    """Give each connected group of removed vertices a number of its own, from `first` on."""
    chosen = np.flatnonzero(removed)
    links = directed_edges(measured.triangles[removed[measured.triangles].any(axis=1)])
    links = links[removed[links].all(axis=1)]
    piece = components(np.searchsorted(chosen, links), len(chosen))
    counts = np.bincount(piece, minlength=1)
    is_hole = counts >= _LEAST_PIECE * counts.max()
    number = np.where(is_hole, first + np.cumsum(is_hole) - 1, -1)
    numbered = gap.copy()
    numbered[chosen] = number[piece]
    return numbered


def _typical_diameter(mesh: TriangleMesh, gap: IntArray, n_gaps: int) -> float:
    """Median diameter of the rims around the gaps, in mesh units."""
    new = mesh.triangles[(gap[mesh.triangles] >= 0).any(axis=1)]
    hole = gap[new].max(axis=1)
    corners, of_corner = mesh.vertices[new.ravel()], np.repeat(hole, 3)
    low, high = np.full((n_gaps, 3), np.inf), np.full((n_gaps, 3), -np.inf)
    np.minimum.at(low, of_corner, corners)
    np.maximum.at(high, of_corner, corners)
    # The box around a round rim has two sides as long as the rim is wide.
    return float(np.median(np.linalg.norm((high - low)[np.unique(hole)], axis=1)) / np.sqrt(2))
