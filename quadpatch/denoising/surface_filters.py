"""Filters of a whole mesh: diffusion at several scales, and bilateral filtering of its normals.

Diffusion is the better filter on organic surfaces and fine relief, filtered normals on parts with flat or evenly bent
faces and creases. `quadpatch.denoising.risk` weighs them for the mesh at hand.

References
----------
J. Tukey, "Exploratory Data Analysis", 1977: twicing, 2 S - S S in place of a smoother S, which shrinks less.
Y. Zheng, H. Fu, O. K.-C. Au, C.-L. Tai, "Bilateral normal filtering for mesh denoising", IEEE Transactions on
Visualization and Computer Graphics 17, 2011.
X. Sun, P. Rosin, R. Martin, F. Langbein, "Fast and effective feature-preserving mesh denoising", IEEE Transactions on
Visualization and Computer Graphics 13, 2007: the update of the vertices.
"""

from itertools import pairwise

import numpy as np
from scipy.sparse import csr_array

from quadpatch.mesh.edge_groups import group_edges
from quadpatch.mesh.normals import area_vectors, length, unit, vertex_normals
from quadpatch.mesh.smoothing import neighbour_average
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Triangles, Vertices

# Half-steps to the mean of the neighbours, each scale twice the one before, as twicing needs it.
_HALF_STEPS = (1, 2, 4, 8, 16, 32)

# Rounds of normal filtering as (width of the normal weight, iterations). Between rounds vertices are fitted and all
# weights are taken from the new mesh: those of the noisy one tie triangles together that face apart. The first
# sequence takes off little, for fine detail.
_LIGHT = ((0.35, 5),)
_ROUNDS = ((0.45, 6), (0.35, 6), (0.3, 6), (0.25, 10))
_FIT_ITERATIONS = 10
_LAST_FIT_ITERATIONS = 30
# Triangles around a vertex with more than this many are neighbours over their edges only: their pairs would not fit in
# memory.
_CROWDED = 40
_NORMAL_STEPS = 4


# What a report calls the filters, in the order of `SurfaceFilters.apply`.
FILTER_NAMES = (*(f"diffusion_{steps}" for steps in _HALF_STEPS[:-1]), "normals_light", "normals")


class SurfaceFilters:
    """All filters for meshes with the same triangles.

    Parameters
    ----------
    mesh : TriangleMesh
        Any triangle soup.
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        self._triangles = mesh.triangles
        self._average = neighbour_average(mesh.triangles, len(mesh.vertices))
        groups = group_edges(mesh.triangles, len(mesh.vertices))
        self._rim = np.unique(groups.ends()[groups.count == 1])
        self._near = _neighbours(mesh.triangles, len(mesh.vertices), groups.pairs // 3)
        corners = mesh.triangles.ravel()
        owner = np.repeat(np.arange(len(mesh.triangles)), 3)
        self._spread = csr_array((np.ones(len(corners)), (corners, owner)), (len(mesh.vertices), len(mesh.triangles)))
        self._count = np.maximum(np.bincount(corners, minlength=len(mesh.vertices)), 1)[:, None]

    @property
    def n_pairs(self) -> int:
        """Count of pairs of neighbouring triangles: what the memory goes by."""
        return int(self._near.nnz)

    def apply(self, vertices: Vertices) -> list[Vertices]:
        """Give the vertices (n, 3) as each filter moves them."""
        by_normals = [self.with_filtered_normals(vertices, rounds) for rounds in (_LIGHT, _ROUNDS)]
        return [*self.diffused(vertices), *by_normals]

    def normals(self, vertices: Vertices) -> FloatArray:
        """Give the normals (n, 3) of a smoothed copy; those of a noisy mesh point anywhere."""
        smooth = vertices
        for _ in range(_NORMAL_STEPS):
            smooth = 0.5 * (smooth + self._average @ smooth)
        return vertex_normals(smooth, self._triangles)

    def diffused(self, vertices: Vertices) -> list[Vertices]:
        """Smooth at several scales, each twice over; at the rims along the normals alone."""
        normals, scales, smooth = self.normals(vertices), [], vertices
        for step in range(1, _HALF_STEPS[-1] + 1):
            smooth = 0.5 * (smooth + self._average @ smooth)
            if step in _HALF_STEPS:
                scales.append(smooth)
        twiced = [2 * once - twice for once, twice in pairwise(scales)]
        # Along the surface they would round the corners of a rim.
        rim, normals = self._rim, normals[self._rim]
        for moved in twiced:
            along = np.einsum("ij,ij->i", moved[rim] - vertices[rim], normals)
            moved[rim] = vertices[rim] + along[:, None] * normals
        return twiced

    def with_filtered_normals(self, vertices: Vertices, rounds: tuple[tuple[float, int], ...]) -> Vertices:
        """Filter normals in rounds, and fit the vertices to them."""
        fitted = vertices
        for number, (width, iterations) in enumerate(rounds, start=1):
            normals = self._filtered(fitted, width, iterations)
            many = len(rounds) > 1 and number == len(rounds)
            # Always from the noisy vertices, or every round would shift the surface.
            fitted = self._fitted(vertices, normals, _LAST_FIT_ITERATIONS if many else _FIT_ITERATIONS)
        return fitted

    def _filtered(self, vertices: Vertices, width: float, iterations: int) -> FloatArray:
        """Filter the normals of a mesh bilaterally: means over triangles that are near and face alike."""
        near, n = self._near, len(self._triangles)
        i, j = np.repeat(np.arange(n), np.diff(near.indptr)), near.indices
        vectors = area_vectors(vertices, self._triangles)
        centres = vertices[self._triangles].mean(axis=1)
        distance = length(centres[i] - centres[j])
        spacing = float(distance[i != j].mean()) if (i != j).any() else 1.0
        by_distance = length(vectors)[j] * _gauss(distance, spacing or 1.0)
        normals = unit(vectors)
        for _ in range(iterations):
            weights = by_distance * _gauss(length(normals[i] - normals[j]), width)
            normals = unit(np.asarray(csr_array((weights, near.indices, near.indptr), (n, n)) @ normals))
        return normals

    def _fitted(self, vertices: Vertices, normals: FloatArray, iterations: int) -> Vertices:
        """Move each vertex towards the planes through its triangles' centroids along their normals."""
        outer = np.asarray(self._spread @ (normals[:, :, None] * normals[:, None]).reshape(-1, 9)).reshape(-1, 3, 3)
        for _ in range(iterations):
            at_centre = np.einsum("ij,ij->i", normals, vertices[self._triangles].mean(axis=1))
            pull = self._spread @ (normals * at_centre[:, None])
            vertices = vertices + (pull - np.einsum("nij,nj->ni", outer, vertices)) / self._count
        return vertices


def _neighbours(triangles: Triangles, n_vertices: int, links: IntArray) -> csr_array[np.float64]:
    """Pattern (n, n) of triangles that share a vertex, or an edge as `links` (k, 2) say; each with itself too."""
    n = len(triangles)
    corners, owner = triangles.ravel(), np.repeat(np.arange(n), 3)
    plain = np.bincount(corners, minlength=n_vertices)[corners] <= _CROWDED
    touches = csr_array((np.ones(int(plain.sum())), (owner[plain], corners[plain])), (n, n_vertices))
    own = np.arange(n)
    rows = np.concatenate([links[:, 0], links[:, 1], own])
    columns = np.concatenate([links[:, 1], links[:, 0], own])
    shared = csr_array(touches @ touches.T + csr_array((np.ones(len(rows)), (rows, columns)), (n, n)))
    shared.sort_indices()
    return shared


def _gauss(distance: FloatArray, width: float) -> FloatArray:
    return np.asarray(np.exp(-(distance**2) / (2 * width**2)))
