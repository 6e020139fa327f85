"""What denoising is measured against: bilateral and guided normal filtering, and Taubin smoothing.

The two normal filters are written from their papers, independently of `quadpatch.denoising`, in the local, iterative
form of the authors' own comparisons: normals of triangles are filtered, then vertices are moved to fit them.

References
----------
Y. Zheng, H. Fu, O. K.-C. Au, C.-L. Tai, "Bilateral normal filtering for mesh denoising", IEEE Transactions on
Visualization and Computer Graphics 17, 2011.
W. Zhang, B. Deng, J. Zhang, S. Bouaziz, L. Liu, "Guided mesh normal filtering", Computer Graphics Forum 34, 2015.
X. Sun, P. Rosin, R. Martin, F. Langbein, "Fast and effective feature-preserving mesh denoising", IEEE Transactions on
Visualization and Computer Graphics 13, 2007.
G. Taubin, "A signal processing approach to fair surface design", SIGGRAPH, 1995.

Tested in `tests/benchmarks/test_denoising_peers.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pymeshlab
from scipy.sparse import coo_array, csr_array
from scipy.spatial import cKDTree

from quadpatch.mesh.normals import area_vectors, length, unit
from quadpatch.types import FloatArray, IntArray, TriangleMesh, Vertices

Method = Callable[[TriangleMesh], Vertices]

# The defaults of the authors of guided normals, who compare with bilateral normals in the same program.
NORMAL_ITERATIONS = 20
VERTEX_ITERATIONS = 10
SIGMA_NORMAL = 0.35
# Reach of the guided filter, in mean distances between the centroids of neighbouring triangles.
GUIDED_RADIUS = 2.0


def bilateral_normals(
    mesh: TriangleMesh, sigma_normal: float = SIGMA_NORMAL, iterations: int = NORMAL_ITERATIONS
) -> Vertices:
    """Denoise by bilateral normal filtering (Zheng et al. 2011); vertices (n, 3)."""
    i, j = _around_vertices(mesh)
    centres, areas = _centres(mesh), length(area_vectors(mesh.vertices, mesh.triangles)) / 2
    sigma_centre = _mean_spacing(mesh, centres)
    near = areas[j] * _gauss(length(centres[i] - centres[j]), sigma_centre)
    normals = unit(area_vectors(mesh.vertices, mesh.triangles))
    for _ in range(iterations):
        normals = _filtered(normals, i, j, near * _gauss(length(normals[i] - normals[j]), sigma_normal))
    return fit_vertices(mesh, normals)


def guided_normals(
    mesh: TriangleMesh, sigma_normal: float = SIGMA_NORMAL, iterations: int = NORMAL_ITERATIONS
) -> Vertices:
    """Denoise by guided normal filtering (Zhang et al. 2015); vertices (n, 3)."""
    centres, areas = _centres(mesh), length(area_vectors(mesh.vertices, mesh.triangles)) / 2
    spacing = _mean_spacing(mesh, centres)
    pairs = cKDTree(centres).query_pairs(GUIDED_RADIUS * spacing, output_type="ndarray").astype(np.int64)
    own = np.arange(len(centres))
    i, j = (np.concatenate([pairs[:, k], pairs[:, 1 - k], own]) for k in (0, 1))
    near = areas[j] * _gauss(length(centres[i] - centres[j]), spacing)
    normals = unit(area_vectors(mesh.vertices, mesh.triangles))
    patches = _lay_patches(mesh)
    for _ in range(iterations):
        guidance = _guidance(normals, areas, patches)
        normals = _filtered(normals, i, j, near * _gauss(length(guidance[i] - guidance[j]), sigma_normal))
    return fit_vertices(mesh, normals)


def taubin(mesh: TriangleMesh, iterations: int = 10) -> Vertices:
    """Denoise by MeshLab's Taubin smoothing with its default weights; vertices (n, 3)."""
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.triangles.astype(np.int32)))
    meshes.apply_coord_taubin_smoothing(stepsmoothnum=iterations)
    return np.asarray(meshes.current_mesh().vertex_matrix(), np.float64)


def fit_vertices(mesh: TriangleMesh, normals: FloatArray, iterations: int = VERTEX_ITERATIONS) -> Vertices:
    """Move vertices so that triangles fit given normals (n_triangles, 3): the update of Sun et al. 2007."""
    vertices, corners = mesh.vertices.copy(), mesh.triangles.ravel()
    count = np.maximum(np.bincount(corners, minlength=len(vertices)), 1)[:, None]
    spread = csr_array(
        (np.ones(len(corners)), (corners, np.repeat(np.arange(len(normals)), 3))), (len(vertices), len(normals))
    )
    for _ in range(iterations):
        at_centre = np.einsum("ij,ij->i", normals, vertices[mesh.triangles].mean(axis=1))
        pull = spread @ (normals * at_centre[:, None])
        outer = np.asarray(spread @ (normals[:, :, None] * normals[:, None]).reshape(-1, 9)).reshape(-1, 3, 3)
        vertices = vertices + (pull - np.einsum("nij,nj->ni", outer, vertices)) / count
    return vertices


@dataclass(frozen=True)
class _TrianglePatches:
    """A patch for each triangle: all that share a vertex with it.

    Attributes
    ----------
    patch, member : (k,) int64
        Pairs of a patch and a triangle in it, sorted by patch.
    edges : (m, 2) int64
        Pairs of triangles that share an edge.
    edge, patch_of_edge : (l,) int64
        An edge lies in a patch where both of its triangles do.
    """

    patch: IntArray
    member: IntArray
    edges: IntArray
    edge: IntArray
    patch_of_edge: IntArray


def _lay_patches(mesh: TriangleMesh) -> _TrianglePatches:
    patch, member = _around_vertices(mesh)
    edges, n = _edge_pairs(mesh), len(mesh.triangles)
    belongs = csr_array((np.ones(len(patch)), (member, patch)), (n, n))
    both = coo_array(belongs[edges[:, 0]].multiply(belongs[edges[:, 1]]))
    return _TrianglePatches(patch, member, edges, both.row.astype(np.int64), both.col.astype(np.int64))


def _guidance(normals: FloatArray, areas: FloatArray, patches: _TrianglePatches) -> FloatArray:
    """Mean normal of the most consistent one of the patches that hold a triangle.

    The inconsistency of a patch is the largest difference of two of its normals, times its relative edge saliency: the
    share of the jumps over its edges that the largest one has.
    """
    n, patch, member = len(normals), patches.patch, patches.member
    mean = unit(np.asarray(csr_array((areas[member], (patch, member)), (n, n)) @ normals))
    widest = _largest_difference(normals, member, np.searchsorted(patch, np.arange(n + 1)))
    jump = length(normals[patches.edges[:, 0]] - normals[patches.edges[:, 1]])[patches.edge]
    total = np.bincount(patches.patch_of_edge, jump, minlength=n)
    largest = np.zeros(n)
    np.maximum.at(largest, patches.patch_of_edge, jump)
    inconsistency = widest * largest / (1e-9 + total)
    # The patches that hold a triangle are those of the members of its own patch; take the best.
    by_rank = np.lexsort((inconsistency[member], patch))
    best = member[by_rank][np.searchsorted(patch[by_rank], np.arange(n))]
    return np.asarray(mean[best])


def _largest_difference(normals: FloatArray, members: IntArray, starts: IntArray) -> FloatArray:
    """Largest difference of two normals within each run (n,) of a list of triangles."""
    largest = np.zeros(len(starts) - 1)
    sizes = np.diff(starts)
    for size in np.unique(sizes).tolist():
        rows = np.flatnonzero(sizes == size)
        found = normals[members[starts[rows][:, None] + np.arange(size)]]
        cosines = np.einsum("nia,nja->nij", found, found)
        largest[rows] = np.sqrt(np.maximum(2 - 2 * cosines.min(axis=(1, 2)), 0))
    return largest


def _filtered(normals: FloatArray, i: IntArray, j: IntArray, weights: FloatArray) -> FloatArray:
    return unit(np.asarray(csr_array((weights, (i, j)), (len(normals), len(normals))) @ normals))


def _around_vertices(mesh: TriangleMesh) -> tuple[IntArray, IntArray]:
    """Pairs of triangles that share a vertex, each with itself too, sorted by the first."""
    n, corners = len(mesh.triangles), mesh.triangles.ravel()
    touches = csr_array((np.ones(len(corners)), (np.repeat(np.arange(n), 3), corners)), (n, len(mesh.vertices)))
    shared = coo_array(touches @ touches.T)
    order = np.lexsort((shared.col, shared.row))
    return shared.row[order].astype(np.int64), shared.col[order].astype(np.int64)


def _edge_pairs(mesh: TriangleMesh) -> IntArray:
    """Pairs (n, 2) of triangles that share an edge."""
    ends = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    keys = ends[:, 0] * len(mesh.vertices) + ends[:, 1]
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    return np.stack([order[same] // 3, order[same + 1] // 3], axis=1)


def _centres(mesh: TriangleMesh) -> FloatArray:
    return np.asarray(mesh.vertices[mesh.triangles].mean(axis=1))


def _mean_spacing(mesh: TriangleMesh, centres: FloatArray) -> float:
    edges = _edge_pairs(mesh)
    return float(length(centres[edges[:, 0]] - centres[edges[:, 1]]).mean())


def _gauss(distance: FloatArray, sigma: float) -> FloatArray:
    return np.asarray(np.exp(-(distance**2) / (2 * sigma**2)))
