"""Patches for surface that the quads leave out.

Where a part is thinner than a quad is wide, such as an ear or a rod, the quad mesh has gaps, and no patch sees the
surface there. The paper chooses its quads by hand and meets none. Here each gap gets patches of its own: anchored on
the smoothed surface, turned like the nearest quad.
"""

import numpy as np
from scipy.spatial import cKDTree

from quadpatch.mesh.normals import unit, vertex_normals
from quadpatch.patches.seeds import Seeds
from quadpatch.types import BoolArray, FloatArray, Frames, IntArray, TriangleMesh, Vertices

# Patches over a gap lie this share of their length apart: about as close as those of quads with k = 2.
SPACING = 1 / 3


def gap_seeds(base_surface: TriangleMesh, unseen: BoolArray, seeds: Seeds, length: float) -> Seeds:
    """Anchor patches over the vertices that no patch sees.

    Parameters
    ----------
    base_surface : TriangleMesh
        The smoothed mesh.
    unseen : (n_vertices,) bool
        Its vertices that no patch sees.
    seeds : Seeds
        Of the quads; not empty.
    length : float
        Side of the patches, in mesh units.

    Returns
    -------
    Seeds
        One for each cell of a grid that holds such vertices, at the vertex nearest to their mean; `quad` is that of
        the nearest seed of a quad.
    """
    normals = vertex_normals(base_surface.vertices, base_surface.triangles)
    wanted = np.flatnonzero(unseen & normals.any(axis=1))
    anchors = wanted[_one_per_cell(base_surface.vertices[wanted], normals[wanted], SPACING * length)]
    _, nearest = cKDTree(seeds.origins).query(base_surface.vertices[anchors])
    nearest = np.asarray(nearest, np.int64)
    frames = _turned_to(normals[anchors], seeds.frames[nearest, 0])
    return Seeds(base_surface.vertices[anchors], frames, seeds.quad[nearest])


def _one_per_cell(points: Vertices, normals: FloatArray, cell: float) -> IntArray:
    """Pick the points (k,) that lie nearest to the mean of their cell; the sides of a thin wall are cells apart."""
    if not len(points):
        return np.zeros(0, np.int64)
    cells = np.floor((points - points.min(axis=0)) / cell).astype(np.int64)
    side = np.argmax(np.abs(normals), axis=1)
    facing = 2 * side + (normals[np.arange(len(points)), side] > 0)
    _, group = np.unique(np.column_stack([cells, facing]), axis=0, return_inverse=True)
    group = group.ravel()
    count = np.bincount(group)
    means = np.stack([np.bincount(group, points[:, axis]) / count for axis in range(3)], axis=1)
    order = np.lexsort((np.linalg.norm(points - means[group], axis=1), group))
    first = np.flatnonzero(np.diff(group[order], prepend=-1))
    return np.asarray(order[first], np.int64)


def _turned_to(z: FloatArray, x_of_quad: FloatArray) -> Frames:
    """Frames (n, 3, 3) with a given z (n, 3), whose x is the direction in their plane nearest to a given one (n, 3)."""
    x = unit(x_of_quad - np.einsum("ij,ij->i", x_of_quad, z)[:, None] * z)
    lost = ~(np.einsum("ij,ij->i", x, x) > 0.5)
    # Along z itself: any direction in the plane will do, such as that of the axis z has least of.
    axis = np.eye(3)[np.argmin(np.abs(z[lost]), axis=1)]
    x[lost] = unit(axis - np.einsum("ij,ij->i", axis, z[lost])[:, None] * z[lost])
    return np.stack([x, np.cross(z, x), z], axis=1)
