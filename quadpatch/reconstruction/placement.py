"""From predicted height maps to positions, as in section 3 of the paper: vertices are placed anew by their patches.

Connectivity says where in which patches a vertex lies. Each of these patches puts it at its place in their plane,
lifted by the predicted height; the vertex comes to lie at the plain mean of these points.
"""

import numpy as np

from quadpatch.filling.filled_mesh import FilledMesh
from quadpatch.mesh.normals import vertex_normals
from quadpatch.patches.connectivity import bilinear, vertices_in_patches
from quadpatch.reconstruction.displacement import Displacement
from quadpatch.types import FloatArray, IntArray, Patches


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
    seen = vertices_in_patches(positions, normals, patches)
    z = patches.frames[seen.patch, 2]
    # Its place in the plane is where it is already: only its height over the plane is new.
    height = np.einsum("ij,ij->i", positions[seen.vertex] - patches.origins[seen.patch], z)
    moves = (bilinear(predicted, seen) - height)[:, None] * z
    overlap = np.bincount(seen.vertex, minlength=len(vertices))
    count = np.maximum(overlap, 1)
    mean = np.stack([np.bincount(seen.vertex, moves[:, k], minlength=len(vertices)) / count for k in range(3)], axis=1)
    squared_deviation = ((moves - mean[seen.vertex]) ** 2).sum(axis=1)
    deviation = np.sqrt(np.bincount(seen.vertex, squared_deviation, minlength=len(vertices)) / count)
    return Displacement(mean, deviation, overlap)
