"""Exemplars: the measured patches that are most like the surroundings of a cell, and the colours that they lend it.

References
----------
A. Criminisi, P. Pérez, K. Toyama, "Region filling and object removal by exemplar-based image inpainting", IEEE
Transactions on Image Processing 13, 2004.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from quadpatch.colours.patches import RESOLUTION, SHIFTS, ColouredPatches
from quadpatch.colours.surface import ColouredSurface
from quadpatch.sparse.parallel import single_threaded_blas
from quadpatch.types import FloatArray, IntArray, Vertices

# What harmonic colours weigh beside measured ones where patches are compared.
_INVENTED_WEIGHT = 0.1
_N_SYMMETRIES = 8


@dataclass(frozen=True)
class Matches:
    """Windows of sources that are like the patches of cells, the best first: (n_cells, k) each.

    Attributes
    ----------
    source : int64
        Number of the source.
    window : int64
        Which of its windows, see `_windows`.
    """

    source: IntArray
    window: IntArray

    @property
    def count(self) -> int:
        """Windows for each cell."""
        return int(self.source.shape[1])


def find_matches(cells: ColouredPatches, sources: ColouredPatches, most: int) -> Matches:
    """Find the sources that are most like the patches of cells, each in that one of its windows that fits best.

    Compared are squared differences over the bins, those of measured colours tenfold.
    """
    patches = cells.patches
    weight = np.where(patches.known, 1.0, np.where(patches.seen, _INVENTED_WEIGHT, 0.0))
    weights = np.repeat(weight[..., np.newaxis], cells.colours.shape[-1], axis=-1).reshape(len(cells), -1)
    wanted = (weights * cells.colours.reshape(len(cells), -1)).astype(np.float32)
    weights = weights.astype(np.float32)
    least = np.full((len(cells), len(sources)), np.inf, np.float32)
    window = np.zeros(least.shape, np.int64)
    with single_threaded_blas():
        for number, images in enumerate(_windows(sources.colours.astype(np.float32))):
            flat = np.ascontiguousarray(images.reshape(len(sources), -1).T)
            # The squares of the cells' own colours are the same for all windows.
            difference = weights @ flat**2 - 2 * (wanted @ flat)
            window[difference < least] = number
            np.minimum(least, difference, out=least)
    best = np.argsort(least, axis=1, kind="stable")[:, :most]
    return Matches(best, np.take_along_axis(window, best, axis=1))


def cost_of_match(n_channels: int) -> float:
    """Count the multiplications that it takes to compare one cell with one source."""
    return 2.0 * _N_SYMMETRIES * len(SHIFTS) ** 2 * RESOLUTION**2 * n_channels


def _windows(images: NDArray[np.float32]) -> Iterator[NDArray[np.float32]]:
    """All windows (n, N, N, c) of some images, in the order of their numbers: symmetries, and shifts of each."""
    margin = (images.shape[1] - RESOLUTION) // 2
    for symmetry in range(_N_SYMMETRIES):
        turned = np.rot90(images.swapaxes(1, 2) if symmetry >= 4 else images, symmetry % 4, axes=(1, 2))
        for down, right in product(SHIFTS, SHIFTS):
            rows = slice(margin + down, margin + down + RESOLUTION)
            columns = slice(margin + right, margin + right + RESOLUTION)
            yield turned[:, rows, columns]


def _placements() -> tuple[FloatArray, FloatArray]:
    """Say where windows lie in their source: matrices (n_windows, 2, 2) and offsets (n_windows, 2), in bins.

    A place (x, y) from the middle of a window, rows along y, is ``matrix @ (x, y) + offset`` from that of its source.
    """
    size = RESOLUTION + 2 * max(SHIFTS)
    middle = (size - 1) / 2
    y, x = np.mgrid[:size, :size].astype(np.float32) - np.float32(middle)
    places = np.concatenate([w[0] for w in [*_windows(np.stack([x, y], axis=-1)[np.newaxis])]])
    places = places.reshape(-1, RESOLUTION, RESOLUTION, 2).astype(np.float64)
    along_x, along_y = places[:, 0, 1] - places[:, 0, 0], places[:, 1, 0] - places[:, 0, 0]
    return np.stack([along_x, along_y], axis=-1), places.mean(axis=(1, 2))


class Lender:
    """Finds the vertices whose colours exemplars lend.

    Parameters
    ----------
    surface : ColouredSurface
    cells, sources : ColouredPatches
    """

    def __init__(self, surface: ColouredSurface, cells: ColouredPatches, sources: ColouredPatches) -> None:
        self.surface, self.cells, self.sources = surface, cells, sources
        self._matrices, self._offsets = _placements()

    def lend(self, source: IntArray, window: IntArray, cell: IntArray, vertex: IntArray) -> IntArray:
        """Vertices (n,) whose colours are lent to pairs of a cell and a vertex in or beside it, by each cell's window.

        It is the measured vertex that lies nearest to the place in the source: a mean of several would be a blur.

        Parameters
        ----------
        source, window : (n_cells,) int64
        cell, vertex : (n,) int64
        """
        mine = self.cells.patches
        local = np.einsum("nij,nj->ni", mine.frames[cell], self.surface.mesh.vertices[vertex] - mine.origins[cell])
        bin_width = mine.length / RESOLUTION
        which = window[cell]
        place = np.einsum("nij,nj->ni", self._matrices[which], local[:, :2] / bin_width) + self._offsets[which]
        points = self._on_source(source[cell], place, bin_width)
        _, nearest = self.surface.measured_tree.query(points)
        return np.asarray(self.surface.measured_vertices[nearest])

    def _on_source(self, source: IntArray, place: FloatArray, bin_width: float) -> Vertices:
        """Points (n, 3) of sources at places (n, 2), in bins from their middles."""
        theirs = self.sources.patches
        size = theirs.resolution
        column, row = np.rint(place + (size - 1) / 2).astype(np.int64).clip(0, size - 1).T
        height = theirs.heights[source, row, column]
        local = np.column_stack([bin_width * place, height])
        return np.asarray(theirs.origins[source] + np.einsum("nj,njk->nk", local, theirs.frames[source]))
