"""From predicted height maps to positions, as in section 3 of the paper: vertices are placed anew by their patches.

Connectivity says where in which patches a vertex lies. Each of these patches puts it at its place in their plane,
lifted by the predicted height; the vertex comes to lie at the plain mean of these points.
"""

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.normals import vertex_normals
from quadpatch.patches.connectivity import Connectivity, bilinear, vertices_in_patches
from quadpatch.reconstruction.displacement import Displacement
from quadpatch.types import FloatArray, IntArray, Patches, Vertices


def place(filled: FilledMesh, vertices: IntArray, patches: Patches, predicted: FloatArray) -> Displacement:
    """Place some vertices of a filled mesh at the mean of what overlapping patches predict.

    Parameters
    ----------
    filled : FilledMesh
    vertices : (n,) int64
        Vertices of the filled mesh.
    patches : Patches
        As sampled from the filled mesh.
    predicted : (n_patches, N, N) float64
        Heights, in mesh units.

    Returns
    -------
    Displacement
        From where the vertices are to where they belong; zero where no patch sees one.
    """
    positions = filled.mesh.vertices[vertices]
    normals = vertex_normals(filled.mesh.vertices, filled.mesh.triangles)[vertices]
    return mean_moves(positions, vertices_in_patches(positions, normals, patches), patches, predicted)


def mean_moves(positions: Vertices, seen: Connectivity, patches: Patches, predicted: FloatArray) -> Displacement:
    """Average what overlapping patches predict for vertices whose bins are known.

    Parameters
    ----------
    positions : (n, 3) float64
        Where the vertices are now.
    seen : Connectivity
        Of these vertices in the patches.
    patches : Patches
    predicted : (n_patches, N, N) float64
        Heights, in mesh units.

    Returns
    -------
    Displacement
        From where the vertices are to where they belong; zero where no patch sees one.
    """
    z = patches.frames[seen.patch, 2]
    # Its place in the plane is where it is already: only its height over the plane is new.
    height = np.einsum("ij,ij->i", positions[seen.vertex] - patches.origins[seen.patch], z)
    moves = (bilinear(predicted, seen) - height)[:, None] * z
    overlap = np.bincount(seen.vertex, minlength=len(positions))
    count = np.maximum(overlap, 1)
    mean = np.stack([np.bincount(seen.vertex, moves[:, k], minlength=len(positions)) / count for k in range(3)], axis=1)
    squared_deviation = ((moves - mean[seen.vertex]) ** 2).sum(axis=1)
    deviation = np.sqrt(np.bincount(seen.vertex, squared_deviation, minlength=len(positions)) / count)
    return Displacement(mean, deviation, overlap)
