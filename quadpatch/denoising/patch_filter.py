r"""Denoising by patches: each is coded over atoms that are learned from clean ones like it (section 5 of the paper).

A first, smoothed surface (the pilot) carries the patches. The atoms of a patch are the deviations of its nearest clean
patches from their mean; where they come from says the model: another scan, the pilot itself, or a dictionary. What is
coded are the vertices of the noisy mesh at their places in the patch, not bins: their noise is independent. With m the
mean at these places, B the atoms and w the inverse variances, the most likely code of heights y under noise solves

.. math:: (B W B^T + I)\, c = B W (y - m),

and the vertex comes to lie at m + B^T c, averaged over the patches that show it. The paper codes heights sparsely over
one dictionary for all patches; a Gaussian code over a dictionary of its own for each patch hedges where a sparse one
has to decide (see `quadpatch.sparse.gaussian`).

References
----------
K. Sarkar, K. Varanasi, D. Stricker, "Learning Quadrangulated Patches For 3D Shape Processing", 2019, section 5.
M. Lebrun, A. Buades, J.-M. Morel, "A nonlocal Bayesian image denoising algorithm", SIAM Journal on Imaging Sciences 6,
2013: a Gaussian for each patch from those like it.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quadpatch.denoising.atoms import Atoms
from quadpatch.mesh.normals import vertex_normals
from quadpatch.patches.connectivity import Connectivity, vertices_in_patches
from quadpatch.types import BoolArray, FloatArray, IntArray, Patches, TriangleMesh

# The mean height of a patch is free: its standard deviation, in that of the noise.
_FREE_LEVEL = 10.0
# Fewer vertices say nothing about a patch; more don't fit in memory, and no sound mesh has them.
_VERTICES_RANGE = (4, 2000)
_PATCHES_AT_A_TIME = 256


@dataclass(frozen=True)
class PatchShifts:
    """What the patches say.

    Attributes
    ----------
    shift : (n,) float64
        From the pilot, along its normals, in mesh units; 0 where no patch shows the vertex.
    response : (n,) float64
        How the shifted vertex follows a move of the noisy vertices by the probe.
    is_shown : (n,) bool
    """

    shift: FloatArray
    response: FloatArray
    is_shown: BoolArray


def filter_by_patches(
    noisy: TriangleMesh, pilot: TriangleMesh, patches: Patches, atoms: Atoms, noise: float, probe: FloatArray
) -> PatchShifts:
    """Code the patches of a pilot, and say where its vertices should lie.

    Parameters
    ----------
    noisy, pilot : TriangleMesh
        The same triangles.
    patches : Patches
        Of the pilot.
    atoms : Atoms
        What the patches are coded over.
    noise : float
        Standard deviation along the normals, in mesh units; greater than 0.
    probe : (n,) float64
        See `quadpatch.denoising.risk`.
    """
    normals = vertex_normals(pilot.vertices, pilot.triangles)
    measured = np.einsum("ij,ij->i", noisy.vertices - pilot.vertices, normals)
    shown = vertices_in_patches(pilot.vertices, normals, patches)
    n = len(normals)
    totals, weights = np.zeros((n, 2)), np.zeros(n)
    for patch, pairs, mean, rows in _patches_with_atoms(shown, patches, atoms):
        vertex, frame = shown.vertex[pairs], patches.frames[patch, 2]
        facing = normals[vertex] @ frame
        height = (pilot.vertices[vertex] - patches.origins[patch]) @ frame
        place = _Places.of(shown, pairs, patches.resolution)
        level = place.read(mean[None])[0]
        moves = np.stack([height + measured[vertex] / facing - level, probe[vertex] / facing], axis=1)
        coded = _coded(place.read(rows), moves, facing / noise)
        coded[:, 0] += level - height
        weight = place.window() * facing**2
        totals[vertex] += (weight * facing)[:, None] * coded
        weights[vertex] += weight
    is_shown = weights > 0
    means = np.divide(totals, weights[:, None], out=np.zeros_like(totals), where=is_shown[:, None])
    return PatchShifts(means[:, 0], means[:, 1], is_shown)


def _patches_with_atoms(
    shown: Connectivity, patches: Patches, atoms: Atoms
) -> Iterator[tuple[int, IntArray, FloatArray, FloatArray]]:
    """Go through the patches: pairs of the connectivity, mean (N * N,) and atoms (n_atoms, N * N)."""
    order = np.argsort(shown.patch, kind="stable")
    starts = np.searchsorted(shown.patch[order], np.arange(len(patches) + 1))
    sizes = np.diff(starts)
    usable = np.flatnonzero((sizes >= _VERTICES_RANGE[0]) & (sizes <= _VERTICES_RANGE[1]))
    for first in range(0, len(usable), _PATCHES_AT_A_TIME):
        some = usable[first : first + _PATCHES_AT_A_TIME]
        for patch, (mean, rows) in zip(some.tolist(), atoms.of_patches(some), strict=True):
            yield patch, order[starts[patch] : starts[patch + 1]], mean, rows


def _coded(rows: FloatArray, moves: FloatArray, precision: FloatArray) -> FloatArray:
    """Most likely heights for each column of some moves (n_vertices, k) under noise of 1 / precision (n_vertices,)."""
    free = np.full((1, len(moves)), _FREE_LEVEL / precision.max())
    scaled = np.concatenate([rows, free]) * precision
    system = scaled @ scaled.T
    system[np.diag_indices_from(system)] += 1.0
    codes = np.linalg.solve(system, scaled @ (moves * precision[:, None]))
    return np.asarray((scaled / precision).T @ codes)


@dataclass(frozen=True)
class _Places:
    """Places of vertices in one patch: the bins around each, and their bilinear weights."""

    bins: IntArray
    weights: FloatArray
    from_centre: FloatArray

    @classmethod
    def of(cls, shown: Connectivity, pairs: IntArray, resolution: int) -> "_Places":
        last = resolution - 1
        row, column = (np.clip(place[pairs], 0, last) for place in (shown.row, shown.column))
        top, left = row.astype(np.int64), column.astype(np.int64)
        down, right = row - top, column - left
        bottom, far = np.minimum(top + 1, last), np.minimum(left + 1, last)
        bins = np.stack([top, top, bottom, bottom]) * resolution + np.stack([left, far, left, far])
        weights = np.stack([(1 - down) * (1 - right), (1 - down) * right, down * (1 - right), down * right])
        return cls(bins, weights, np.maximum(np.abs(2 * row - last), np.abs(2 * column - last)) / resolution)

    def read(self, maps: FloatArray) -> FloatArray:
        """Read maps (k, N * N) at the places: (k, n_vertices)."""
        return np.asarray((maps[:, self.bins] * self.weights).sum(axis=1))

    def window(self) -> FloatArray:
        """Weigh places: 1 at the centre of the patch, a tenth at its border."""
        return np.asarray(0.1 + 0.9 * np.cos(np.clip(self.from_centre, 0, 1) * np.pi / 2) ** 2)
